// SPDX-License-Identifier: MIT
//
// two_grounds: a vehicle with two grounds, each under a key of its own, and a stranger: what it
// serves whom. The host build and the ARM binary fly the same.

#pragma once

#include "ground.h"
#include <gtest/gtest.h>

class TwoGrounds : public GroundAndChip {
public:
    static constexpr uint32_t observersAddress = 0x00F0;
    const std::vector<uint8_t> pilotsKey = std::vector<uint8_t>(LINK_KEY_BYTES, 0x11),
                               observersKey = std::vector<uint8_t>(LINK_KEY_BYTES, 0x22);

    TwoGrounds() {
        ground.key = pilotsKey;
        observer.key = stranger.key = observersKey;
        for (Ground* g : {&ground, &observer, &stranger})
            g->start();
        soc.onTime([this](uint64_t now) {
            return std::min({ground.advance(now), observer.advance(now), stranger.advance(now)});
        });
        soc.reset(true);
    }
    // Both call at once; the observer vanishes in mid-call, and comes again with the pilot's key,
    // then with its own.
    Script flight() {
        const auto vanish = [this] {
            since_ = soc.now();
            observer.ping(100, "hwengine1");
            observer.running = false;
            return true;
        };
        return inOrder(
            {[this] { return ground.validated && observer.validated; },
             [this, both = together(15)]() mutable { return both(); }, vanish,
             [this, calls = ground.calling(std::vector<Ground::Call>(40, ping))]() mutable {
                 if (soc.now() - since_ < 1'000'000)
                     ground.replies.clear();
                 return calls();
             },
             [this] {
                 EXPECT_LT(double(soc.now() - since_) / 1e9, 40 * 0.045) << "the pilot was delayed";
                 observer.key = pilotsKey;
                 observer.start();
                 since_ = soc.now();
                 return true;
             },
             [this] { return soc.now() - since_ > 4'000'000'000; },
             [this] {
                 EXPECT_FALSE(observer.isUp()) << "under the pilot's key";
                 observer.key = observersKey;
                 observer.start();
                 return true;
             },
             [this] { return observer.validated; },
             [this] {
                 ground.replies.clear();
                 return true;
             },
             [this, both = together(5)]() mutable { return both(); },
             [this] {
                 EXPECT_EQ(ground.statistics().sessions, 1u) << "the pilot's session went on";
                 EXPECT_EQ(stranger.statistics().sessions, 0u) << "has the key, not the address";
                 for (const Ground* g : {&ground, &observer})
                     for (const auto& [id, status] : g->replies)
                         EXPECT_EQ(status, 0) << id;
                 return true;
             }});
    }

    Ground observer{air, testSeed() + 6, observersAddress}, stranger{air, testSeed() + 7, 0x0BAD};

private:
    const Ground::Call ping = {"hwengine1", "ice_ping", 2};

    Script together(size_t calls) {
        return [pilots = ground.pinging(calls), others = observer.pinging(calls)]() mutable {
            const bool isDone = pilots();
            return others() && isDone;
        };
    }
    uint64_t since_ = 0;
};
