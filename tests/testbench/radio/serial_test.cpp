// SPDX-License-Identifier: MIT
//
// serial_test: tests the serial side of the modem: baud rate and its tolerance, packetizing,
// buffers, flow control, reset.

#include "two_modems.h"

namespace {

using Packetizing = TwoModems;
using Buffers = TwoModems;
using Reset = TwoModems;

TEST_F(Packetizing, APacketIsSentAfterTheSilenceROOrAt100Bytes) {
    const struct {
        Settings set;
        size_t bytes;
        uint64_t ns, sent;
    } cases[] = {{{}, 3, 3 * charNs() - 1000, 0}, // RO 3 at 9600 baud is 3.125 ms
                 {{}, 3, 3 * charNs() + 1000, 1},
                 {{{"RO", 0}}, 1, 0, 1},
                 {{{"RO", 0xFF}}, 99, 0, 0},
                 {{{"RO", 0xFF}}, 100, 0, 1}};
    for (const auto& c : cases) {
        power(c.set);
        send(std::string(c.bytes, 'x'), c.ns);
        EXPECT_EQ(a->counters().packetsSent, c.sent) << c.bytes << " bytes, " << c.ns << " ns";
    }
}

TEST_F(Packetizing, OnlyAPauseLongerThanROSplitsAPacket) {
    for (uint64_t characters : {2, 4}) {
        packets.clear();
        power();
        send("abc", characters * charNs());
        send("def", 30 * ms);
        ASSERT_EQ(packets.size(), characters / 2);
        EXPECT_EQ(text(packets[0].bytes), characters == 2 ? "abcdef" : "abc");
    }
}

TEST_F(Packetizing, EncryptedPacketsHoldNinetyFiveBytes) {
    power({{"EE", 1}, {"RO", 0xFF}}, {{"EE", 1}});
    send(std::string(100, 'x'), 400 * ms);
    ASSERT_EQ(packets.size(), 2u);
    EXPECT_EQ(packets[0].bytes.size(), 5 + 95u)
        << "a packet on the air has five additional bytes of the cipher";
    EXPECT_EQ(packets[1].bytes.size(), 5 + 5u);
}

TEST_F(Buffers, OnePacketIsInFlightAtATime) {
    power();
    send(std::string(200, 'x'));
    EXPECT_EQ(a->counters().packetsSent, 1u);
    run(RfChannel::airTimeNs(100) + 1000);
    EXPECT_EQ(a->counters().packetsSent, 2u);
}

TEST_F(Buffers, CTSIsDeassertedAt17FreeBytesAndAssertedAt34) {
    power({{"BD", 7}});
    air.weather.delayNs = 100 * ms;
    send(std::string(100, 'x')); // these bytes are on the air, so the buffer is empty
    send(std::string(184, 'y')); // 18 bytes of the buffer are free now
    EXPECT_TRUE(lineA.cts());
    send("y");
    EXPECT_FALSE(lineA.cts());
    // The first packet has arrived. The next 100 bytes have left the buffer, so 85 bytes remain in
    // it.
    run(110 * ms);
    EXPECT_TRUE(lineA.cts());

    // The other limit: CTS is off with 169 bytes in the buffer (33 bytes free), and on with 168
    // bytes (34 bytes free).
    power({{"BD", 7}, {"EE", 1}});
    air.weather.delayNs = 100 * ms;
    send(std::string(95, 'x'));
    send(std::string(202, 'y'));
    EXPECT_FALSE(lineA.cts());
    run(106 * ms);
    EXPECT_TRUE(lineA.cts()) << "one packet of 95 bytes was sent, so the buffer holds 107 bytes";
}

TEST_F(Buffers, TheInputBufferHolds202BytesAndCountsLostBytes) {
    power();
    air.weather.delayNs = 50 * ms;
    send(std::string(100, 'x'));
    send(std::string(202, 'y'));
    EXPECT_EQ(a->counters().overflow, 0u);
    send("z");
    EXPECT_EQ(a->counters().overflow, 1u);
    run(400 * ms);
    EXPECT_EQ(heardB(), std::string(100, 'x') + std::string(202, 'y'));
}

TEST_F(Buffers, CTSStaysAssertedWithoutD7) {
    power({{"D7", 0}});
    air.weather.delayNs = 50 * ms;
    send(std::string(300, 'x'));
    EXPECT_TRUE(lineA.cts());
}

TEST_F(Buffers, AFullOutputBufferLosesAcknowledgedBytes) {
    power();
    lineB.paused = true;
    send(std::string(100, 'x'), 120 * ms);
    send(std::string(100, 'y'), 120 * ms);
    send(std::string(100, 'z'), 200 * ms);
    EXPECT_EQ(b->counters().packetsDropped, 1u);
    EXPECT_EQ(packets.back().outcome, RfChannel::Outcome::NoRoom);
    EXPECT_EQ(a->parameter("EA"), 0u);
    lineB.paused = false;
    run(ms);
    EXPECT_EQ(heardB(), std::string(100, 'x') + std::string(100, 'y'));
}

// Tests with a host UART that is simulated bit by bit, so that its rate may differ from the
// modem's.
class Wire : public ::testing::Test {
protected:
    void connect(std::map<std::string, uint32_t> settings) {
        XBee::Options options;
        options.set = std::move(settings);
        modem_ = std::make_unique<XBee>(pins_, air_, options);
        air_.onPacket([&](uint64_t, const RfPacket& p, RfChannel::Outcome) {
            sent_.assign(p.bytes.begin(), p.bytes.end());
        });
        step(now_ + 3'000'000);
    }
    void step(uint64_t until) {
        for (; now_ < until; now_ += 200) {
            air_.advance(now_);
            if (!crowd_.bytes.empty())
                modem_->receive(crowd_, now_);
            modem_->advance(now_);
            watch();
        }
    }
    void send(const std::string& text, double baud) {
        double at = static_cast<double>(now_);
        for (char c : text)
            for (int bit = 0; bit < 10; ++bit) {
                bool level = bit == 0 ? false : bit == 9 ? true : (c >> (bit - 1) & 1);
                step(static_cast<uint64_t>(at));
                pins_.setTxd(level, now_);
                at += 1e9 / baud;
            }
        step(static_cast<uint64_t>(at));
    }
    void watch() {
        if (pins_.rxd() != level_) {
            level_ = pins_.rxd();
            edges_.push_back(now_);
        }
    }
    uint64_t now_ = 0;
    RfChannel air_{testSeed()};
    UartPins pins_;
    std::unique_ptr<XBee> modem_;
    bool level_ = true;
    std::vector<uint64_t> edges_;
    std::string sent_; // the packet that was sent last
    RfPacket crowd_;   // packet that another modem sends continuously; none is sent if it is empty
};

class BaudTolerance : public Wire, public ::testing::WithParamInterface<double> {};

TEST_P(BaudTolerance, BytesAreReceivedWithin4PercentOfTheRate) {
    connect({{"BD", 7}});
    std::string text = "U\x01\xFF\x80 tolerance \x7F";
    send(text, modem_->baud() * (1 + GetParam()));
    step(now_ + 20'000'000);
    EXPECT_EQ(modem_->counters().framingErrors, 0u);
    EXPECT_EQ(sent_, text);
}
INSTANTIATE_TEST_SUITE_P(Rates, BaudTolerance, ::testing::Values(-0.04, -0.02, 0.0, 0.02, 0.04));

TEST_F(Wire, ADeviationOfSevenPercentIsTooLarge) {
    connect({{"BD", 7}});
    send(std::string(50, '\x0F'), modem_->baud() * 0.93);
    step(now_ + 20'000'000);
    EXPECT_GT(modem_->counters().framingErrors, 0u);
}

TEST_F(Wire, RepliesUseTheCurrentRateAndBDTakesEffectAfterTheOK) {
    connect({{"BD", 6}, {"GT", 2}});
    send("+++", 57600);
    step(now_ + 3'000'000);
    ASSERT_TRUE(modem_->inCommandMode());
    step(now_ + 2'000'000);
    send("ATBD7\rATCN\r", 57600); // both "OK" answers are sent at the old rate
    step(now_ + 3'000'000);
    EXPECT_NEAR(modem_->baud(), 111111, 1);
    // 'K' and 'O' contain edges that are one bit apart, so the shortest distance of two edges is
    // the time of one bit.
    uint64_t shortest = ~uint64_t(0);
    for (size_t i = 1; i < edges_.size(); ++i)
        shortest = std::min(shortest, edges_[i] - edges_[i - 1]);
    EXPECT_NEAR(static_cast<double>(shortest), 1e9 / 57600, 500);
    send("data", 111111);
    step(now_ + 20'000'000);
    EXPECT_EQ(sent_, "data") << "the new rate must still be set";
}

TEST_F(Wire, BDTakesEffectAfterTheOKUnderLoad) {
    connect({{"BD", 3}, {"GT", 2}});
    crowd_.header = true;
    crowd_.bytes.assign(20, 'U'); // 'U' has an edge after each bit
    step(now_ + 1'000'000);
    send("+++", 9600);
    step(now_ + 5'000'000);
    ASSERT_TRUE(modem_->inCommandMode());
    send("ATBD7\rATCN\r", 9600);
    step(now_ + 250'000'000); // the modem needs 210 ms to send a full buffer
    edges_.clear();
    step(now_ + 2'000'000);
    ASSERT_GT(edges_.size(), 2u);
    EXPECT_NEAR(static_cast<double>(edges_[1] - edges_[0]), 9000, 500);
}

TEST_F(Wire, OnlyWithD6TheModemWaitsForRTS) {
    for (uint32_t d6 : {0u, 1u}) {
        connect({{"BD", 7}, {"GT", 2}, {"D6", d6}});
        edges_.clear();
        pins_.setRts(false, now_);
        send("+++", 111111);
        step(now_ + 5'000'000);
        EXPECT_TRUE(modem_->inCommandMode());
        EXPECT_EQ(edges_.empty(), d6 == 1);
        pins_.setRts(true, now_);
        step(now_ + 5'000'000);
        EXPECT_FALSE(edges_.empty());
    }
}

TEST_F(Reset, APulseOf200NsResets) {
    power();
    enter();
    command("ATMY66");
    command("ATCN");
    a->resetPin(true, now);
    a->resetPin(false, now + 199);
    EXPECT_EQ(a->parameter("MY"), 0x66u) << "a pulse that is too short must not reset the modem";
    now += 1000;
    a->resetPin(true, now);
    a->resetPin(false, now + 200);
    EXPECT_EQ(a->parameter("MY"), 1u);
}

TEST_F(Reset, BootTimeIsAParameter) {
    power();
    for (uint64_t boot : {50 * ms, 500 * ms}) {
        XBee::Options options;
        options.bootNs = boot;
        options.set = {{"MY", 1}, {"DL", 2}};
        a.reset();
        a = std::make_unique<XBee>(lineA, air, options);
        run(ms);
        a->resetPin(true, now);
        run(1000);
        a->resetPin(false, now);
        run(boot - ms);
        send("x");
        EXPECT_EQ(a->counters().bytesFromHost, 0u);
        run(2 * ms);
        send("x");
        EXPECT_EQ(a->counters().bytesFromHost, 1u);
    }
}

} // namespace
