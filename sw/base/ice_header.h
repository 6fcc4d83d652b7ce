// SPDX-License-Identifier: MIT
//
// ice_header: the 14 bytes before each message of the Ice protocol ("The Ice Protocol" in the
// manual of ZeroC Ice 3.7): magic bytes, version of the protocol, version of the encoding, message
// type, compression, size.

#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace IceHeader {

enum Type : uint8_t { Request, Batch, Reply, Validate, CloseConnection };

constexpr size_t bytes = 14;
// offset of the request id, 4 bytes, in a request and a reply; id 0 means one-way
constexpr size_t requestIdAt = bytes;

inline uint32_t get32(const uint8_t* at) {
    return static_cast<uint32_t>(at[0]) | static_cast<uint32_t>(at[1]) << 8 |
           static_cast<uint32_t>(at[2]) << 16 | static_cast<uint32_t>(at[3]) << 24;
}

inline uint8_t typeOf(const uint8_t* message) {
    return message[8];
}

// Returns the size of the message, including the header, bytes.
inline uint32_t sizeOf(const uint8_t* message) {
    return get32(message + 10);
}

// Returns whether a header begins with Ice's magic bytes and gives a size that is not smaller than
// the header.
inline bool isValid(const uint8_t* message) {
    return std::memcmp(message, "IceP", 4) == 0 && sizeOf(message) >= bytes;
}

// Returns a message that consists of its header and `body`.
inline std::vector<uint8_t> pack(uint8_t type, const std::vector<uint8_t>& body = {},
                                 uint8_t compression = 0) {
    const size_t size = bytes + body.size();
    std::vector<uint8_t> message = {'I', 'c', 'e', 'P', 1, 0, 1, 0, type, compression};
    for (int shift = 0; shift < 32; shift += 8)
        message.push_back(static_cast<uint8_t>(size >> shift));
    message.insert(message.end(), body.begin(), body.end());
    return message;
}

} // namespace IceHeader
