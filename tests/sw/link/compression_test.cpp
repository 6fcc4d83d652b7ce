// SPDX-License-Identifier: MIT
//
// compression_test: heads of Ice messages cross once; other messages, and those that do not fit,
// cross unchanged.

#include "ice_messages.h"
#include "link_variants.h"

namespace {

using namespace IceMessages;

// Bytes on the air of a call and its reply, acknowledgements included: without a key, with tags of
// 8 bytes and of 4; beside MAVLink 2, whose signature takes 13 bytes a frame.
class CallBytes : public Variants {};

TEST_P(CallBytes, ACallAndItsReplyTakeFewerThanMavlink) {
    const bool isSecure = GetParam().hasKey;
    const uint32_t tag = !isSecure ? LINK_CRC : GetParam().a == "tag4" ? 4 : LINK_TAG;
    const uint32_t mavlink = isSecure ? 58 + 35 : 45 + 22;
    uint64_t took[4];
    ASSERT_TRUE(connect());
    a.open(0);
    run(400'000);
    for (uint32_t i = 0; i < 4; ++i) { // the last two are oneway
        const uint64_t before = a.bytesSent + b.bytesSent;
        const uint32_t id = i < 2 ? i + 1 : 0;
        a.send(0, request(id, "hwengine1", "setParameterA", {24, 0}), i);
        ASSERT_TRUE(until([&] { return b.received.size() == i + 1; }, 1'000'000));
        if (id) {
            b.send(0, reply(id, {}), i);
            ASSERT_TRUE(until([&] { return a.received.size() == i + 1; }, 1'000'000));
        }
        run(400'000);
        took[i] = a.bytesSent + b.bytesSent - before;
    }
    RecordProperty("bytes", static_cast<int>(took[1]));
    RecordProperty("mavlink", static_cast<int>(mavlink));
    EXPECT_LT(took[0], mavlink);
    EXPECT_EQ(took[1], 21 + 3 * (tag - LINK_CRC)); // 5 + 3, 5 + 1 + an acknowledgement's 1, 6
    EXPECT_EQ(took[3], 14 + 2 * (tag - LINK_CRC)); // 5 + 3, 6
}

INSTANTIATE_TEST_SUITE_P(Tags, CallBytes,
                         ::testing::Values(Variant{"full", "full", false},
                                           Variant{"full", "full", true},
                                           Variant{"tag4", "tag4", true}));

class Heads : public ::testing::Test, public Pair {
protected:
    Heads() : Pair(testSeed()) {}
    void SetUp() override {
        ASSERT_TRUE(connect());
        ASSERT_EQ(a.open(0), LINK_OK);
        ASSERT_EQ(a.open(1), LINK_OK);
        settle();
    }
    void settle() { run(400'000); }
    uint64_t bytes() const { return a.bytesSent + b.bytesSent; }
    void send(Side& from, Side& to, const Bytes& m, int channel = 0) {
        const size_t before = to.received.size();
        ASSERT_EQ(from.send(channel, m, tag_++), LINK_OK);
        ASSERT_TRUE(until([&] { return to.received.size() > before; }, 1'000'000));
        EXPECT_EQ(to.received.back(), std::pair(channel, m));
    }
    void call(uint32_t id) {
        send(a, b, request(id, "hwengine1", "setParameterA", {7, 0}));
        send(b, a, reply(id, {}));
    }
    U32 tag_ = 0;
};

TEST_F(Heads, CallsInARowCarryEachOthersAcknowledgements) {
    call(1);
    settle();
    const uint64_t before = bytes();
    for (uint32_t id = 2; id < 52; ++id)
        call(id);
    settle();
    // 9 + 7 each: the request takes the acknowledgement of the last reply along.
    EXPECT_LE(bytes() - before, 50u * 16u + 6u);
}

TEST_F(Heads, WhateverIsSentArrivesUnchanged) {
    Bytes big(3000, 0x33), high = {0x80, 1, 2}, full = {0xFF}, ice = {'I', 'c', 'e', 'P'};
    Bytes longHead = request(5, std::string(80, 'x'), "op", {1});
    Bytes withContext = request(6, "a", "op", {1});
    Bytes spoilt = request(7, "a", "op", {1, 2, 3}), half = request(8, "a", "op", {});
    spoilt[10] ^= 1;
    half.resize(25);
    Bytes compressed = request(9, "a", "op", {1});
    compressed[9] = 2;
    withContext[26] = 1;
    const std::vector<Bytes> others = {validate(), closing(), big,         high,   full,
                                       ice,        longHead,  withContext, spoilt, half,
                                       compressed, {0},       {0x90}};
    const std::vector<Bytes> requests = {
        request(10, "a", "op", {}),        request(11, "a", "op", {}),
        request(0, "a", "op", {}),         request(12, "a", "op", {}, "facet"),
        request(13, "a", "op", {}, "", 0), request(500, "a", "op", big)};
    const std::vector<Bytes> replies = {
        reply(3, {}),    reply(4, {1, 2}),       reply(5, {}, 1), reply(6, {1}, 0, 0),
        reply(6, {}, 2), reply(0xFFFFFFFF, big), reply(0, {})};
    for (auto& list : {others, requests, replies})
        for (auto& m : list)
            for (int channel : {0, 1, 0})
                send(a, b, m, channel);
}

TEST_F(Heads, MoreHeadsThanThereAreSlots) {
    uint32_t id = 0;
    for (int round = 0; round < 3; ++round)
        for (int i = 0; i < 20; ++i)
            send(a, b,
                 request(++id, "object" + std::to_string(i), "operation",
                         {static_cast<uint8_t>(i)}));
    settle();
    const uint64_t before = bytes();
    send(a, b, request(++id, "object19", "operation", {1}));
    settle();
    EXPECT_EQ(bytes() - before, 5u + 2u + 6u);
}

TEST_F(Heads, TablesAreEmptyInANewSession) {
    call(1);
    b.boot();
    b.start();
    ASSERT_TRUE(until([&] { return a.statistics().sessions == 2 && bothUp(); }, 20'000'000));
    a.open(0);
    call(2);
    call(3);
}

// A peer that breaks the rules: both sides start a new session, and go on.
TEST_F(Heads, ATokenThatMakesNoSenseEndsTheSession) {
    send(a, b, {0x41});                    // crosses unchanged
    a.link()->output.present.features = 0; // so that A sends this token unmarked
    b.start();
    a.send(0, {0xE0}, 99);
    ASSERT_TRUE(until([&] { return a.outcomes.count(99) != 0; }, 5'000'000));
    EXPECT_EQ(a.outcomes[99], LINK_UNKNOWN);
    EXPECT_TRUE(until([&] { return bothUp(); }, 20'000'000));
}

} // namespace
