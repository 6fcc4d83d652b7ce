// SPDX-License-Identifier: MIT
//
// keys: a pair of keys that signs images, and the ground's part of an update.

#ifndef UPDATE_KEYS_H
#define UPDATE_KEYS_H

#include <algorithm>
#include <array>
#include <sodium.h>

extern "C" {
#include "receiver.h"
#include "slots.h"
}

constexpr uint32_t board[2] = {7, 3};

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
    // A list that has this key and another.
    Slots_Header list(uint32_t version, const Keys& second, const Keys& signer) const {
        Slots_Header list{SLOTS_MAGIC, SLOTS_KEYS, version, 0, 0, {board[0], board[1]}, 0, {}, {}};
        std::copy(open.begin(), open.end(), list.digest);
        std::copy(second.open.begin(), second.open.end(), list.digest + SLOTS_KEY_BYTES);
        signer.sign(list);
        return list;
    }
    std::array<uint8_t, crypto_sign_PUBLICKEYBYTES> open;
    std::array<uint8_t, crypto_sign_SECRETKEYBYTES> secret;
};

// A vehicle's receiver, and what the ground does with it. An image has `header` and `bytes`.
struct Updated {
    void work() {
        while (Receiver_work(&receiver))
            ;
    }
    template <class Image> Receiver_Reason begin(const Image& image) {
        const Receiver_Reason reason = Receiver_begin(&receiver, &image.header);
        work();
        return reason == RECEIVER_OK ? receiver.reason : reason;
    }
    template <class Image> Receiver_Reason send(const Image& image, uint32_t chunk) {
        while (receiver.received < image.header.bytes) {
            const uint32_t at = receiver.received, size = std::min(chunk, image.header.bytes - at);
            if (auto reason = Receiver_write(&receiver, at, &image.bytes[at], size))
                return reason;
        }
        const Receiver_Reason reason = Receiver_finish(&receiver);
        work();
        return reason == RECEIVER_OK ? receiver.reason : reason;
    }
    Receiver receiver{};
};

#endif
