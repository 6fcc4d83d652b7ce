// SPDX-License-Identifier: MIT
//
// compression_test: heads of Ice messages cross once; other messages, and those that do not fit,
// cross unchanged.

#include "ice_messages.h"
#include "link_pair.h"
#include <algorithm>
#include <gtest/gtest.h>

namespace {

using namespace IceMessages;

class Heads : public ::testing::Test {
protected:
    void SetUp() override {
        ASSERT_TRUE(pair_.connect());
        ASSERT_EQ(Link_openChannel(pair_.a.link(), 0), LINK_OK);
        ASSERT_EQ(Link_openChannel(pair_.a.link(), 1), LINK_OK);
        settle();
    }
    void settle() { pair_.run(400000); }
    static U32 bytesOf(Side& side) { return Link_statistics(side.link())->bytesSent; }
    U32 bytes() { return bytesOf(pair_.a) + bytesOf(pair_.b); }
    void send(Side& from, Side& to, const Bytes& m, int channel = 0) {
        size_t before = to.received.size();
        ASSERT_EQ(Link_send(from.link(), channel, m.data(), static_cast<U32>(m.size()), tag_++),
                  LINK_OK);
        ASSERT_TRUE(pair_.runUntil([&] { return to.received.size() > before; }, 1000000));
        EXPECT_EQ(to.received.back().second, m);
        EXPECT_EQ(to.received.back().first, channel);
    }
    // A call and its answer: bytes on the air, acknowledgements included.
    U32 call(uint32_t id, const Bytes& parameters, const Bytes& results) {
        U32 before = bytes();
        send(pair_.a, pair_.b, request(id, "hwengine1", "setParameterA", parameters));
        if (id)
            send(pair_.b, pair_.a, reply(id, results));
        settle();
        return bytes() - before;
    }

    Pair pair_{testSeed()};
    U32 tag_ = 0;
};

TEST_F(Heads, ACallAndItsReplyTakeFewerBytesThanMavlink) {
    U32 first = call(1, {24, 0}, {});
    U32 second = call(2, {25, 0}, {});
    U32 oneway = (call(0, {26, 0}, {}), call(0, {27, 0}, {}));
    std::printf(
        "setParameterA(short) and its reply: %u bytes on the air, the first time %u; oneway %u; "
        "MAVLink 2 COMMAND_LONG + COMMAND_ACK 45 + 22\n",
        second, first, oneway);
    EXPECT_EQ(second, 21u); // 5 + 3, 5 + 1 + an acknowledgement's 1, 6
    EXPECT_EQ(oneway, 14u); // 5 + 3, 6
    EXPECT_LT(first, 45u + 22u);
}

TEST_F(Heads, CallsInARowCarryEachOthersAcknowledgements) {
    call(1, {1, 0}, {});
    U32 before = bytes();
    for (uint32_t id = 2; id < 52; ++id) {
        send(pair_.a, pair_.b, request(id, "hwengine1", "setParameterA", {7, 0}));
        send(pair_.b, pair_.a, reply(id, {}));
    }
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
    std::vector<Bytes> all = {validate(),
                              closing(),
                              big,
                              high,
                              full,
                              ice,
                              longHead,
                              withContext,
                              spoilt,
                              half,
                              compressed,
                              Bytes(1, 0),
                              Bytes(1, 0x90),
                              request(10, "a", "op", {}),
                              request(11, "a", "op", {}),
                              request(0, "a", "op", {}),
                              request(12, "a", "op", {}, "facet"),
                              request(13, "a", "op", {}, "", 0),
                              request(500, "a", "op", big),
                              reply(3, {}),
                              reply(4, {1, 2}),
                              reply(5, {}, 1),
                              reply(6, {1}, 0, 0),
                              reply(6, {}, 2),
                              reply(0xFFFFFFFF, big),
                              reply(0, {})};
    for (auto& m : all)
        for (int channel : {0, 1, 0})
            send(pair_.a, pair_.b, m, channel);
}

TEST_F(Heads, MoreHeadsThanThereAreSlots) {
    uint32_t id = 0;
    for (int round = 0; round < 3; ++round)
        for (int i = 0; i < 20; ++i)
            send(pair_.a, pair_.b,
                 request(++id, "object" + std::to_string(i), "operation",
                         {static_cast<uint8_t>(i)}));
    settle();
    U32 before = bytes();
    send(pair_.a, pair_.b, request(++id, "object19", "operation", {1}));
    settle();
    EXPECT_EQ(bytes() - before, 5u + 2u + 6u);
}

TEST_F(Heads, TablesAreEmptyInANewSession) {
    call(1, {1, 0}, {});
    pair_.b.boot();
    Link_start(pair_.b.link(), pair_.now32());
    ASSERT_TRUE(
        pair_.runUntil([&] { return Link_statistics(pair_.a.link())->sessions == 2; }, 20000000));
    ASSERT_TRUE(pair_.runUntil([&] { return pair_.bothUp(); }, 5000000));
    Link_openChannel(pair_.a.link(), 0);
    call(2, {1, 0}, {});
    call(3, {2, 0}, {});
}

TEST_F(Heads, LossAndCorruptionDoNotConfuseTheTables) {
    pair_.setWeather({0.2, 0.1, 0.05, 8000});
    Random random(testSeed());
    std::vector<std::pair<int, Bytes>> sent;
    uint32_t ids[2] = {0, 0};
    pair_.runUntil(
        [&] {
            int channel = static_cast<int>(random.below(2));
            Bytes parameters(random.below(120), static_cast<uint8_t>(random.next()));
            Bytes m = random.below(4) == 0
                          ? reply(random.below(1000), parameters)
                          : request(random.below(3) ? ++ids[channel] : 0,
                                    "o" + std::to_string(random.below(24)), "op", parameters);
            if (sent.size() < 2000 && Link_send(pair_.a.link(), channel, m.data(),
                                                static_cast<U32>(m.size()), tag_) == LINK_OK) {
                ++tag_;
                sent.emplace_back(channel, m);
            }
            return pair_.b.received.size() == 2000;
        },
        600000000);
    // A short one of the other channel may overtake a long one.
    for (auto* list : {&pair_.b.received, &sent})
        std::stable_sort(list->begin(), list->end(),
                         [](auto& a, auto& b) { return a.first < b.first; });
    EXPECT_EQ(pair_.b.received, sent) << "seed " << testSeed();
}

// From any bytes the decoder makes a message within the limits, or none.
TEST_F(Heads, NonsenseIsRefusedWithinTheLimits) {
    Link* link = pair_.b.link();
    Random random(testSeed());
    call(1, {1, 0}, {});
    unsigned refused = 0, taken = 0;
    for (int i = 0; i < 300000; ++i) {
        U32 size = 1 + random.below(random.below(8) ? 20 : LINK_MAX_MESSAGE + 1);
        U8* at = link->message + LINK_HEAD_ROOM;
        for (U32 k = 0; k < std::min(size, 40u); ++k)
            at[k] = static_cast<U8>(random.next());
        if (random.below(4))
            at[0] = static_cast<U8>(0x80 + random.below(0x48));
        link->receiver.start = at;
        link->receiver.size = static_cast<U16>(size);
        link->receiver.channel = static_cast<U8>(random.below(4));
        if (!link_decompress(link)) {
            ++refused;
            continue;
        }
        ++taken;
        ASSERT_GE(link->receiver.start, link->message);
        ASSERT_GE(link->receiver.size, 1);
        ASSERT_LE(link->receiver.size, LINK_MAX_MESSAGE);
        ASSERT_EQ(link->receiver.start + link->receiver.size, at + size) << "seed " << testSeed();
    }
    EXPECT_GT(refused, 10000u);
    EXPECT_GT(taken, 10000u);
}

// A peer that breaks the rules: both sides start a new session, and go on.
TEST_F(Heads, ATokenThatMakesNoSenseEndsTheSession) {
    Bytes m = {0x41}; // crosses unchanged
    send(pair_.a, pair_.b, m);
    pair_.a.link()->session.features = 0; // so that A sends this token unmarked
    const U8 token = 0xE0;
    Link_start(pair_.b.link(), pair_.now32());
    Link_send(pair_.a.link(), 0, &token, 1, 99);
    ASSERT_TRUE(pair_.runUntil([&] { return pair_.a.outcomes.count(99) != 0; }, 5000000));
    EXPECT_EQ(pair_.a.outcomes[99], LINK_UNKNOWN);
    EXPECT_TRUE(pair_.runUntil([&] { return pair_.bothUp(); }, 20000000));
}

} // namespace
