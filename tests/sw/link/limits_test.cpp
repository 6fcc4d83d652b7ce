// SPDX-License-Identifier: MIT
//
// limits_test: a session under a key ends at its limit of frames, or of wrong tags, and the next
// one goes on.

#include "link_pair.h"
#include "variant.h"
#include <algorithm>
#include <gtest/gtest.h>
#include <map>

namespace {

const Bytes key(LINK_KEY_BYTES, 0x5A);

// Layers whose session ends at 60 fragments in a direction, or at 50 wrong tags.
class Limits : public ::testing::TestWithParam<std::string>, public Radio {
protected:
    Limits() : Radio("limits", GetParam(), testSeed(), key) {}
    static auto ups(const Peer& side) {
        return std::count(side.events.begin(), side.events.end(), "up");
    }
    // Sends numbers from a side; repeats those with an unknown outcome.
    struct Flow {
        void push(Peer& from, U32 most) {
            for (auto& [tag, outcome] : from.outcomes)
                if (outcome == LINK_UNKNOWN && !again.count(tag))
                    again[tag] = false;
            for (auto& [tag, isSent] : again)
                if (!isSent && offer(from, numberOf[tag]))
                    isSent = true;
            if (next < most && offer(from, next))
                ++next;
        }
        bool offer(Peer& from, U32 number) {
            const U32 tag = static_cast<U32>(numberOf.size());
            const Link_Status status = from.send(1, {static_cast<uint8_t>(number), 7, 7}, tag);
            if (status == LINK_CLOSED)
                from.open(1);
            if (status == LINK_OK)
                numberOf.push_back(number);
            return status == LINK_OK;
        }
        U32 next = 0;
        std::vector<U32> numberOf; // by tag
        std::map<U32, bool> again; // by tag: was it sent again?
    };
    static void expectNoneLost(const Flow& flow, const Peer& from, const Peer& to, U32 most) {
        std::map<U32, size_t> sent, arrived, delivered;
        for (U32 number : flow.numberOf)
            ++sent[number];
        for (auto& [channel, bytes] : to.received)
            ++arrived[bytes.at(0)];
        for (auto& [tag, outcome] : from.outcomes)
            delivered[flow.numberOf[tag]] += outcome == LINK_DELIVERED;
        for (U32 number = 0; number < most; ++number) {
            EXPECT_EQ(delivered[number], 1u) << number;
            EXPECT_GE(arrived[number], 1u) << number;
            EXPECT_LE(arrived[number], sent[number]) << number; // once, or reported as unknown
        }
    }
};

TEST_P(Limits, ASessionEndsAtItsLastNumberAndTheNextLosesNothing) {
    constexpr U32 most = 150;
    Flow flowA, flowB;
    const auto isOver = [](const Flow& flow, const Peer& from) {
        return flow.next == most && from.outcomes.size() == flow.numberOf.size() &&
               std::all_of(flow.again.begin(), flow.again.end(), [](auto& a) { return a.second; });
    };
    ASSERT_TRUE(connect());
    ASSERT_TRUE(until(
        [&] {
            flowA.push(a_, most);
            flowB.push(b_, most);
            return isOver(flowA, a_) && isOver(flowB, b_);
        },
        600'000'000));
    EXPECT_GE(ups(a_), 3);
    EXPECT_GE(ups(b_), 3);
    expectNoneLost(flowA, a_, b_, most);
    expectNoneLost(flowB, b_, a_, most);
}

TEST_P(Limits, ASessionEndsAtTooManyWrongTagsAndBeginsAnew) {
    ASSERT_TRUE(connect());
    a_.open(1);
    ASSERT_TRUE(until([&] { return a_.send(1, {1, 2, 3}, 1) == LINK_OK; }, 1'000'000));
    Bytes frame;
    ASSERT_TRUE(until(
        [&] {
            for (auto& [time, packet] : a_.air)
                frame = framesOf(packet).back();
            return a_.outcomes.count(1) != 0;
        },
        1'000'000));
    frame.back() ^= 1;
    unsigned guesses = 0;
    while (b_.isUp() && guesses < 200) {
        now_ += 100'000; // the rest of half a frame is dropped
        b_.poll(b_.link(), us());
        b_.receive(b_.link(), frame.data(), static_cast<U32>(frame.size()), us());
        b_.poll(b_.link(), us());
        ++guesses;
    }
    EXPECT_GT(guesses, 20u); // the search goes on inside a frame, so each may count several times
    EXPECT_LE(guesses, 50u);
    bool isSent = false;
    ASSERT_TRUE(until(
        [&] {
            isSent = isSent || (ups(a_) == 2 && bothUp() && a_.send(1, {4, 5, 6}, 2) == LINK_OK);
            if (!isSent && ups(a_) == 2)
                a_.open(1);
            return a_.outcomes.count(2) != 0;
        },
        60'000'000));
    EXPECT_EQ(a_.outcomes[2], LINK_DELIVERED);
    EXPECT_EQ(ups(b_), 2);
}

INSTANTIATE_TEST_SUITE_P(Vehicles, Limits, ::testing::Values("limits", "minimal_limits"));

} // namespace
