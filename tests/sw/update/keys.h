// SPDX-License-Identifier: MIT
//
// keys: a pair of keys that signs images.

#ifndef UPDATE_KEYS_H
#define UPDATE_KEYS_H

#include <array>
#include <sodium.h>

extern "C" {
#include "slots.h"
}

struct Keys {
    explicit Keys(uint8_t seed) {
        std::array<uint8_t, crypto_sign_SEEDBYTES> from;
        from.fill(seed);
        crypto_sign_seed_keypair(open.data(), secret.data(), from.data());
    }
    void sign(Slots_Header& header) const {
        crypto_sign_detached(header.signature, nullptr, reinterpret_cast<const uint8_t*>(&header),
                             SLOTS_SIGNED_BYTES, secret.data());
    }
    std::array<uint8_t, crypto_sign_PUBLICKEYBYTES> open;
    std::array<uint8_t, crypto_sign_SECRETKEYBYTES> secret;
};

#endif
