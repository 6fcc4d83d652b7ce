// SPDX-License-Identifier: MIT
//
// limits_test: a session under a key ends at its limit of frames, or of wrong tags, and the next
// one goes on.

#include "link_variants.h"

namespace {

// Layers whose session ends at 60 fragments in a direction, or at 50 wrong tags.
class Limits : public Variants {
protected:
    // Sends numbers from a side; repeats those with an unknown outcome.
    struct Flow {
        void push(Side& from, U32 most) {
            for (auto& [tag, outcome] : from.outcomes)
                if (outcome == LINK_UNKNOWN && !again.count(tag))
                    again[tag] = false;
            for (auto& [tag, isSent] : again)
                if (!isSent && offer(from, numberOf[tag]))
                    isSent = true;
            if (next < most && offer(from, next))
                ++next;
        }
        bool offer(Side& from, U32 number) {
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
    static void expectNoneLost(const Flow& flow, const Side& from, const Side& to, U32 most) {
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
    const auto isOver = [](const Flow& flow, const Side& from) {
        return flow.next == most && from.outcomes.size() == flow.numberOf.size() &&
               std::all_of(flow.again.begin(), flow.again.end(),
                           [](auto& tag) { return tag.second; });
    };
    ASSERT_TRUE(connect());
    ASSERT_TRUE(until(
        [&] {
            flowA.push(a, most);
            flowB.push(b, most);
            return isOver(flowA, a) && isOver(flowB, b);
        },
        600'000'000));
    EXPECT_GE(a.sessions(), 3u);
    EXPECT_GE(b.sessions(), 3u);
    expectNoneLost(flowA, a, b, most);
    expectNoneLost(flowB, b, a, most);
}

TEST_P(Limits, ASessionEndsAtTooManyWrongTagsAndBeginsAnew) {
    ASSERT_TRUE(connect());
    a.open(1);
    ASSERT_TRUE(until([&] { return a.send(1, {1, 2, 3}, 1) == LINK_OK; }, 1'000'000));
    Bytes frame;
    ASSERT_TRUE(until(
        [&] {
            for (auto& packet : a.air)
                frame = framesOf(packet.bytes).back();
            return a.outcomes.count(1) != 0;
        },
        1'000'000));
    frame.back() ^= 1;
    unsigned guesses = 0;
    while (b.isUp() && guesses < 200) {
        now += 100'000; // the rest of half a frame is dropped
        b.poll();
        b.receive(frame);
        b.poll();
        ++guesses;
    }
    EXPECT_GT(guesses, 20u); // the search goes on inside a frame, so each may count several times
    EXPECT_LE(guesses, 50u);
    bool isSent = false;
    ASSERT_TRUE(until(
        [&] {
            isSent =
                isSent || (a.sessions() == 2 && bothUp() && a.send(1, {4, 5, 6}, 2) == LINK_OK);
            if (!isSent && a.sessions() == 2)
                a.open(1);
            return a.outcomes.count(2) != 0;
        },
        60'000'000));
    EXPECT_EQ(a.outcomes[2], LINK_DELIVERED);
    EXPECT_EQ(b.sessions(), 2u);
}

INSTANTIATE_TEST_SUITE_P(Vehicles, Limits,
                         ::testing::Values(Variant{"limits", "limits", true},
                                           Variant{"limits", "minimal_limits", true}));

} // namespace
