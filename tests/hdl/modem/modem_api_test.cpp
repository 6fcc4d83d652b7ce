// SPDX-License-Identifier: MIT
//
// modem_api_test: tests the modem controller with API frames (parameter API), at 250,000 baud.

#include "VModemApi.h"
#include "modem_rig.h"

namespace {

class ModemApi : public ModemRig<VModemApi, 250> {
protected:
    void ready(unsigned mode = 1) {
        power(quick());
        bus_.write(MODEM_NET, 0x3332u << MODEM_NET_PAN_LSB | mode << MODEM_NET_API_LSB | 0x0C);
        configure(250000);
        ASSERT_EQ(takeEvents(), MODEM_EVENT_CONFIGURED_MASK);
    }
    // Returns a packet of any size. In API mode the frame marks the end of a packet, so the first
    // byte need not contain the length.
    static std::vector<uint8_t> packet(size_t size, uint8_t tag) {
        std::vector<uint8_t> bytes(size);
        for (size_t i = 0; i < size; ++i)
            bytes[i] = static_cast<uint8_t>(tag + 7 * i);
        return bytes;
    }
    static constexpr unsigned bitClocks = 16;
    static std::vector<uint8_t> apiFrame(const std::vector<uint8_t>& body) {
        std::vector<uint8_t> bytes = {0x7E, static_cast<uint8_t>(body.size() >> 8),
                                      static_cast<uint8_t>(body.size())};
        uint8_t sum = 0xFF;
        for (uint8_t byte : body) {
            bytes.push_back(byte);
            sum = static_cast<uint8_t>(sum - byte);
        }
        bytes.push_back(sum);
        return bytes;
    }
    static std::vector<uint8_t> join(std::vector<uint8_t> head, const std::vector<uint8_t>& rest) {
        head.insert(head.end(), rest.begin(), rest.end());
        return head;
    }
    // Return the contents of an API frame: `sent` for a packet to a target, `received` for a packet
    // from modem 0.
    static std::vector<uint8_t> sent(const std::vector<uint8_t>& packet, uint16_t target = 0,
                                     uint8_t id = 0) {
        return join({0x01, id, static_cast<uint8_t>(target >> 8), static_cast<uint8_t>(target), 0},
                    packet);
    }
    static std::vector<uint8_t> received(const std::vector<uint8_t>& packet) {
        return join({0x81, 0x00, 0x00, 40, 0x00}, packet);
    }
    // Returns the packet in the oldest received frame, without the other fields of the frame.
    std::vector<uint8_t> takePacket() {
        auto contents = take();
        EXPECT_GT(contents.size(), 5u);
        EXPECT_EQ(contents[0] << 16 | contents[1] << 8 | contents[2], 0x810000);
        contents.erase(contents.begin(), contents.begin() + 5);
        return contents;
    }
};

TEST_F(ModemApi, SetUpChoosesFramesAnd250000Baud) {
    ready();
    EXPECT_EQ(near_->parameter("AP"), 1u);
    EXPECT_EQ(near_->parameter("BD"), 250000u);
}

TEST_F(ModemApi, PacketsAreSentWithoutAPauseAsOneRfPacketEach) {
    ready();
    std::vector<uint8_t> expected;
    const std::vector<unsigned> lengths = {1, 7, 8, 9, 100, 100, 64, 33, 5};
    for (unsigned i = 0; i < lengths.size(); ++i) {
        auto bytes = packet(lengths[i], static_cast<uint8_t>(i * 0x31));
        put(i, sent(bytes));
        expected.insert(expected.end(), bytes.begin(), bytes.end());
    }
    runMs(80);
    EXPECT_EQ(plain_.received, expected);
    EXPECT_EQ(sizes_, std::vector<size_t>(lengths.begin(), lengths.end()));
    EXPECT_EQ(takeEvents(), MODEM_EVENT_TX_DONE_MASK);
    EXPECT_EQ(near_->counters().badFrames, 0u);
}

TEST_F(ModemApi, EachPacketReachesItsTarget) {
    ready();
    const std::vector<uint16_t> wanted = {0x5A5A, 0xA5A5, 0x0000, 0xFF00};
    for (unsigned i = 0; i < wanted.size(); ++i) {
        put(i, sent(packet(16 + i, static_cast<uint8_t>(i)), wanted[i]));
        runMs(30);
    }
    EXPECT_EQ(targets_, wanted);
}

TEST_F(ModemApi, EachPacketArrivesInASeparateBuffer) {
    ready();
    for (unsigned i = 0; i < 20; ++i) {
        auto bytes = packet(1 + i * 37 % 100, static_cast<uint8_t>(i));
        plain_.send(bytes, now());
        runMs(14);
        EXPECT_EQ(takeEvents(), MODEM_EVENT_RX_PACKET_MASK) << i;
        EXPECT_EQ(takePacket(), bytes) << i;
    }
}

TEST_F(ModemApi, EachPacketHasADeliveryStatus) {
    ready();
    put(0, sent(packet(10, 1), 0, 0x7E));
    runMs(60);
    EXPECT_EQ(take(), (std::vector<uint8_t>{0x89, 0x7E, 0}));
    far_->power(false, now());
    put(1, sent(packet(100, 1), 0, 0xFF));
    runMs(60);
    EXPECT_EQ(takeEvents(), MODEM_EVENT_TX_DONE_MASK | MODEM_EVENT_RX_PACKET_MASK);
    EXPECT_EQ(take(), (std::vector<uint8_t>{0x89, 0xFF, 1}));
}

TEST_F(ModemApi, SetUpMayLeaveTheModemTransparent) {
    ready(0);
    EXPECT_TRUE(bus_.read(MODEM_STATUS) & MODEM_STATUS_API_MASK);
    EXPECT_EQ(near_->parameter("AP"), 0u);
    const auto out = frame(37, 0x7E), in = frame(100, 0x7E);
    put(0, out);
    plain_.send(in, now());
    runMs(30);
    EXPECT_EQ(plain_.received, out);
    EXPECT_EQ(take(), in);
}

TEST_F(ModemApi, PacketsOfWrongLengthsAreRefused) {
    ready();
    for (size_t size : {0, 106, 128}) {
        put(0, packet(size, 1));
        EXPECT_EQ(takeEvents(), MODEM_EVENT_TX_REFUSED_MASK) << size;
    }
    put(0, sent(packet(100, 1)));
    EXPECT_EQ(takeEvents(), 0u);
}

TEST_F(ModemApi, ACorruptedFrameIsDroppedAndTheNextIsComplete) {
    ready();
    plain_.send(packet(100, 5), now());
    runMs(7.3); // after this time the frame is on the line
    noise_ = true;
    runMs(0.1);
    noise_ = false;
    runMs(10);
    EXPECT_TRUE(take().empty());
    EXPECT_GE(bus_.read(MODEM_ERRORS) >> MODEM_ERRORS_OVERRUN_LSB & 0xFF, 1u);
    auto wrong = apiFrame(received(packet(30, 7)));
    wrong.back() ^= 1;
    bytesIn(wrong, bitClocks);
    EXPECT_TRUE(take().empty());
    plain_.send(packet(30, 8), now());
    runMs(14);
    EXPECT_EQ(takePacket(), packet(30, 8));
}

// Frames follow each other without pauses, so that the receiver finds a frame only by the end of
// the previous one.
TEST_F(ModemApi, FramesOfAllTypesAreReadAndTooLongOnesSkipped) {
    ready();
    Random random(testSeed());
    auto other = [&](uint8_t type, size_t size) {
        std::vector<uint8_t> body(size);
        for (uint8_t& byte : body)
            byte = static_cast<uint8_t>(1 + random.below(0x7D)); // no delimiter
        body[0] = type;
        return body;
    };
    const std::vector<std::vector<uint8_t>> strangers = {
        other(0x8A, 1 + random.below(2)),   // a status of the modem, or its first byte only
        other(0x88, 5),                     // a reply
        other(0x80, 12 + random.below(98)), // a packet from a sender with a 64-bit address
        other(0x80, 111),                   // the longest frame that a modem sends
        other(0x81, 112),                   // more data than a modem sends
        other(0x81, 255),                   // the longest frame with a one-byte length
        // a length with a low byte that would be valid without the high byte
        other(0x81, 0x105),
    };
    for (size_t i = 0; i < strangers.size(); ++i) {
        auto before = packet(1 + random.below(100), 1), after = packet(1 + random.below(100), 2);
        bytesIn(apiFrame(received(before)), bitClocks);
        bytesIn(apiFrame(strangers[i]), bitClocks);
        bytesIn(apiFrame(received(after)), bitClocks);
        runMs(0.1);
        EXPECT_EQ(takePacket(), before) << i << ", SEED " << testSeed();
        if (strangers[i].size() < 112) {
            EXPECT_EQ(take(), strangers[i]) << i << ", SEED " << testSeed();
        }
        EXPECT_EQ(takePacket(), after) << i << ", SEED " << testSeed();
        EXPECT_TRUE(take().empty()) << i;
        EXPECT_EQ(takeEvents(), MODEM_EVENT_RX_PACKET_MASK) << i;
    }
    EXPECT_EQ(errors(), 0u);
}

TEST_F(ModemApi, AModemThatLostPowerIsSetUpAgain) {
    ready();
    near_->power(false, now());
    // the modem boots in transparent mode at 9600 baud, which the controller receives as noise
    near_->power(true, now());
    plain_.send(packet(50, 1), now());
    runMs(100);
    while (!take().empty()) {
    }
    takeEvents();
    configure(250000);
    EXPECT_EQ(takeEvents(), MODEM_EVENT_CONFIGURED_MASK)
        << "step " << (bus_.read(MODEM_STATUS) >> MODEM_STATUS_STEP_LSB & 15);
    plain_.send(packet(30, 8), now());
    runMs(14);
    EXPECT_EQ(takePacket(), packet(30, 8));
}

} // namespace
