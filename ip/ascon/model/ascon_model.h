// SPDX-License-Identifier: MIT
//
// ascon_model: computes Ascon-AEAD128 and Ascon-Hash256 on the host, as a reference for the core;
// written from NIST SP 800-232.

#pragma once

#include <array>
#include <cstdint>
#include <vector>

using AsconBytes = std::vector<uint8_t>;
using AsconKey = std::array<uint8_t, 16>; // type of a key, of a nonce and of a tag
struct AsconSealed {
    AsconBytes text;
    AsconKey tag;
};

AsconSealed asconEncrypt(const AsconKey& key, const AsconKey& nonce, const AsconBytes& associated,
                         const AsconBytes& message);
std::array<uint8_t, 32> asconHash(const AsconBytes& message);
