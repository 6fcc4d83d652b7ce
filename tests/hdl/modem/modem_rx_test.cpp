// SPDX-License-Identifier: MIT
//
// modem_rx_test: packets from the modem, pin by pin.

#include "modem_test.h"

namespace {

TEST_F(ModemTest, PacketsArriveEachInItsBuffer) {
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

TEST_F(ModemTest, AFullRingDropsWholePacketsAndNothingElse) {
    ready();
    pinsIgnoreRts_ = true; // a modem that ignores RTS
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
    EXPECT_EQ(take(), frame(50, 99)) << "it goes on";
}

TEST_F(ModemTest, RTSHoldsTheModemInMidPacketAndThePacketIsWhole) {
    ready();
    for (unsigned i = 0; i < 13; ++i) {
        plain_.send(frame(20, static_cast<uint8_t>(i + 1)), now());
        runMs(10);
    }
    sendAndHold(frame(50, 14), frame(50, 15), 1); // the fourteenth is complete when that has begun
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
    noise_ = true; // a break in the middle
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

TEST_F(ModemRingsMeet, AReleaseInTheClockOfANewPacket) {
    readyAtOnce();
    bytesIn(frame(5, 1), bitClocks);
    runMs(0.1);
    for (unsigned i = 0; i < bitClocks * rounds; ++i) {
        unsigned after = i % bitClocks, buffer = (i + 1) % 16;
        std::string when = std::to_string(after) + ", SEED " + std::to_string(testSeed());
        auto packet = frame(5, static_cast<uint8_t>(0x80 | i)); // its last bit is as the stop bit
        uint32_t get = MODEM_RX_GET_VALID_MASK | buffer << 8 | 5u;
        level(true, random_.below(9));
        bytesIn({packet.begin(), packet.end() - 1}, bitClocks);
        byteIn(packet.back(), bitClocks, after);
        bus_.write(MODEM_RX_RELEASE, 1);
        level(true, 2 * bitClocks);
        EXPECT_EQ(bus_.read(MODEM_RX_GET), get) << when;
        for (uint32_t byte = 0; byte < 5; ++byte)
            EXPECT_EQ(memory_.byte(rxRing + 128 * buffer + byte), packet[byte]) << when;
    }
    EXPECT_EQ(takeEvents(), MODEM_EVENT_RX_PACKET_MASK);
    EXPECT_FALSE(take().empty());
    EXPECT_TRUE(take().empty()) << "none was doubled";
    EXPECT_EQ(errors(), 0u);
}

TEST_F(ModemTest, AStalledMemoryCostsTheNextPacketNotTheOneBefore) {
    ready();
    sendAndHold(frame(50, 1), frame(50, 2), 12); // until the first word of the second is complete
    runMs(10);
    EXPECT_EQ(take(), frame(50, 1));
    EXPECT_TRUE(take().empty());
    EXPECT_EQ(bus_.read(MODEM_ERRORS) >> MODEM_ERRORS_OVERRUN_LSB & 0xFF, 1u);
    plain_.send(frame(50, 3), now());
    runMs(10);
    EXPECT_EQ(take(), frame(50, 3)) << "it goes on";
}

// Fifteen packets fill the ring but for one buffer; one more comes whole, and the next has this
// many bytes while memory is held: only that one is dropped.
class ModemFullRing : public ModemTest {
protected:
    void nextHasBegun(uint64_t bytes) {
        ready();
        pinsIgnoreRts_ = true;
        for (unsigned i = 0; i < 15; ++i) {
            plain_.send(frame(20, static_cast<uint8_t>(i + 1)), now());
            runMs(10);
        }
        sendAndHold(frame(50, 16), frame(50, 99), bytes);
        runMs(10);
        for (unsigned i = 0; i < 15; ++i)
            EXPECT_EQ(take(), frame(20, static_cast<uint8_t>(i + 1))) << i;
        EXPECT_EQ(take(), frame(50, 16));
        EXPECT_TRUE(take().empty());
        EXPECT_EQ(bus_.read(MODEM_ERRORS) >> MODEM_ERRORS_OVERRUN_LSB & 0xFF, 1u);
    }
};

TEST_F(ModemFullRing, APacketThatIsStillBeingWrittenCountsAsABuffer) {
    nextHasBegun(3);
}

TEST_F(ModemFullRing, APacketThatWaitsAsTheRingFillsIsDropped) {
    nextHasBegun(2); // its first byte is here, and waits
}

// Memory takes a packet's last byte in the very clock of its end, or a few before or after. In time
// the packet is whole, else it is dropped and counted; it is never cut.
TEST_F(ModemTest, TheLastByteIsTakenAroundTheClockOfAFramingError) {
    ready();
    memory_.setStall(0);
    Random random(testSeed());
    const std::vector<uint8_t> cut = {95, 2, 3, 4}; // of a packet of 100
    const std::vector<uint8_t> next = frame(7, 9);  // no silence before it: it must not be joined
    unsigned whole = 0, dropped = 0;
    for (unsigned i = 0; i < 36 * 4; ++i) {
        unsigned clocks = i % 36;
        level(true, random.below(9)); // the baud rate's ticks move against the clock of the test
        bytesIn({cut.begin(), cut.end() - 2}, bitClocks);
        memory_.hold(true); // the byte before is being written, the last one waits for it
        bytesIn({cut.end() - 2, cut.end()}, bitClocks);
        level(false, 9 * bitClocks - 9 + clocks); // a break
        memory_.hold(false);
        level(false, 2 * bitClocks);
        level(true, 5 * bitClocks);
        bytesIn(next, bitClocks);
        level(true, 40 * bitClocks);
        auto packet = take();
        if (packet == cut) {
            ++whole;
            EXPECT_EQ(take(), next) << "clock " << clocks;
        } else {
            ++dropped;
            EXPECT_EQ(packet, std::vector<uint8_t>()) << "clock " << clocks;
        }
        EXPECT_TRUE(take().empty());
        EXPECT_EQ(errors(), dropped << MODEM_ERRORS_OVERRUN_LSB | (i + 1)) << "clock " << clocks;
    }
    EXPECT_GT(whole, 0u);
    EXPECT_GT(dropped, 0u);
}

TEST_F(ModemTest, TheLastByteIsTakenAfterTheSilenceThatEndsThePacket) {
    ready();
    const std::vector<uint8_t> cut = {95, 2, 3, 4};
    bytesIn({cut.begin(), cut.end() - 2}, bitClocks);
    level(true, 2 * bitClocks); // they are in memory, however slow that was
    memory_.hold(true);
    bytesIn({cut.end() - 2, cut.end()}, bitClocks);
    level(true, 60 * bitClocks);
    EXPECT_EQ(takeEvents(), 0u) << "it is in memory before it is published";
    memory_.hold(false);
    runMs(0.1);
    EXPECT_EQ(takeEvents(), MODEM_EVENT_RX_PACKET_MASK);
    EXPECT_EQ(take(), cut);
}

} // namespace
