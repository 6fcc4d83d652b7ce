// SPDX-License-Identifier: MIT
//
// messages_test: tests Ice messages between full layers. Heads that the peer knows are omitted; all
// other messages are sent unchanged. Only a short message may overtake, and it overtakes only the
// rest of a long message on another channel.

#include "ice_messages.h"
#include "link_variants.h"

namespace {

using namespace IceMessages;

// Counts the bytes that a call and its reply take on the air, including acknowledgements, without a
// key and with tags of 8 and of 4 bytes. Compares them with MAVLink 2, which has a signature of 13
// bytes per frame.
class CallBytes : public Variants {};

TEST_P(CallBytes, ACallAndItsReplyTakeFewerBytesThanMavlink) {
    const bool isSecure = GetParam().hasKey;
    const uint32_t tag = !isSecure ? LINK_CRC : GetParam().a == "tag4" ? 4 : LINK_TAG;
    const uint32_t mavlink = isSecure ? 58 + 35 : 45 + 22;
    uint64_t took[4];
    ASSERT_TRUE(connect());
    a.open(0);
    run(400'000);
    for (uint32_t i = 0; i < 4; ++i) { // the last two of the calls are one-way
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
    // bytes (a frame has 5 bytes in addition to its content): 5 + 3 for the request, 5 + 1 for the
    // reply, 1 for the acknowledgement in the reply, and 6 for the last acknowledgement
    EXPECT_EQ(took[1], 21 + 3 * (tag - LINK_CRC));
    // bytes: 5 + 3 (frame and content) for the request, and 6 for the acknowledgement
    EXPECT_EQ(took[3], 14 + 2 * (tag - LINK_CRC));
}

INSTANTIATE_TEST_SUITE_P(Tags, CallBytes,
                         ::testing::Values(Variant{"full", "full", false},
                                           Variant{"full", "full", true},
                                           Variant{"tag4", "tag4", true}));

class Heads : public ::testing::Test, public LinkPair {
protected:
    Heads() : LinkPair(testSeed()) {}
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

TEST_F(Heads, ConsecutiveCallsCarryAcknowledgements) {
    call(1);
    settle();
    const uint64_t before = bytes();
    for (uint32_t id = 2; id < 52; ++id)
        call(id);
    settle();
    // A request takes 9 bytes and a reply 7 bytes, because each of them also contains the
    // acknowledgement of the message before it.
    EXPECT_LE(bytes() - before, 50u * 16u + 6u);
}

TEST_F(Heads, EveryMessageArrivesUnchanged) {
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

TEST_F(Heads, MoreHeadersThanSlotsAreHandled) {
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

// If a peer violates the rules, both sides start a new session and continue.
TEST_F(Heads, AnInvalidTokenEndsTheSession) {
    send(a, b, {0x41}); // crosses unchanged
    // side A now uses no tokens, so A sends this byte unchanged
    a.link()->session.handshake.present.features = 0;
    b.start();
    a.send(0, {0xE0}, 99);
    ASSERT_TRUE(until([&] { return a.outcomes.count(99) != 0; }, 5'000'000));
    EXPECT_EQ(a.outcomes[99], LINK_UNKNOWN);
    EXPECT_TRUE(until([&] { return bothUp(); }, 20'000'000));
}

// messages that have arrived: channel and size of each
using Arrived = std::vector<std::pair<int, size_t>>;

class Overtaking : public Variants {
protected:
    void SetUp() override {
        ASSERT_TRUE(connect());
        for (int channel : {0, 1, 2})
            ASSERT_EQ(a.open(channel), LINK_OK);
        run(500'000);
    }
    void send(int channel, const Bytes& m) { ASSERT_EQ(a.send(channel, m, tag_++), LINK_OK); }
    // Sends a message of 10 bytes. Returns the time until it is delivered, us.
    uint64_t call() {
        const size_t before = b.received.size();
        const uint64_t start = now;
        send(1, Bytes(10, 2));
        EXPECT_TRUE(until([&] { return b.received.size() > before; }, 5'000'000));
        EXPECT_EQ(b.received.back(), std::make_pair(1, Bytes(10, 2)));
        return now - start;
    }
    // Waits until all messages have been reported as delivered. Returns the messages that arrived.
    Arrived arrived() {
        EXPECT_TRUE(until([&] { return a.outcomes.size() == tag_; }, 60'000'000));
        for (auto& [tag, outcome] : a.outcomes)
            EXPECT_EQ(outcome, LINK_DELIVERED) << "message " << tag;
        Arrived list;
        for (auto& [channel, bytes] : b.received)
            list.emplace_back(channel, bytes.size());
        return list;
    }
    uint32_t tag_ = 0;
};

class FullOvertaking : public Overtaking {};

TEST_P(FullOvertaking, ACallDuringAPictureTakesAtMostThreeTimesAsLong) {
    const uint64_t idle = call();
    run(200'000);
    for (int i = 0; i < 5; ++i) {
        send(0, Bytes(1000, 1)); // pictures of 1000 bytes; each takes 90 ms on the line
        send(0, Bytes(1000, 1));
        run(30'000);
        EXPECT_LE(call(), 3 * idle);
        run(500'000);
    }
}

TEST_P(FullOvertaking, ACallDoesNotWaitForALostPartOfAPicture) {
    const uint64_t idle = call();
    for (int i = 0; i < 5; ++i) {
        run(500'000);
        send(0, Bytes(1000, 1));
        run(20'000);
        a.weather.loss = 1;
        run(9'000);
        a.weather.loss = 0;
        EXPECT_LE(call(), 3 * idle);
    }
    (void)arrived();
}

TEST_P(FullOvertaking, MessagesOvertakeOnlyThoseOfOtherChannels) {
    send(0, Bytes(1000, 1));
    send(0, Bytes(11, 1)); // must arrive after the picture, because it is on the same channel
    run(20'000);
    send(1, Bytes(300, 3));
    send(1, Bytes(12, 3)); // must arrive after the long message on its channel
    send(2, Bytes(13, 4));
    send(2, Bytes(14, 4));
    a.close(2);
    const Arrived all = arrived();
    EXPECT_EQ(all, (Arrived{{2, 13}, {2, 14}, {0, 1000}, {0, 11}, {1, 300}, {1, 12}}));
    for (auto& [channel, bytes] : b.received)
        EXPECT_EQ(bytes, Bytes(bytes.size(), bytes.front()));
    EXPECT_EQ(b.events.back(), "close 2");
}

TEST_P(FullOvertaking, ShortMessagesLeaveHalfTheRateToALongMessage) {
    send(0, Bytes(800, 1));
    EXPECT_TRUE(until(
        [&] {
            if (a.send(1, Bytes(80, 2), tag_) == LINK_OK)
                ++tag_;
            return b.received.size() && b.received.back().first == 0;
        },
        5'000'000));
    // at most one short message may overtake each fragment of the long message
    EXPECT_LE(b.received.size(), 12u);
    EXPECT_GE(b.received.size(), 6u);
}

INSTANTIATE_TEST_SUITE_P(Peers, FullOvertaking,
                         ::testing::Values(Variant{"full", "full", false},
                                           Variant{"full", "full", true},
                                           Variant{"full", "small", false}));

TEST_P(Overtaking, NothingOvertakesTowardsTheMinimalLayer) {
    send(0, Bytes(900, 1));
    run(100'000);
    send(1, Bytes(10, 2));
    EXPECT_EQ(arrived(), (Arrived{{0, 900}, {1, 10}}));
}

INSTANTIATE_TEST_SUITE_P(Peers, Overtaking, ::testing::Values(Variant{"full", "minimal", false}));

} // namespace
