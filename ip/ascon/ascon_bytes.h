// SPDX-License-Identifier: MIT
//
// ascon_bytes: keys, messages and their hexadecimal digits, for the tests of the core and of its
// servant.

#pragma once

#include "ascon_model.h"
#include <cstdio>
#include <string>

inline AsconBytes counted(uint8_t first, size_t size) {
    AsconBytes bytes(size);
    for (size_t i = 0; i < size; ++i)
        bytes[i] = static_cast<uint8_t>(first + i);
    return bytes;
}
inline AsconKey sixteen(uint8_t first) {
    AsconKey key;
    for (size_t i = 0; i < key.size(); ++i)
        key[i] = static_cast<uint8_t>(first + i);
    return key;
}
template <class Bytes> std::string hex(const Bytes& bytes) {
    std::string text;
    char digits[3];
    for (uint8_t b : bytes) {
        std::snprintf(digits, sizeof digits, "%02X", b);
        text += digits;
    }
    return text;
}
