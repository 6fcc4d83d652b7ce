// SPDX-License-Identifier: MIT
//
// air_test: tests the properties of the air: that it is half duplex, the processing time of the
// modems, retries by RR, fading, interference and recorded traces. Sources of the figures:
// docs/simulation.md.

#include "two_modems.h"
#include <cstdio>
#include <fstream>
#include <unistd.h>

namespace {

class TrueAir : public TwoModems {
protected:
    TrueAir() { perfect = false; }
    // Keeps the input buffer of a modem as full as CTS allows.
    static void fill(HostLine& line, uint64_t now) {
        if (line.cts())
            line.send(Bytes(10, 'x'), now);
    }
    // Returns the number of bits per second that arrive at both hosts together, while `a` sends
    // without a pause and, if `both` is true, `b` does too.
    double throughput(bool both) {
        const uint64_t begin = now, seconds = 4;
        lineA.received.clear();
        lineB.received.clear();
        while (now - begin < seconds * 1000 * ms) {
            fill(lineA, now);
            if (both)
                fill(lineB, now);
            run(ms / 2);
        }
        double bytes = static_cast<double>(lineA.received.size() + lineB.received.size());
        return 8 * bytes / seconds;
    }
};
using Retries = TrueAir;

TEST_F(TrueAir, ThroughputIs80KilobitsPerSecondAnd47WithEncryption) {
    power({{"BD", 7}}, {{"BD", 7}});
    EXPECT_NEAR(throughput(false), 80e3, 2e3);
    power({{"BD", 7}, {"EE", 1}}, {{"BD", 7}, {"EE", 1}});
    EXPECT_NEAR(throughput(false), 47e3, 1e3);
}

TEST_F(TrueAir, BothDirectionsShareTheRateOfOne) {
    power({{"BD", 7}, {"RN", 3}}, {{"BD", 7}, {"RN", 3}});
    double both = throughput(true);
    EXPECT_LT(both, 85e3) << "the air must not be full duplex, which would give twice 80 kb/s";
    EXPECT_GT(both, 65e3);
    double heardA = static_cast<double>(lineA.received.size());
    EXPECT_NEAR(heardA / static_cast<double>(lineB.received.size()), 1, 0.15);
}

TEST_F(TrueAir, RNSeparatesModemsThatSendSimultaneously) {
    for (uint32_t rn : {0u, 3u}) {
        power({{"BD", 7}, {"RN", rn}}, {{"BD", 7}, {"RN", rn}});
        uint64_t lost = air.counters().lost;
        for (int i = 0; i < 100; ++i) {
            send(std::string(100, 'x'));
            lineB.send(Bytes(100, 'y'), now);
            run(40 * ms);
        }
        lost = air.counters().lost - lost;
        EXPECT_TRUE(rn ? lost <= 2 : lost >= 80) << "RN " << rn << ": " << lost << " of 200";
    }
}

TEST_F(TrueAir, AnEncryptedFrameHasTheAddressOfItsSenderAndFiveMoreBytes) {
    perfect = true;
    power({{"EE", 1}, {"RO", 0}}, {{"EE", 1}});
    uint64_t begin = now;
    send("x", 10 * ms);
    EXPECT_EQ(packets[0].time - begin, RfChannel::airTimeNs(1 + 5 + 6) - afterFrame);
}

TEST_F(Retries, WithRRTriesRepeatAfter200To248Milliseconds) {
    power({{"RR", 1}, {"RO", 0}});
    air.weather.tryLoss = 1;
    auto tries = [this] { return air.counters().airNs / RfChannel::airTimeNs(1); };
    send("x");
    run(200 * ms); // the first four tries take 13 ms of this time
    EXPECT_EQ(tries(), 4u);
    run(100 * ms);
    EXPECT_EQ(tries(), 8u);
}

TEST_F(Retries, ABroadcastIsSentRRPlusTwoTimesAndArrivesOnce) {
    for (uint32_t rr : {0u, 2u})
        for (double loss : {1, 0}) { // not acknowledged
            power({{"DL", 0xFFFF}, {"RR", rr}, {"RO", 0}});
            air.weather.tryLoss = loss;
            uint64_t before = air.counters().airNs;
            EXPECT_EQ(across("x", 100 * ms), loss ? "" : "x");
            EXPECT_EQ((air.counters().airNs - before) / (RfChannel::airTimeNs(1) - 544'000),
                      rr ? rr + 2 : 1);
        }
}

TEST_F(Retries, WithRRAFailureHasASeparateStatus) {
    for (uint32_t rr : {0u, 1u}) {
        power({{"AP", 1}, {"RR", rr}});
        air.weather.tryLoss = 1;
        lineA.send({0x7E, 0x00, 0x06, 0x01, 0x01, 0x00, 0x02, 0x00, 'x', 0x83}, now);
        run(500 * ms);
        std::string status = heard();
        ASSERT_EQ(status.size(), 7u);
        EXPECT_EQ(static_cast<uint8_t>(status[5]), rr ? 0x21 : 0x01);
    }
}

TEST_F(TrueAir, PacketsFromA64BitAddressUseFrameType80) {
    power({{"MY", 0xFFFE}, {"RO", 0}}, {{"AP", 1}});
    send("x", 50 * ms);
    std::string frame = heardB();
    ASSERT_EQ(frame.size(), 16u);
    EXPECT_EQ(static_cast<uint8_t>(frame[3]), 0x80);
    EXPECT_EQ(frame.substr(4, 8), std::string("\x00\x13\xA2\x00\x00\x00\x00\x0A", 8));
    EXPECT_EQ(static_cast<uint8_t>(frame[12]), 40) << "-dBm";
}

// Simulates a microwave oven, which is on for half of every 20 ms.
TEST_F(TrueAir, PacketsDuringInterferenceAreLost) {
    power({{"BD", 7}, {"RN", 2}}, {{"BD", 7}});
    double without = throughput(false);
    air.weather.interference = 0.5;
    double with = throughput(false);
    EXPECT_LT(with, 0.8 * without);
    EXPECT_GT(with, 0.2 * without);
}

TEST_F(TrueAir, SignalStrengthFallsWithDistanceAndFades) {
    power({{"RO", 0}});
    // loss of 80 dB, which is 12 dB above the sensitivity of the receiver
    air.weather.distance = 100;
    for (int i = 0; i < 200; ++i) {
        send("x", 50 * ms);
    }
    double missed = static_cast<double>(air.counters().retries) /
                    (200.0 + static_cast<double>(air.counters().retries));
    EXPECT_NEAR(missed, 0.06, 0.04) << "Rayleigh: 1 - exp(-10^-1.2)";
    air.weather.distance = 10000;
    send("y", 50 * ms);
    EXPECT_EQ(heardB().find('y'), std::string::npos);
}

class Traces : public TrueAir {
protected:
    ~Traces() override { std::remove(path_.c_str()); }
    std::string write(const std::string& text) {
        std::ofstream(path_) << text;
        return path_;
    }
    std::string fault(const std::string& text) {
        try {
            RfTrace trace(write(text));
        } catch (const std::runtime_error& error) {
            std::string what = error.what();
            return what.substr(what.find(".csv") + 4);
        }
        return "";
    }

private:
    // The name contains the process id, because several of these tests may run at the same time.
    const std::string path_ = ::testing::TempDir() + "trace." + std::to_string(getpid()) + ".csv";
};

TEST_F(Traces, AreFollowedRowByRow) {
    power({{"RO", 0}});
    uint64_t second = 1000 * ms;
    air.weather.trace = std::make_shared<RfTrace>(
        write("time_s,loss,rssi_dbm,delay_ms\n0,0,-50,0\n1,1,-90,0\n2,0,-70,30\n"));
    now = second / 2;
    EXPECT_EQ(across("a", 50 * ms), "a");
    EXPECT_EQ(b->parameter("DB"), 50u);
    run(second);
    EXPECT_EQ(across("b", 50 * ms), "");
    run(second);
    EXPECT_EQ(across("c", 30 * ms), "") << "delayed";
    run(30 * ms);
    EXPECT_EQ(heardB(), "c");
    EXPECT_EQ(b->parameter("DB"), 70u);
}

TEST_F(Traces, WrongTracesAreRefusedWithTheLine) {
    const std::string head = "time_s,loss,rssi_dbm,delay_ms\n";
    EXPECT_EQ(fault("time,loss\n"), ":1: expected the heading 'time_s,loss,rssi_dbm,delay_ms'");
    EXPECT_EQ(fault(head + "0,0,-50\n"), ":2: expected four numbers");
    EXPECT_EQ(fault(head + "0,2,-50,0\n"),
              ":2: expected time and delay of at least 0, and a loss of 0 to 1");
    EXPECT_EQ(fault(head + "1,0,-50,0\n1,0,-50,0\n"),
              ":3: expected a later time than in the row before");
    EXPECT_EQ(fault(head), ":2: expected at least one row");
}

} // namespace
