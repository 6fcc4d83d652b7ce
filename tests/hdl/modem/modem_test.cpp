// SPDX-License-Identifier: MIT
//
// modem_test: the modem controller against the XBee model, pin by pin.

#include "VModem.h"
#include "modem_rig.h"

namespace {

class ModemTest : public ModemRig<VModem, 500> {
protected:
    static constexpr unsigned bitClocks = 18; // at 111,111 baud
    static std::vector<uint8_t> ramp(unsigned size, uint8_t tag) {
        std::vector<uint8_t> bytes = frame(size, tag);
        for (unsigned i = 1; i < size; ++i)
            bytes[i] = static_cast<uint8_t>(tag + i);
        return bytes;
    }
};

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
    EXPECT_EQ(near_->parameter("RN"), 3u) << "modems that write in step";
}

TEST_F(ModemTest, PacketsLeaveEachAsOneRfPacket) {
    power(quick());
    configure();
    takeEvents();
    std::vector<size_t> sizes;
    air_.onPacket([&](uint64_t, const RfPacket& packet, RfChannel::Outcome outcome) {
        EXPECT_EQ(outcome, RfChannel::Outcome::Delivered);
        sizes.push_back(packet.bytes.size());
    });
    std::vector<uint8_t> expected;
    const std::vector<unsigned> lengths = {1, 7, 8, 9, 100, 100, 64, 33, 5};
    for (size_t i = 0; i < lengths.size(); ++i) {
        std::vector<uint8_t> packet(lengths[i], static_cast<uint8_t>(i + 1));
        put(static_cast<unsigned>(i), packet);
        expected.insert(expected.end(), packet.begin(), packet.end());
        runMs(16); // else the modem, busy on the air, may join two that wait in it
    }
    EXPECT_EQ(plain_.received, expected);
    EXPECT_EQ(sizes, std::vector<size_t>(lengths.begin(), lengths.end()));
    EXPECT_EQ(takeEvents(), MODEM_EVENT_TX_DONE_MASK);
    EXPECT_EQ(bus_.read(MODEM_TX_STATE), 9u << 8 | 16u);
}

// A modem that encrypts sends a packet off at 95 bytes: no rest is needed after one of these.
TEST_F(ModemTest, EncryptedPacketsOf95BytesFollowEachOther) {
    power(quick());
    bus_.write(MODEM_NET, 0x3332u << MODEM_NET_PAN_LSB | 1u << MODEM_NET_ENCRYPT_LSB | 0x0C);
    for (int word = 0; word < 4; ++word)
        bus_.write(MODEM_KEY, 0);
    configure();
    takeEvents();
    std::vector<size_t> sizes;
    air_.onPacket([&](uint64_t, const RfPacket& packet, RfChannel::Outcome) {
        sizes.push_back(packet.bytes.size());
    });
    for (unsigned i = 0; i < 10; ++i)
        put(i, frame(95, static_cast<uint8_t>(i)));
    double begin = static_cast<double>(now());
    for (int tenths = 0; tenths < 2000 && (bus_.read(MODEM_TX_STATE) & 0xFF) != 16; ++tenths)
        runMs(0.1);
    EXPECT_LT((static_cast<double>(now()) - begin) / 1e6, 950 * 0.09 + 1)
        << "ms; rests would be 3.6";
    runMs(10);
    EXPECT_EQ(sizes, std::vector<size_t>(10, 100)) << "with the cipher's five bytes";
}

TEST_F(ModemTest, ShortPacketsInARowAreNotJoined) {
    power(quick());
    configure();
    takeEvents();
    std::vector<size_t> sizes;
    air_.onPacket([&](uint64_t, const RfPacket& packet, RfChannel::Outcome) {
        sizes.push_back(packet.bytes.size());
    });
    put(0, frame(40, 1));
    put(1, frame(40, 2));
    runMs(30);
    EXPECT_EQ(sizes, (std::vector<size_t>{40, 40}));
}

TEST_F(ModemTest, PacketsArriveEachInItsBuffer) {
    power(quick());
    configure();
    takeEvents();
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
    power(quick());
    configure();
    takeEvents();
    std::vector<uint8_t> cut = frame(60, 9);
    cut.resize(21);
    plain_.send(cut, now());
    runMs(10);
    EXPECT_EQ(take(), cut);
}

TEST_F(ModemTest, AFullRingDropsWholePacketsAndNothingElse) {
    power(quick());
    configure();
    takeEvents();
    pinsIgnoreRts_ = true; // a modem that takes no notice of RTS
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
    power(quick());
    configure();
    takeEvents();
    for (unsigned i = 0; i < 13; ++i) {
        plain_.send(frame(20, static_cast<uint8_t>(i + 1)), now());
        runMs(10);
    }
    std::vector<uint8_t> both = frame(50, 14), second = frame(50, 15);
    both.insert(both.end(), second.begin(), second.end());
    uint64_t before = near_->counters().bytesToHost;
    auto delivered = [&](uint64_t bytes) {
        bench_.waitFor([&] { return near_->counters().bytesToHost - before >= bytes; },
                       "byte " + std::to_string(bytes), 100'000);
    };
    plain_.send(both, now());
    delivered(50);
    memory_.hold(true); // the fourteenth is complete when the next has begun
    delivered(51);
    memory_.hold(false);
    runMs(50);
    EXPECT_TRUE(bench_.top().modem_rts_n_o);
    for (unsigned i = 0; i < 13; ++i)
        EXPECT_EQ(take(), frame(20, static_cast<uint8_t>(i + 1))) << i;
    EXPECT_FALSE(bench_.top().modem_rts_n_o);
    runMs(10);
    EXPECT_EQ(take(), frame(50, 14));
    EXPECT_EQ(take(), second);
}

TEST_F(ModemTest, AFramingErrorEndsThePacketAndIsCounted) {
    power(quick());
    configure();
    takeEvents();
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
    power(quick());
    configure();
    takeEvents();
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
    power(quick());
    configure();
    takeEvents();
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

// A word that memory gives for a packet that is no longer under way must not become a byte of the
// one that is, even if it comes after the set-up.
class ModemWithdrawnRead : public ModemTest {
protected:
    // CONTROL is written so many clocks after the read of the packet's second word has begun.
    // If `hangs`, memory gives that word only when the packet is awaited (sentAgain).
    void interrupt(unsigned buffer, unsigned clocks, uint32_t control, bool hangs = false) {
        packet_ = ramp(20, static_cast<uint8_t>(16 * buffer));
        uint32_t second = txRing + 128 * buffer + 8;
        plain_.received.clear();
        put(buffer, packet_);
        bench_.waitFor(
            [&] { return bench_.top().npi_addr_req_o && bench_.top().npi_addr_o == second; },
            "the second word");
        memory_.hold(hangs);
        for (unsigned i = 0; i < clocks; ++i)
            bench_.tick();
        bus_.write(MODEM_CONTROL, control);
    }
    void setUp() {
        bench_.waitFor([&] { return bench_.top().irq_o; }, "the end of the set-up", 1'000'000);
        EXPECT_TRUE(takeEvents() & MODEM_EVENT_CONFIGURED_MASK);
    }
    // The bytes that had left, and the packet.
    void sentAgain(const std::string& when) {
        memory_.hold(false);
        runMs(12);
        size_t left = plain_.received.size() - packet_.size();
        ASSERT_TRUE(left == 8 || left == 9) << plain_.received.size() << when;
        std::vector<uint8_t> expected(packet_.begin(), packet_.begin() + static_cast<long>(left));
        expected.insert(expected.end(), packet_.begin(), packet_.end());
        EXPECT_EQ(plain_.received, expected) << when;
        EXPECT_EQ(bus_.read(MODEM_TX_STATE) & MODEM_TX_STATE_FREE_MASK, 16u) << when;
        EXPECT_EQ(takeEvents(), MODEM_EVENT_TX_DONE_MASK) << when;
    }
    std::vector<uint8_t> packet_;
};

TEST_F(ModemWithdrawnRead, ASetUpAtAnyClockOfIt) {
    power(quick());
    configure();
    takeEvents();
    memory_.setStall(0.8);
    for (unsigned clocks = 0; clocks < 10; ++clocks) {
        interrupt(clocks, clocks, MODEM_CONTROL_CONFIGURE_MASK);
        setUp();
        sentAgain(", clock " + std::to_string(clocks) + ", SEED " + std::to_string(testSeed()));
    }
}

TEST_F(ModemWithdrawnRead, ItsWordComesAfterTheSetUp) {
    power(quick());
    configure();
    takeEvents();
    interrupt(0, 0, MODEM_CONTROL_CONFIGURE_MASK, true);
    setUp();
    sentAgain("");
}

TEST_F(ModemWithdrawnRead, ItsWordComesAfterAResetForAnotherPacket) {
    power(quick({{"BD", 7}})); // at once found after the reset
    configure();
    takeEvents();
    interrupt(0, 0, MODEM_CONTROL_RESET_MODEM_MASK, true);
    runMs(60);
    configure();
    takeEvents();
    plain_.received.clear();
    put(0, ramp(30, 100));
    memory_.hold(false);
    runMs(12);
    EXPECT_EQ(plain_.received, ramp(30, 100));
    EXPECT_EQ(bus_.read(MODEM_TX_STATE), 1u << 8 | 16u);
}

// The end of one packet and the beginning of another in the same clock of a ring, and in those
// around it; some rounds, since the baud rate's ticks move against the bus.
class ModemRingsMeet : public ModemTest {
protected:
    static constexpr unsigned rounds = 4;
    void ready() {
        power(quick());
        configure();
        takeEvents();
        memory_.setStall(0);
    }
    void tickUntil(uint64_t cycle) {
        while (bench_.cycles() < cycle)
            bench_.tick();
    }
    Random random_{testSeed()};
};

TEST_F(ModemRingsMeet, APutInTheClockInWhichAPacketHasBeenSent) {
    ready();
    put(0, {1});
    uint64_t begin = bench_.cycles();
    bench_.waitFor([&] { return bench_.top().irq_o; }, "the end of a packet");
    uint64_t lasts = bench_.cycles() - begin;
    takeEvents();
    std::vector<uint8_t> expected = {1};
    for (unsigned i = 0; i < 16 * rounds; ++i) {
        unsigned before = i % 16; // clocks
        std::string when = std::to_string(before) + ", SEED " + std::to_string(testSeed());
        unsigned buffer = expected.size() % 16, after = (buffer + 2) % 16;
        level(true, random_.below(9));
        for (unsigned packet = 0; packet < 2; ++packet) {
            memory_.setByte(txRing + 128 * ((buffer + packet) % 16),
                            static_cast<uint8_t>(expected.size()));
            expected.push_back(static_cast<uint8_t>(expected.size()));
        }
        bus_.write(MODEM_TX_PUT, 1);
        tickUntil(bench_.cycles() + lasts - before);
        bus_.write(MODEM_TX_PUT, 1);
        runMs(0.1); // the first has left
        EXPECT_EQ(bus_.read(MODEM_TX_STATE), after << 8 | 15u) << when;
        runMs(0.5);
        EXPECT_EQ(bus_.read(MODEM_TX_STATE), after << 8 | 16u) << when;
    }
    EXPECT_EQ(takeEvents(), MODEM_EVENT_TX_DONE_MASK);
    runMs(20);
    EXPECT_EQ(plain_.received, expected) << "each once, in turn";
}

TEST_F(ModemRingsMeet, AReleaseInTheClockOfANewPacket) {
    ready();
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

TEST_F(ModemTest, AModemThatIsFullHoldsTheControllerBack) {
    power(quick());
    configure();
    takeEvents();
    air_.weather.delayNs = 200'000'000; // each packet keeps the modem busy
    for (unsigned i = 0; i < 6; ++i)
        put(i, frame(100, static_cast<uint8_t>(i)));
    runMs(1500);
    EXPECT_EQ(near_->counters().overflow, 0u);
    EXPECT_EQ(plain_.received.size(), 600u);
}

// The far modem sends both frames in one RF packet, so they come without a pause.
void sendTogether(HostLine& line, std::vector<uint8_t> first, const std::vector<uint8_t>& second,
                  uint64_t now) {
    first.insert(first.end(), second.begin(), second.end());
    line.send(first, now);
}

TEST_F(ModemTest, AStalledMemoryCostsTheNextPacketNotTheOneBefore) {
    power(quick());
    configure();
    takeEvents();
    uint64_t before = near_->counters().bytesToHost;
    auto delivered = [&](uint64_t bytes) {
        bench_.waitFor([&] { return near_->counters().bytesToHost - before >= bytes; },
                       "byte " + std::to_string(bytes), 100'000);
    };
    sendTogether(plain_, frame(50, 1), frame(50, 2), now());
    delivered(50);
    memory_.hold(true); // the last word of the first packet waits ...
    delivered(50 + 12);
    memory_.hold(false); // ... until the first word of the second is complete
    runMs(10);
    EXPECT_EQ(take(), frame(50, 1));
    EXPECT_TRUE(take().empty());
    EXPECT_EQ(bus_.read(MODEM_ERRORS) >> MODEM_ERRORS_OVERRUN_LSB & 0xFF, 1u);
    plain_.send(frame(50, 3), now());
    runMs(10);
    EXPECT_EQ(take(), frame(50, 3)) << "it goes on";
}

// Fifteen packets fill the ring but for one buffer; one more comes whole, and of the next so many
// bytes while memory is held: that one is dropped, and no other.
class ModemFullRing : public ModemTest {
protected:
    void nextHasBegun(uint64_t bytes) {
        power(quick());
        configure();
        takeEvents();
        pinsIgnoreRts_ = true;
        for (unsigned i = 0; i < 15; ++i) {
            plain_.send(frame(20, static_cast<uint8_t>(i + 1)), now());
            runMs(10);
        }
        uint64_t before = near_->counters().bytesToHost;
        auto delivered = [&](uint64_t count) {
            bench_.waitFor([&] { return near_->counters().bytesToHost - before >= count; },
                           "byte " + std::to_string(count), 100'000);
        };
        sendTogether(plain_, frame(50, 16), frame(50, 99), now());
        delivered(50);
        memory_.hold(true);
        delivered(50 + bytes);
        memory_.hold(false);
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

// Memory takes a packet's last byte in the very clock of what ends it, or a few before or after: in
// time the packet is whole, else it is dropped and counted; never cut.
TEST_F(ModemTest, TheLastByteIsTakenAroundTheClockOfAFramingError) {
    power(quick());
    configure();
    takeEvents();
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
    power(quick());
    configure();
    takeEvents();
    const std::vector<uint8_t> cut = {95, 2, 3, 4};
    bytesIn({cut.begin(), cut.end() - 2}, bitClocks);
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
