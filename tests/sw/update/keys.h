// SPDX-License-Identifier: MIT
//
// keys: a key pair that signs images, and the part of the ground station in an update of firmware
// or of a bitstream.

#pragma once

#include "random.h"
#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <sodium.h>
#include <vector>

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
    // Returns a list of signing keys that contains this key and a second key.
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

const Keys ours(1), others(2), second(3), third(4);

struct Image {
    Image(const Slots_Layout& layout, uint32_t product, uint32_t version, uint32_t slot,
          std::vector<uint8_t> content, const Keys& signer)
        : bytes(std::move(content)), header{SLOTS_MAGIC,
                                            product,
                                            version,
                                            static_cast<uint32_t>(bytes.size()),
                                            Slots_at(&layout, slot) + SLOTS_IMAGE_AT,
                                            {board[0], board[1]},
                                            0,
                                            {},
                                            {}} {
        sign(signer);
    }
    void sign(const Keys& signer) {
        crypto_hash_sha512(header.digest, bytes.data(), bytes.size());
        signer.sign(header);
    }
    std::vector<uint8_t> bytes;
    Slots_Header header;
};

struct PowerCut {};

// A vehicle with a receiver and a confirmed version 1, and the actions of the ground station.
class Updated {
public:
    explicit Updated(uint32_t chunk) : chunk_(chunk) {}
    virtual ~Updated() = default;
    // Restarts the processor, or switches the power on. Returns the version that runs.
    virtual uint32_t boot() = 0;
    virtual uint32_t powerOn() { return boot(); }
    virtual uint64_t operations() const = 0;
    virtual Image imageOf(uint32_t version, const Keys& signer = ours) = 0;

    void work() {
        while (Receiver_work(&receiver))
            ;
    }
    Receiver_Reason begin(const Image& image) {
        return outcome(Receiver_begin(&receiver, &image.header));
    }
    Receiver_Reason send(const Image& image) {
        while (receiver.received < image.header.bytes) {
            const uint32_t at = receiver.received, size = std::min(chunk_, image.header.bytes - at);
            if (auto reason = Receiver_write(&receiver, at, &image.bytes[at], size))
                return reason;
        }
        return outcome(Receiver_finish(&receiver));
    }
    void receive(const Image& image) {
        EXPECT_EQ(begin(image), RECEIVER_OK);
        EXPECT_EQ(send(image), RECEIVER_OK);
    }
    // Updates the vehicle as the ground station does, until this version is confirmed; any version
    // may be running before.
    void updateTo(uint32_t version, const Keys& signer = ours) {
        for (uint32_t runs = powerOn(); runs != version && !::testing::Test::HasFailure();
             runs = boot())
            receive(imageOf(version, signer));
        ASSERT_EQ(Receiver_confirm(&receiver), RECEIVER_OK);
    }
    void expectTriedAndConfirmed() {
        // the second update is written into the first slot again
        for (uint32_t version : {2u, 3u}) {
            updateTo(version);
            EXPECT_EQ(powerOn(), version);
            EXPECT_EQ(receiver.isOnTrial, 0);
        }
    }
    void expectTriedOnce() {
        powerOn();
        receive(imageOf(2));
        EXPECT_EQ(boot(), 2u);
        EXPECT_EQ(receiver.isOnTrial, 1);
        // refused, because the update would erase the previous image, which may still be needed
        EXPECT_EQ(begin(imageOf(3)), RECEIVER_ON_TRIAL);
        EXPECT_EQ(boot(), 1u);
        EXPECT_EQ(receiver.reason, RECEIVER_WENT_BACK);
        EXPECT_EQ(powerOn(), 1u);
    }
    Receiver receiver{};
    uint64_t cutAt = 0; // number of the flash operation at which the power is cut; 0 means never

protected:
    Receiver_Reason outcome(Receiver_Reason reason) {
        work();
        return reason == RECEIVER_OK ? receiver.reason : reason;
    }
    template <class Flash> void cutPowerOf(Flash& flash, uint64_t& now) {
        flash.onOperation = [this, &flash, &now] {
            if (flash.operations() == cutAt) {
                now += flash.busyNs() / 2;
                throw PowerCut();
            }
        };
    }

private:
    const uint32_t chunk_;
};

// Updates vehicles that `fresh` makes, `tries` in total. In each update the power is cut at one of
// the first `all` operations; in the first `all` tries, at each of them once. In most updates the
// power is cut a second time, at a later operation that is drawn at random. `wentBack` returns true
// if the last cut led to the previous version.
template <class Fresh, class WentBack>
void cutAtEach(uint32_t version, uint64_t all, uint64_t tries, Fresh fresh, WentBack wentBack) {
    uint64_t cuts = 0, back = 0;
    Random random(testSeed());
    for (uint64_t i = 0; i < tries; ++i) {
        // after the first `all` tries, cuts one of the first erase operations again, because the
        // erased content is random
        const uint64_t first = 1 + (i < all ? i : i % 5);
        auto&& vehicle = fresh(testSeed() * 1000 + i);
        vehicle.cutAt = vehicle.operations() + first;
        for (;;) {
            try {
                vehicle.updateTo(version);
                break;
            } catch (const PowerCut&) {
                vehicle.cutAt = ++cuts % 2 ? 0
                                           : vehicle.operations() + 1 +
                                                 random.below(static_cast<unsigned>(all));
                back += wentBack(vehicle);
            }
        }
        vehicle.cutAt = 0;
        ASSERT_EQ(vehicle.powerOn(), version) << "cut at operation " << first << " of " << all;
    }
    EXPECT_GE(cuts, all);
    EXPECT_GT(back, 0u);
    ::testing::Test::RecordProperty("operations", static_cast<int>(all));
    ::testing::Test::RecordProperty("cuts", static_cast<int>(cuts));
}
