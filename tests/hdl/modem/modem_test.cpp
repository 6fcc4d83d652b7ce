// SPDX-License-Identifier: MIT
//
// modem_test: tests the set-up of the modem, resets, settings that are rejected, and packets to and
// from the modem, pin by pin. Proofs cover events that happen in the same clock (formal.modem_*).

#include "VModem.h"
#include "modem_rig.h"

namespace {

class ModemTest : public ModemRig<VModem, 500> {
protected:
    static constexpr unsigned bitClocks = 18; // number of clocks per bit at 111,111 baud

    void ready() {
        power(quick());
        configure();
        EXPECT_EQ(takeEvents(), MODEM_EVENT_CONFIGURED_MASK);
        EXPECT_TRUE(bus_.read(MODEM_STATUS) & MODEM_STATUS_READY_MASK);
        EXPECT_EQ(near_->counters().refused, 0u);
    }
};

TEST_F(ModemTest, SetUpWorksWithTheDefaultGuardTimes) {
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

TEST_F(ModemTest, AControllerWithoutApiModeLeavesTheModemTransparent) {
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
    unsigned lows = 0; // number of clocks in which the line was low (not idle)
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
    memory_.hold(true); // both directions now wait for the memory
    put(1, packet);
    bytesIn({packet[0]}, bitClocks);
    memory_.hold(false);
    bytesIn({packet.begin() + 1, packet.end()}, bitClocks);
    runMs(2);
    EXPECT_EQ(take(), packet);
}

TEST_F(ModemTest, AMissingModemIsReportedWithItsStep) {
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
    EXPECT_EQ(near_->counters().refused, 3u) << "the command must be sent once and repeated twice";
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
    EXPECT_EQ(bus_.read(MODEM_KEY), 0u) << "the key must not be readable";
}

TEST_F(ModemTest, TheKeyIsSentOnlyWithEncryption) {
    power(quick());
    near_->refuseCommand("KY");
    configure();
    EXPECT_EQ(takeEvents(), MODEM_EVENT_CONFIGURED_MASK);
    EXPECT_EQ(near_->parameter("EE"), 0u);
    EXPECT_EQ(near_->parameter("D6"), 1u);
    EXPECT_EQ(near_->parameter("D7"), 1u);
    EXPECT_EQ(near_->parameter("RN"), 2u)
        << "RN must be 2, so that modems that send at the same time do not collide";
}

TEST_F(ModemTest, WrongWritesOfPutAreRefused) {
    power(quick());
    bus_.write(MODEM_TX_PUT, 10); // a packet is written before the set-up
    EXPECT_EQ(takeEvents(), MODEM_EVENT_TX_REFUSED_MASK);
    configure();
    takeEvents();
    for (uint32_t bytes : {0u, 101u, 255u}) {
        bus_.write(MODEM_TX_PUT, bytes);
        EXPECT_EQ(takeEvents(), MODEM_EVENT_TX_REFUSED_MASK) << bytes;
    }
    for (unsigned i = 0; i < 17; ++i)
        bus_.write(MODEM_TX_PUT, 100);
    EXPECT_TRUE(takeEvents() & MODEM_EVENT_TX_REFUSED_MASK)
        << "a packet must be refused, because the ring is full";
}

TEST_F(ModemTest, AResetInMidPacketIsFollowedByASetUp) {
    ready();
    put(0, frame(100, 1));
    runMs(4);
    bus_.write(MODEM_CONTROL, MODEM_CONTROL_RESET_MODEM_MASK);
    runMs(80);
    EXPECT_EQ(near_->parameter("BD"), 3u)
        << "the set-up must not write the modem's permanent settings";
    EXPECT_EQ(bus_.read(MODEM_TX_STATE), 16u);
    configure();
    EXPECT_TRUE(takeEvents() & MODEM_EVENT_CONFIGURED_MASK);
    put(0, frame(40, 3));
    runMs(20);
    ASSERT_GE(plain_.received.size(), 40u);
    EXPECT_EQ(std::vector<uint8_t>(plain_.received.end() - 40, plain_.received.end()),
              frame(40, 3));
}

TEST_F(ModemTest, APacketInterruptedByASetUpIsSentAgain) {
    ready();
    put(0, frame(100, 1));
    runMs(4);
    configure(); // the set-up begins in the middle of a packet
    EXPECT_TRUE(takeEvents() & MODEM_EVENT_CONFIGURED_MASK);
    runMs(40);
    ASSERT_GE(plain_.received.size(), 100u);
    EXPECT_EQ(std::vector<uint8_t>(plain_.received.end() - 100, plain_.received.end()),
              frame(100, 1));
    EXPECT_EQ(bus_.read(MODEM_TX_STATE) & MODEM_TX_STATE_FREE_MASK, 16u);
}

TEST_F(ModemTest, EachPacketIsSentAsOneRfPacket) {
    ready();
    std::vector<uint8_t> expected;
    const std::vector<unsigned> lengths = {1, 7, 8, 9, 100, 100, 64, 33, 5};
    for (size_t i = 0; i < lengths.size(); ++i) {
        std::vector<uint8_t> packet(lengths[i], static_cast<uint8_t>(i + 1));
        put(static_cast<unsigned>(i), packet);
        expected.insert(expected.end(), packet.begin(), packet.end());
        // without this pause, a modem that is busy on the air could combine two waiting packets
        runMs(16);
    }
    EXPECT_EQ(plain_.received, expected);
    EXPECT_EQ(sizes_, std::vector<size_t>(lengths.begin(), lengths.end()));
    EXPECT_EQ(takeEvents(), MODEM_EVENT_TX_DONE_MASK);
    EXPECT_EQ(bus_.read(MODEM_TX_STATE), 9u << 8 | 16u);
}

// A modem with encryption sends a packet as soon as it has 95 bytes, so no pause is needed after
// such a packet.
TEST_F(ModemTest, ConsecutiveEncryptedPacketsHave95Bytes) {
    power(quick());
    bus_.write(MODEM_NET, 0x3332u << MODEM_NET_PAN_LSB | 1u << MODEM_NET_ENCRYPT_LSB | 0x0C);
    for (int word = 0; word < 4; ++word)
        bus_.write(MODEM_KEY, 0);
    configure();
    takeEvents();
    for (unsigned i = 0; i < 10; ++i)
        put(i, frame(95, static_cast<uint8_t>(i)));
    double begin = static_cast<double>(now());
    for (int tenths = 0; tenths < 2000 && (bus_.read(MODEM_TX_STATE) & 0xFF) != 16; ++tenths)
        runMs(0.1);
    EXPECT_LT((static_cast<double>(now()) - begin) / 1e6, 950 * 0.09 + 1)
        << "ms; rests would be 3.6";
    runMs(10);
    EXPECT_EQ(sizes_, std::vector<size_t>(10, 100))
        << "a packet has five additional bytes of the cipher";
}

TEST_F(ModemTest, ConsecutiveShortPacketsAreNotJoined) {
    ready();
    put(0, frame(40, 1));
    put(1, frame(40, 2));
    runMs(30);
    EXPECT_EQ(sizes_, (std::vector<size_t>{40, 40}));
}

TEST_F(ModemTest, PacketsStayWholeIfCtsChangesInAnyClock) {
    ready();
    ctsWavers_ = true;
    std::vector<uint8_t> sent;
    for (unsigned i = 0; i < 4; ++i) {
        const auto packet = frame(100, static_cast<uint8_t>(0x35 + i));
        sent.insert(sent.end(), packet.begin(), packet.end());
        put(i, packet);
    }
    runMs(100);
    EXPECT_EQ(plain_.received, sent);
}

TEST_F(ModemTest, AFullModemStopsTheController) {
    ready();
    air_.weather.delayNs = 200'000'000; // each packet keeps the modem busy for this time
    for (unsigned i = 0; i < 6; ++i)
        put(i, frame(100, static_cast<uint8_t>(i)));
    runMs(1500);
    EXPECT_EQ(near_->counters().overflow, 0u);
    EXPECT_EQ(plain_.received.size(), 600u);
}

TEST_F(ModemTest, EachPacketArrivesInASeparateBuffer) {
    ready();
    std::vector<std::vector<uint8_t>> sent;
    for (unsigned i = 0; i < 20; ++i) {
        sent.push_back(frame(5 + i * 13 % 96, static_cast<uint8_t>(i)));
        plain_.send(sent.back(), now());
        runMs(16);
        EXPECT_EQ(takeEvents(), MODEM_EVENT_RX_PACKET_MASK) << i;
        EXPECT_EQ(take(), sent.back()) << i;
    }
}

TEST_F(ModemTest, ThreeCharactersOfSilenceEndAPacket) {
    ready();
    std::vector<uint8_t> cut = frame(60, 9);
    cut.resize(21);
    plain_.send(cut, now());
    runMs(10);
    EXPECT_EQ(take(), cut);
}

TEST_F(ModemTest, AFullRingDropsOnlyWholePackets) {
    ready();
    pinsIgnoreRts_ = true; // the modem ignores RTS
    for (unsigned i = 0; i < 18; ++i) {
        plain_.send(frame(50, static_cast<uint8_t>(i + 1)), now());
        runMs(10);
    }
    EXPECT_TRUE(bench_.top().modem_rts_n_o);
    EXPECT_EQ(takeEvents(), MODEM_EVENT_RX_PACKET_MASK | MODEM_EVENT_RX_OVERRUN_MASK);
    EXPECT_EQ(bus_.read(MODEM_ERRORS) >> MODEM_ERRORS_OVERRUN_LSB & 0xFF, 2u);
    for (unsigned i = 0; i < 16; ++i)
        EXPECT_EQ(take(), frame(50, static_cast<uint8_t>(i + 1))) << i;
    EXPECT_TRUE(take().empty());
    plain_.send(frame(50, 99), now());
    runMs(10);
    EXPECT_EQ(take(), frame(50, 99)) << "a packet after the fault must arrive";
}

TEST_F(ModemTest, RTSPausesAPacketWithoutSplittingIt) {
    ready();
    for (unsigned i = 0; i < 13; ++i) {
        plain_.send(frame(20, static_cast<uint8_t>(i + 1)), now());
        runMs(10);
    }
    // Both frames are in one RF packet, so they arrive without a pause. The memory accepts the last
    // byte of the first frame only after the second frame has begun.
    auto both = frame(50, 14);
    const auto second = frame(50, 15);
    both.insert(both.end(), second.begin(), second.end());
    const uint64_t end = near_->counters().bytesToHost + 50;
    plain_.send(both, now());
    for (uint64_t byte : {end, end + 1}) {
        bench_.waitFor([&] { return near_->counters().bytesToHost >= byte; }, "a byte", 100'000);
        // after this time the previous byte is in memory, even if the memory was slow
        runMs(byte == end ? 0.02 : 0);
        memory_.hold(byte == end);
    }
    runMs(50);
    EXPECT_TRUE(bench_.top().modem_rts_n_o);
    for (unsigned i = 0; i < 13; ++i)
        EXPECT_EQ(take(), frame(20, static_cast<uint8_t>(i + 1))) << i;
    EXPECT_FALSE(bench_.top().modem_rts_n_o);
    runMs(10);
    EXPECT_EQ(take(), frame(50, 14));
    EXPECT_EQ(take(), frame(50, 15));
}

TEST_F(ModemTest, AFramingErrorEndsThePacketAndIsCounted) {
    ready();
    plain_.send(frame(50, 7), now());
    runMs(5.5);
    noise_ = true; // a break begins in the middle of the byte
    runMs(0.3);
    noise_ = false;
    runMs(10);
    EXPECT_GE(bus_.read(MODEM_ERRORS) & 0xFF, 1u);
    while (!take().empty()) {
    }
    plain_.send(frame(30, 8), now());
    runMs(10);
    EXPECT_EQ(take(), frame(30, 8));
}

} // namespace
