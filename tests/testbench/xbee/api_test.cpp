// SPDX-License-Identifier: MIT
//
// api_test: API frames of the XBee model, with and without escapes; bytes after the manual's
// examples.

#include "pair.h"

namespace {

class Api : public Pair, public ::testing::WithParamInterface<uint32_t> {
protected:
    bool escapes() const { return GetParam() == 2; }
    Bytes framed(Bytes contents) const {
        Bytes inside = {static_cast<uint8_t>(contents.size() >> 8),
                        static_cast<uint8_t>(contents.size())};
        uint8_t sum = 0;
        for (uint8_t byte : contents)
            sum = static_cast<uint8_t>(sum + byte);
        inside.insert(inside.end(), contents.begin(), contents.end());
        inside.push_back(static_cast<uint8_t>(0xFF - sum));
        Bytes out = {0x7E};
        for (uint8_t byte : inside) {
            bool special =
                escapes() && (byte == 0x7E || byte == 0x7D || byte == 0x11 || byte == 0x13);
            if (special)
                out.push_back(0x7D);
            out.push_back(special ? byte ^ 0x20 : byte);
        }
        return out;
    }
    void SetUp() override { power({{"AP", GetParam()}}); }
    void api(Bytes contents, uint64_t ns = 0) {
        lineA.send(framed(std::move(contents)), now);
        run(ns);
    }
    Bytes answer() { return std::exchange(lineA.received, {}); }
    Bytes command(Bytes contents) {
        api(std::move(contents), ms);
        return answer();
    }
};

TEST_P(Api, ATransmitRequestIsSentAndItsStatusReported) {
    api({0x01, 0x52, 0x00, 0x02, 0x00, 'h', 0x7E, 0x11, 'i'}, 20 * ms);
    EXPECT_EQ(heardB(), "h\x7E\x11i");
    EXPECT_EQ(answer(), framed({0x89, 0x52, 0x00}));
}

TEST_P(Api, NobodyThereGivesStatus1) {
    api({0x01, 0x07, 0x99, 0x99, 0x00, 'x'}, 100 * ms);
    EXPECT_EQ(answer(), framed({0x89, 0x07, 0x01}));
}

TEST_P(Api, FrameId0AsksForNoStatus) {
    api({0x01, 0x00, 0x00, 0x02, 0x00, 'x'}, 20 * ms);
    EXPECT_EQ(heardB(), "x");
    EXPECT_EQ(answer(), Bytes{});
}

TEST_P(Api, TheOptionWithoutAckIsNotTriedAgain) {
    air.weather.tryLoss = 1;
    api({0x01, 0x01, 0x00, 0x02, 0x01, 'x'}, 100 * ms);
    EXPECT_EQ(air.counters().retries, 0u);
}

TEST_P(Api, SerialNumbersAreAddressedBy0x00) {
    api({0x00, 0x01, 0x00, 0x13, 0xA2, 0x00, 0x00, 0x00, 0x00, 0x0B, 0x00, 'x'}, 20 * ms);
    EXPECT_EQ(heardB(), "x");
}

TEST_P(Api, AReceivedPacketHasSourceAndSignal) {
    lineB.send({'h', 'i'}, now);
    run(20 * ms);
    EXPECT_EQ(answer(), framed({0x81, 0x00, 0x02, 0x28, 0x00, 'h', 'i'}));
}

TEST_P(Api, ABroadcastIsMarked) {
    power({{"AP", GetParam()}}, {{"DL", 0xFFFF}});
    lineB.send({'x'}, now);
    run(20 * ms);
    EXPECT_EQ(answer(), framed({0x81, 0x00, 0x02, 0x28, 0x02, 'x'}));
}

TEST_P(Api, CommandsAreAnsweredWithAStatus) {
    // The manual's example.
    EXPECT_EQ(command({0x08, 0x52, 'D', 'L'}), framed({0x88, 0x52, 'D', 'L', 0, 0, 0, 0, 2}));
    EXPECT_EQ(command({0x08, 0x4D, 'D', 'L', 0x50, 0x00}), framed({0x88, 0x4D, 'D', 'L', 0}));
    EXPECT_EQ(a->parameter("DL"), 0x5000u);
    EXPECT_EQ(command({0x08, 0x01, 'Z', 'Z'}), framed({0x88, 0x01, 'Z', 'Z', 2}));
    EXPECT_EQ(command({0x08, 0x01, 'C', 'H', 0x55}), framed({0x88, 0x01, 'C', 'H', 3}));
}

TEST_P(Api, AQueuedCommandWaitsForAC) {
    command({0x09, 0x01, 'M', 'Y', 0x00, 0x44});
    EXPECT_EQ(a->parameter("MY"), 1u);
    command({0x08, 0x02, 'A', 'C'});
    EXPECT_EQ(a->parameter("MY"), 0x44u);
}

TEST_P(Api, BadFramesAreCountedAndTheNextIsRead) {
    Bytes bad = framed({0x01, 0x00, 0x00, 0x02, 0x00, 'x'});
    bad.back() ^= 1; // checksum
    lineA.send(bad, now);
    lineA.send({'n', 'o', 'i', 's', 'e'}, now);
    lineA.send({0x7E, 0xF0, 0x00}, now); // an impossible length
    api({0x33, 0x00});                   // no such type
    Bytes longPayload = {0x01, 0x00, 0x00, 0x02, 0x00};
    longPayload.resize(longPayload.size() + 101, 'x');
    api(longPayload);
    EXPECT_EQ(a->counters().badFrames, 4u);
    api({0x01, 0x00, 0x00, 0x02, 0x00, 'o', 'k'}, 20 * ms);
    EXPECT_EQ(heardB(), "ok");
}

TEST_P(Api, AResetIsReported) {
    a->resetPin(true, now);
    run(1000);
    a->resetPin(false, now);
    run(100 * ms);
    EXPECT_EQ(answer(), framed({0x8A, 0x00}));
}

TEST_P(Api, TheCommandSequenceIsNotKnown) {
    EXPECT_EQ(enter(), "");
    EXPECT_FALSE(a->inCommandMode());
}

INSTANTIATE_TEST_SUITE_P(Modes, Api, ::testing::Values(1u, 2u));

TEST_P(Api, WithEscapesALostByteCostsOneFrameOnly) {
    Bytes cut = framed({0x01, 0x00, 0x00, 0x02, 0x00, 'x', 'y', 'z'});
    cut.pop_back();
    lineA.send(cut, now);
    api({0x01, 0x00, 0x00, 0x02, 0x00, 'o', 'k'}, 20 * ms);
    EXPECT_EQ(heardB(), escapes() ? "ok" : "");
}

} // namespace
