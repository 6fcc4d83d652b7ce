// SPDX-License-Identifier: MIT
//
// options_test: link layers compiled with different sizes, and the minimal one, understand each
// other.

#include "ice_messages.h"
#include "variant.h"
#include <gtest/gtest.h>
#include <tuple>

namespace {

// The variants of A and B, and whether they have a key.
using Names = std::tuple<std::string, std::string, bool>;

class Options : public ::testing::TestWithParam<Names>, public Radio {
protected:
    Options()
        : Radio(std::get<0>(GetParam()), std::get<1>(GetParam()), testSeed(),
                Bytes(std::get<2>(GetParam()) ? LINK_KEY_BYTES : 0, 0x5A)) {}
};

TEST_P(Options, MessagesGoBothWaysThroughLoss) {
    ASSERT_TRUE(connect());
    setWeather(0.1, 0, 0);
    a_.open(1);
    Random random(testSeed());
    std::vector<std::pair<int, Bytes>> sent[2];
    U32 most = std::min(a_.maxMessage(), b_.maxMessage());
    const unsigned messages = 200;
    auto offer = [&](Peer& from, std::vector<std::pair<int, Bytes>>& list) {
        Bytes m(1 + random.below(random.below(20) ? 200 : most),
                static_cast<uint8_t>(random.next()));
        if (list.size() < messages && from.send(1, m, static_cast<U32>(list.size())) == LINK_OK)
            list.emplace_back(1, m);
    };
    EXPECT_TRUE(until(
        [&] {
            offer(a_, sent[0]);
            offer(b_, sent[1]);
            return a_.outcomes.size() == messages && b_.outcomes.size() == messages;
        },
        600'000'000));
    EXPECT_TRUE(b_.received == sent[0]) << "seed " << testSeed();
    EXPECT_TRUE(a_.received == sent[1]) << "seed " << testSeed();
}

// Fragments beyond the peer's window would be sent twice.
TEST_P(Options, OnlyWhatIsLostIsSentAgain) {
    ASSERT_TRUE(connect());
    a_.open(1);
    run(200'000);
    const Bytes call(1, 7), picture(1024, 7);
    for (U32 tag = 0; tag < 6; ++tag) {
        ASSERT_EQ(a_.send(1, call, tag), LINK_OK); // the answer takes its acknowledgement along
        ASSERT_TRUE(until([&] { return b_.received.size() == 2 * tag + 1; }, 1'000'000));
        b_.send(1, call, tag);
        ASSERT_TRUE(until([&] { return a_.outcomes.count(tag) != 0; }, 1'000'000));
        ASSERT_EQ(a_.send(1, picture, 100 + tag), LINK_OK);
        setWeather(tag % 2, 0, 0);
        run(5'000);
        setWeather(0, 0, 0);
        ASSERT_TRUE(until([&] { return a_.outcomes.count(100 + tag) != 0; }, 5'000'000));
    }
    EXPECT_EQ(a_.lost, 3u);
    EXPECT_EQ(a_.statistics(a_.link())->fragmentsResent, a_.lost);
}

TEST_P(Options, AMessageThatIsTooLongForThePeerIsReported) {
    U32 most = b_.maxMessage();
    if (a_.maxMessage() <= most)
        return; // it cannot be sent
    ASSERT_TRUE(connect());
    a_.open(0);
    a_.send(0, Bytes(most + 200, 7), 5);
    EXPECT_TRUE(until([&] { return a_.outcomes.count(5) != 0; }, 20'000'000));
    EXPECT_EQ(a_.outcomes[5], LINK_UNKNOWN);
    EXPECT_TRUE(b_.received.empty());
    EXPECT_TRUE(until([&] { return bothUp(); }, 20'000'000));
}

INSTANTIATE_TEST_SUITE_P(
    Variants, Options,
    ::testing::Values(Names{"full", "full", false}, Names{"full", "small", false},
                      Names{"small", "full", false}, Names{"small", "small", false},
                      Names{"window32", "full", false}, Names{"small", "window32", false},
                      Names{"full", "minimal", false}, Names{"window32", "minimal", false},
                      Names{"small", "minimal", false}, Names{"open", "full", false},
                      Names{"full", "small", true}, Names{"window32", "full", true},
                      Names{"full", "minimal", true}, Names{"small", "minimal", true},
                      Names{"tag4", "tag4", true}, Names{"tag4", "minimal_tag4", true}));

// Bytes on the air of a call and its reply, acknowledgements included: without a key, with tags of
// 8 bytes and of 4; beside MAVLink 2, whose signature takes 13 bytes a frame.
class CallBytes : public Options {};

TEST_P(CallBytes, ACallAndItsReplyTakeFewerThanMavlink) {
    const bool isSecure = std::get<2>(GetParam());
    ASSERT_TRUE(connect());
    a_.open(0);
    run(400'000);
    uint64_t before = 0;
    for (uint32_t id = 1; id <= 2; ++id) {
        before = a_.sent + b_.sent;
        a_.send(0, IceMessages::request(id, "hwengine1", "setParameterA", {24, 0}), id);
        ASSERT_TRUE(until([&] { return b_.received.size() == id; }, 1'000'000));
        b_.send(0, IceMessages::reply(id, {}), id);
        ASSERT_TRUE(until([&] { return a_.received.size() == id; }, 1'000'000));
        run(400'000);
    }
    const uint64_t took = a_.sent + b_.sent - before;
    const uint64_t tag = !isSecure ? LINK_CRC : std::get<0>(GetParam()) == "tag4" ? 4 : LINK_TAG;
    RecordProperty("bytes", static_cast<int>(took));
    RecordProperty("mavlink", isSecure ? 58 + 35 : 45 + 22);
    EXPECT_EQ(took, 21 + 3 * (tag - LINK_CRC));
}

INSTANTIATE_TEST_SUITE_P(Tags, CallBytes,
                         ::testing::Values(Names{"full", "full", false},
                                           Names{"full", "full", true},
                                           Names{"tag4", "tag4", true}));

TEST(LinkOptions, MemoryIsWhatTheDocumentationSays) {
    for (auto variant : {"full", "window32", "small", "minimal"})
        std::printf("sizeof(Link), %s: %u bytes on this machine\n", variant,
                    Peer(variant, 1).size());
}

} // namespace
