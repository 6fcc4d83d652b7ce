// SPDX-License-Identifier: MIT
//
// api_test: tests how the ground parses the frames of a modem in API mode, and how it handles the
// modem's answers.

#include "api_modem.h"
#include "random.h"
#include <gtest/gtest.h>

namespace {

using XBeeAT::ApiFrames;
using XBeeAT::ApiModem;
using Bytes = ApiFrames::Bytes;

// Collects the output of a modem in API mode: received data with its source, and '+' for each
// packet that was acknowledged or '-' for each packet that was lost.
struct Heard {
    Bytes data;
    int source = 0;
    std::string answers;
    void feed(ApiModem& modem, const Bytes& bytes) {
        for (uint8_t byte : bytes) // the bytes arrive one at a time
            modem.feed(
                &byte, 1,
                [&](int from, const uint8_t* d, size_t count) {
                    data.insert(data.end(), d, d + count);
                    source = from;
                },
                [&](bool isThere) { answers += isThere ? '+' : '-'; });
    }
};

Bytes packetFrom(const ApiFrames& frames, uint16_t source, const Bytes& data) {
    Bytes contents = {0x81, static_cast<uint8_t>(source >> 8), static_cast<uint8_t>(source), 40, 0};
    contents.insert(contents.end(), data.begin(), data.end());
    return frames.pack(contents);
}

TEST(Api, PacketsOfAllBytesArriveWithAndWithoutEscapes) {
    for (bool escapes : {false, true}) {
        const ApiFrames frames(escapes);
        ApiModem modem(escapes);
        Heard heard;
        Bytes all;
        for (int first = 0; first < 256; first += 64) {
            Bytes data;
            for (int i = 0; i < 64; ++i)
                data.push_back(static_cast<uint8_t>(first + i));
            heard.feed(modem, packetFrom(frames, 1, data));
            all.insert(all.end(), data.begin(), data.end());
        }
        EXPECT_EQ(heard.data, all);
    }
    const Bytes bytes = ApiFrames(true).packet(0x11, 0x7E13, Bytes{0x7D}.data(), 1);
    EXPECT_EQ(std::count(bytes.begin(), bytes.end(), 0x7E), 1);
    EXPECT_EQ(std::count(bytes.begin(), bytes.end(), 0x11), 0);
    EXPECT_EQ(std::count(bytes.begin(), bytes.end(), 0x13), 0);
}

// Received data is passed on at once: a short packet does not wait for the packets after it.
TEST(Api, ReceivedDataIsPassedOnAtOnce) {
    ApiModem modem(false);
    Heard heard;
    Bytes bytes = packetFrom(ApiFrames(), 1, {1, 2, 3, 4});
    bytes.resize(bytes.size() - 3);
    heard.feed(modem, bytes);
    EXPECT_EQ(heard.data, (Bytes{1, 2}));
}

TEST(Api, ReceivedDataHasTheAddressOfItsSender) {
    ApiModem modem(false);
    Heard heard;
    for (uint16_t address : {uint16_t(2), uint16_t(0xFFFE)}) {
        heard.feed(modem, packetFrom(ApiFrames(), address, {7}));
        EXPECT_EQ(heard.source, address);
    }
    heard.feed(modem, ApiFrames().pack({0x80, 0, 0, 0, 0, 0, 0, 0, 9, 40, 0, 7}));
    EXPECT_EQ(heard.source, ApiFrames::noAddress);
}

TEST(Api, RNIsSetWhenItChanges) {
    ApiModem modem(false);
    const ApiFrames frames;
    auto packet = [&](uint8_t id, uint32_t rn) {
        Bytes bytes = modem.packet(5, Bytes{1}.data(), 1, rn, 0);
        const Bytes end = frames.packet(id, 5, Bytes{1}.data(), 1);
        EXPECT_EQ(Bytes(bytes.end() - static_cast<std::ptrdiff_t>(end.size()), bytes.end()), end);
        bytes.resize(bytes.size() - end.size());
        return bytes;
    };
    EXPECT_EQ(packet(1, 2), Bytes());
    EXPECT_EQ(packet(2, 0), frames.command(0, "RN", {0}));
    EXPECT_EQ(packet(3, 0), Bytes());
}

TEST(Api, APacketWithoutAStatusForThreeSecondsIsLost) {
    ApiModem modem(false);
    for (uint32_t at : {0u, 1'000'000u})
        modem.packet(5, Bytes{1}.data(), 1, 2, at);
    int lost = 0;
    modem.expire(3'500'000, [&] { ++lost; });
    EXPECT_EQ(lost, 1);
}

TEST(Api, StatusesArriveInOrderAndAMissingStatusCountsAsALoss) {
    ApiModem modem(false);
    Heard heard;
    for (int i = 0; i < 300; ++i) // enough packets for the frame numbers to wrap around
        modem.packet(1, Bytes{1}.data(), 1, 2, 0);
    for (int i = 0; i < 296; ++i)
        heard.feed(modem, ApiFrames().pack({0x89, static_cast<uint8_t>(i % 255 + 1), 0}));
    EXPECT_EQ(heard.answers, std::string(296, '+'));
    heard.answers.clear();
    heard.feed(modem, ApiFrames().pack({0x89, 298 % 255, 2}));
    // the packet was already reported, so no packet waits for this answer
    heard.feed(modem, ApiFrames().pack({0x89, 298 % 255, 0}));
    Bytes spoilt = ApiFrames().pack({0x89, 299 % 255, 0});
    spoilt.back() ^= 1;
    heard.feed(modem, spoilt);
    heard.feed(modem, ApiFrames().pack({0x89, 300 % 255, 0}));
    EXPECT_EQ(heard.answers, "---+");
}

TEST(Api, FramesAreFoundAgainAfterNoise) {
    Random random(testSeed());
    for (bool escapes : {false, true}) {
        const ApiFrames frames(escapes);
        ApiModem modem(escapes);
        for (int turn = 0; turn < 300; ++turn) {
            Heard heard;
            for (uint32_t i = random.below(40); i; --i)
                heard.feed(modem, {static_cast<uint8_t>(random.below(4) ? random.next() : 0x7E)});
            // the noise may look like the beginning of a frame, which can delay at most these three
            // frames
            for (int i = 0; i < 3; ++i)
                heard.feed(modem, packetFrom(frames, 1, Bytes(60, 0x55)));
            heard.data.clear();
            heard.feed(modem, packetFrom(frames, 1, {1, 2, 3}));
            ASSERT_GE(heard.data.size(), 3u);
            EXPECT_EQ(Bytes(heard.data.end() - 3, heard.data.end()), (Bytes{1, 2, 3}));
        }
    }
}

} // namespace
