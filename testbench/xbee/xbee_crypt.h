// SPDX-License-Identifier: MIT
//
// xbee_crypt: AES-128 in counter mode by IEEE 802.15.4-2003 (security suite AES-CTR, 7.6.2): five
// bytes before the payload, frame counter and key sequence counter, and no check. So a packet has
// 95 bytes instead of 100, and another key gives garbage, not silence.

#ifndef XBEE_CRYPT_H
#define XBEE_CRYPT_H

#include <cstdint>
#include <string>
#include <vector>

struct XBeeCrypt {
    static constexpr size_t headBytes = 5;
    // `key`: 32 hexadecimal digits, or none (all zero). `source`: the sender's serial number.
    static std::vector<uint8_t> encrypt(const std::string& key, uint64_t source, uint32_t counter,
                                        const std::vector<uint8_t>& plain);
    // The payload of a packet; empty if it is too short.
    static std::vector<uint8_t> decrypt(const std::string& key, uint64_t source,
                                        const std::vector<uint8_t>& packet);
};

#endif
