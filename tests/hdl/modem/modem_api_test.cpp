// SPDX-License-Identifier: MIT
//
// modem_api_test: the modem controller in API mode (parameter API), at 250,000 baud.

#include "VModemApi.h"
#include "modem_rig.h"

namespace {

class ModemApi : public ModemRig<VModemApi, 250> {
protected:
    void ready() {
        power(quick());
        configure(250000);
        ASSERT_EQ(takeEvents(), MODEM_EVENT_CONFIGURED_MASK);
    }
    // Bytes of any size: the frame ends a packet, not its first byte.
    static std::vector<uint8_t> packet(size_t size, uint8_t tag) {
        std::vector<uint8_t> bytes(size);
        for (size_t i = 0; i < size; ++i)
            bytes[i] = static_cast<uint8_t>(tag + 7 * i);
        return bytes;
    }
};

TEST_F(ModemApi, SetUpChoosesFramesAnd250000Baud) {
    ready();
    EXPECT_EQ(near_->parameter("AP"), 1u);
    EXPECT_EQ(near_->parameter("BD"), 250000u);
}

TEST_F(ModemApi, PacketsLeaveWithoutAPauseEachAsOneRfPacket) {
    ready();
    std::vector<size_t> sizes;
    air_.onPacket(
        [&](uint64_t, const RfPacket& p, RfChannel::Outcome) { sizes.push_back(p.bytes.size()); });
    std::vector<uint8_t> expected;
    const std::vector<unsigned> lengths = {1, 7, 8, 9, 100, 100, 64, 33, 5};
    for (unsigned i = 0; i < lengths.size(); ++i) {
        auto bytes = packet(lengths[i], static_cast<uint8_t>(i * 0x31));
        put(i, bytes);
        expected.insert(expected.end(), bytes.begin(), bytes.end());
    }
    runMs(80);
    EXPECT_EQ(plain_.received, expected);
    EXPECT_EQ(sizes, std::vector<size_t>(lengths.begin(), lengths.end()));
    EXPECT_EQ(takeEvents(), MODEM_EVENT_TX_DONE_MASK);
    EXPECT_EQ(near_->counters().badFrames, 0u);
}

TEST_F(ModemApi, EachPacketGoesToTheTargetOfItsTime) {
    ready();
    std::vector<uint16_t> targets;
    air_.onPacket([&](uint64_t, const RfPacket& p, RfChannel::Outcome) { targets.push_back(p.to); });
    const std::vector<uint16_t> wanted = {0x5A5A, 0xA5A5, 0x0000, 0xFF00};
    for (unsigned i = 0; i < wanted.size(); ++i) {
        bus_.write(MODEM_ADDR, uint32_t(wanted[i]) << MODEM_ADDR_TARGET_LSB | 0x0001);
        put(i, packet(16 + i, static_cast<uint8_t>(i)));
        runMs(30);
    }
    EXPECT_EQ(targets, wanted);
}

TEST_F(ModemApi, PacketsArriveEachInItsBuffer) {
    ready();
    for (unsigned i = 0; i < 20; ++i) {
        auto bytes = packet(1 + i * 37 % 100, static_cast<uint8_t>(i));
        plain_.send(bytes, now());
        runMs(14);
        EXPECT_EQ(takeEvents(), MODEM_EVENT_RX_PACKET_MASK) << i;
        EXPECT_EQ(take(), bytes) << i;
    }
}

TEST_F(ModemApi, APacketThatTheModemGaveUpIsReported) {
    ready();
    far_->power(false, now());
    put(0, packet(10, 1));
    runMs(60);
    EXPECT_EQ(takeEvents(), MODEM_EVENT_TX_DONE_MASK | MODEM_EVENT_UNSENT_MASK);
    EXPECT_EQ(bus_.read(MODEM_ERRORS) >> MODEM_ERRORS_UNSENT_LSB, 1u);
}

TEST_F(ModemApi, ASpoiltFrameIsDroppedAndTheNextIsWhole) {
    ready();
    plain_.send(packet(100, 5), now());
    runMs(7.3); // the frame is on the line
    noise_ = true;
    runMs(0.1);
    noise_ = false;
    runMs(10);
    EXPECT_TRUE(take().empty());
    EXPECT_GE(bus_.read(MODEM_ERRORS) >> MODEM_ERRORS_OVERRUN_LSB & 0xFF, 1u);
    plain_.send(packet(30, 8), now());
    runMs(14);
    EXPECT_EQ(take(), packet(30, 8));
}

TEST_F(ModemApi, AModemThatLostItsPowerIsSetUpAgain) {
    ready();
    near_->power(false, now());
    near_->power(true, now()); // it boots transparent, at 9600 baud: noise for the controller
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
    EXPECT_EQ(take(), packet(30, 8));
}

} // namespace
