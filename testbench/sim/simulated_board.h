// SPDX-License-Identifier: MIT
//
// simulated_board: provides secrets to firmware that runs on the host. Its random numbers come from
// a seed and the generator of the Cortex-M3 model. It has a few words that keep their values
// without power. Initially the vehicle has no key.

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
        // discards the first random number, in the same way as secrets.c
        (void)RandomBlock::next(random_);
        provide({});
    }
    // Makes the firmware use this board.
    void use() { UAV_useBoard(&port(), this); }
    // Stores the vehicle's key (16 bytes) and address, as the factory does. If the key is empty,
    // the vehicle accepts a link without a key.
    void provide(const std::vector<uint8_t>& key, uint32_t address = 1) {
        use();
        UAV_provide(address, key.empty() ? nullptr : key.data());
    }
    // A peer that the vehicle serves in addition to its first ground station.
    struct OtherPeer {
        int role; // role of the peer: UAV_OBSERVER, UAV_VEHICLE or UAV_GROUP
        uint32_t address;
        std::vector<uint8_t> key;
    };
    void providePeers(const std::vector<OtherPeer>& peers) {
        use();
        for (const auto& [role, address, key] : peers)
            UAV_providePeer(role, address, key.empty() ? nullptr : key.data());
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
