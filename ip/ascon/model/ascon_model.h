// SPDX-License-Identifier: MIT
//
// ascon_model: Ascon-AEAD128 and Ascon-Hash256 on the host, written from NIST SP 800-232: the
// core's reference.

#pragma once

#include <array>
#include <cstdint>
#include <vector>

using AsconBytes = std::vector<uint8_t>;
using AsconKey = std::array<uint8_t, 16>; // also a nonce, and a tag
struct AsconSealed {
    AsconBytes text;
    AsconKey tag;
};

AsconSealed asconEncrypt(const AsconKey& key, const AsconKey& nonce, const AsconBytes& associated,
                         const AsconBytes& message);
std::array<uint8_t, 32> asconHash(const AsconBytes& message);
