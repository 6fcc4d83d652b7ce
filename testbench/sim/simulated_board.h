// SPDX-License-Identifier: MIT
//
// simulated_board: replaces the vehicle's source of secrets if its firmware runs on the host:
// random numbers from a seed, by the Cortex-M3 model's generator, and words that keep their values
// without power. Initially the vehicle is open.

#pragma once

#include "random_block.h"
#include <array>
#include <vector>

extern "C" {
#include "uav_keys.h"
}

class SimulatedBoard {
public:
    using Words = std::array<uint32_t, BACKUP_WORDS>;

    explicit SimulatedBoard(uint64_t seed = 1) : random_(seed) {
        (void)RandomBlock::next(random_); // as in secrets.c
        provide({});
    }
    // Gives it to the firmware.
    void use() { UAV_useBoard(&port(), this); }
    // Stores the vehicle's key, 16 bytes, and its address, as its factory does; an empty key opens
    // it.
    void provide(const std::vector<uint8_t>& key, uint32_t address = 1) {
        use();
        UAV_provide(address, key.empty() ? nullptr : key.data());
    }
    // Whom it serves besides its ground.
    struct Peer {
        int ground; // UAV_OBSERVER, UAV_VEHICLE, UAV_GROUP
        uint32_t address;
        std::vector<uint8_t> key;
    };
    void providePeers(const std::vector<Peer>& peers) {
        use();
        for (const auto& [ground, address, key] : peers)
            UAV_providePeer(ground, address, key.empty() ? nullptr : key.data());
    }
    Words words{};

private:
    static SimulatedBoard& self(void* context) { return *static_cast<SimulatedBoard*>(context); }
    static const UAV_Board& port() {
        static const UAV_Board callbacks = {
            [](void* c) -> U32 { return RandomBlock::next(self(c).random_); },
            [](void* c, U32 word) -> U32 { return self(c).words.at(word); },
            [](void* c, U32 word, U32 value) { self(c).words.at(word) = value; }};
        return callbacks;
    }
    uint64_t random_;
};
