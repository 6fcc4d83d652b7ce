// SPDX-License-Identifier: MIT
//
// modem_setup_test: setting the modem up, resets, and puts that are refused, pin by pin.

#include "modem_test.h"

namespace {

TEST_F(ModemTest, SetUpFromFactorySettings) {
    power(quick());
    configure();
    EXPECT_EQ(takeEvents(), MODEM_EVENT_CONFIGURED_MASK);
    EXPECT_EQ(near_->parameter("MY"), 0x0001u);
    EXPECT_EQ(near_->parameter("DL"), 0x0000u);
    EXPECT_EQ(near_->parameter("CH"), 0x0Cu);
    EXPECT_EQ(near_->parameter("ID"), 0x3332u);
    EXPECT_EQ(near_->parameter("BD"), 7u);
    EXPECT_FALSE(near_->inCommandMode());
    EXPECT_TRUE(bus_.read(MODEM_STATUS) & MODEM_STATUS_READY_MASK);
    EXPECT_EQ(near_->counters().refused, 0u);
}

TEST_F(ModemTest, SetUpWithDefaultGuardTimes) {
    power({});
    configure(7, 1000);
    EXPECT_EQ(takeEvents(), MODEM_EVENT_CONFIGURED_MASK);
    EXPECT_EQ(near_->parameter("BD"), 7u);
}

TEST_F(ModemTest, SetUpFindsAModemAtAnUnexpectedRate) {
    power(quick({{"BD", 4}}));
    configure();
    EXPECT_EQ(takeEvents(), MODEM_EVENT_CONFIGURED_MASK);
    EXPECT_EQ(near_->parameter("BD"), 7u);
}

TEST_F(ModemTest, AControllerWithoutApiModeSaysSoAndLeavesTheModemTransparent) {
    power(quick({{"AP", 0}}));
    bus_.write(MODEM_NET, 0x3332u << MODEM_NET_PAN_LSB | 1u << MODEM_NET_API_LSB | 0x0C);
    configure();
    EXPECT_EQ(takeEvents(), MODEM_EVENT_CONFIGURED_MASK);
    EXPECT_EQ(near_->parameter("AP"), 0u);
    EXPECT_FALSE(bus_.read(MODEM_STATUS) & MODEM_STATUS_API_MASK);
    put(0, frame(37, 0x7E));
    runMs(30);
    EXPECT_EQ(plain_.received, frame(37, 0x7E));
}

TEST_F(ModemTest, AWireNeedsNoSetUp) {
    power(quick({{"BD", 6}}));
    near_->power(false, now());
    bus_.write(MODEM_BAUD, MODEM_BAUD_WIRE_MASK | 7);
    bus_.write(MODEM_CONTROL, MODEM_CONTROL_CONFIGURE_MASK);
    unsigned lows = 0; // clocks in which the line is not idle
    for (unsigned i = 0; i < 100'000; ++i, bench_.tick())
        lows += !bench_.top().modem_txd_o;
    EXPECT_EQ(lows, 0u) << "something was sent";
    EXPECT_EQ(takeEvents(), MODEM_EVENT_CONFIGURED_MASK);
    const uint32_t status = bus_.read(MODEM_STATUS);
    EXPECT_TRUE(status & MODEM_STATUS_READY_MASK);
    EXPECT_EQ(status >> MODEM_STATUS_BD_LSB, 7u);
    const auto packet = frame(20, 0x5A);
    bytesIn(packet, bitClocks);
    runMs(2);
    EXPECT_EQ(take(), packet);
    put(0, {0x55});
    bench_.waitFor([&] { return !bench_.top().modem_txd_o; }, "the start bit", 10'000);
    const uint64_t begin = bench_.cycles();
    bench_.waitFor([&] { return bench_.top().modem_txd_o; }, "the first bit", 100);
    EXPECT_NEAR(static_cast<double>(bench_.cycles() - begin), bitClocks, 1);
}

TEST_F(ModemTest, NoModemIsReportedWithItsStep) {
    power(quick());
    near_->power(false, now());
    configure();
    EXPECT_EQ(takeEvents(), MODEM_EVENT_CONFIGURE_FAILED_MASK);
    EXPECT_EQ(bus_.read(MODEM_STATUS) >> MODEM_STATUS_STEP_LSB & 15, 1u);
    EXPECT_FALSE(bus_.read(MODEM_STATUS) & MODEM_STATUS_READY_MASK);
}

TEST_F(ModemTest, ARefusedCommandIsReportedWithItsStep) {
    power(quick());
    near_->refuseCommand("CH");
    configure();
    EXPECT_EQ(takeEvents(), MODEM_EVENT_CONFIGURE_FAILED_MASK);
    EXPECT_EQ(bus_.read(MODEM_STATUS) >> MODEM_STATUS_STEP_LSB & 15, 5u);
    EXPECT_EQ(near_->counters().refused, 3u) << "sent once and twice again";
}

TEST_F(ModemTest, EncryptionAndItsKeyAreSet) {
    power(quick());
    bus_.write(MODEM_NET, 0x3332u << MODEM_NET_PAN_LSB | 1u << MODEM_NET_ENCRYPT_LSB | 0x0C);
    for (uint32_t word : {0x00112233u, 0x44556677u, 0x8899AABBu, 0xCCDDEEFFu})
        bus_.write(MODEM_KEY, word);
    configure();
    EXPECT_EQ(takeEvents(), MODEM_EVENT_CONFIGURED_MASK);
    EXPECT_EQ(near_->parameter("EE"), 1u);
    EXPECT_EQ(near_->key(), "00112233445566778899AABBCCDDEEFF");
    EXPECT_EQ(bus_.read(MODEM_KEY), 0u) << "it cannot be read back";
}

TEST_F(ModemTest, TheKeyIsSentOnlyWithEncryption) {
    power(quick());
    near_->refuseCommand("KY");
    configure();
    EXPECT_EQ(takeEvents(), MODEM_EVENT_CONFIGURED_MASK);
    EXPECT_EQ(near_->parameter("EE"), 0u);
    EXPECT_EQ(near_->parameter("D6"), 1u);
    EXPECT_EQ(near_->parameter("D7"), 1u);
    EXPECT_EQ(near_->parameter("RN"), 2u) << "modems that write in step";
}

TEST_F(ModemTest, WrongPutsAreRefused) {
    power(quick());
    bus_.write(MODEM_TX_PUT, 10); // before the set-up
    EXPECT_EQ(takeEvents(), MODEM_EVENT_TX_REFUSED_MASK);
    configure();
    takeEvents();
    for (uint32_t bytes : {0u, 101u, 255u}) {
        bus_.write(MODEM_TX_PUT, bytes);
        EXPECT_EQ(takeEvents(), MODEM_EVENT_TX_REFUSED_MASK) << bytes;
    }
    for (unsigned i = 0; i < 17; ++i)
        bus_.write(MODEM_TX_PUT, 100);
    EXPECT_TRUE(takeEvents() & MODEM_EVENT_TX_REFUSED_MASK) << "the ring is full";
}

TEST_F(ModemTest, ResetInMidPacketAndSetUpAgain) {
    ready();
    put(0, frame(100, 1));
    runMs(4);
    bus_.write(MODEM_CONTROL, MODEM_CONTROL_RESET_MODEM_MASK);
    runMs(80);
    EXPECT_EQ(near_->parameter("BD"), 3u) << "nothing was written to its memory";
    EXPECT_EQ(bus_.read(MODEM_TX_STATE), 16u);
    configure();
    EXPECT_TRUE(takeEvents() & MODEM_EVENT_CONFIGURED_MASK);
    put(0, frame(40, 3));
    runMs(20);
    ASSERT_GE(plain_.received.size(), 40u);
    EXPECT_EQ(std::vector<uint8_t>(plain_.received.end() - 40, plain_.received.end()),
              frame(40, 3));
}

TEST_F(ModemTest, APacketThatASetUpInterruptsIsSentAgainWhole) {
    ready();
    put(0, frame(100, 1));
    runMs(4);
    configure(); // in mid packet
    EXPECT_TRUE(takeEvents() & MODEM_EVENT_CONFIGURED_MASK);
    runMs(40);
    ASSERT_GE(plain_.received.size(), 100u);
    EXPECT_EQ(std::vector<uint8_t>(plain_.received.end() - 100, plain_.received.end()),
              frame(100, 1));
    EXPECT_EQ(bus_.read(MODEM_TX_STATE) & MODEM_TX_STATE_FREE_MASK, 16u);
}

} // namespace
