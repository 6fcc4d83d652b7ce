// SPDX-License-Identifier: MIT
//
// modem_soak_test: sends noise to the UART of the modem controller: random bytes, gaps, breaks and
// glitches. The memory stalls, and the software takes packets at random times. The output must
// consist of parts of the input, in order, no other memory may change, and the controller must work
// afterwards.
//
//   SOAK_BYTES=10000000 build/main/tests/hdl/test_modem_soak     (default 30000)

#include "../../support/environment.h"
#include "VModem.h"
#include "modem_rig.h"
#include <algorithm>
#include <iostream>

namespace {

class ModemSoak : public ModemRig<VModem, 500> {
protected:
    static constexpr double bitClocks = 2e6 / 111111;
    static uint64_t wanted() {
        return static_cast<uint64_t>(numberFromEnvironment("SOAK_BYTES", 30'000));
    }
    void hold(bool level, double clocks) {
        noise_ = !level; // the modem is silent, so the line is high unless the noise holds it low
        for (clock_ += clocks; static_cast<double>(bench_.cycles()) < clock_;)
            bench_.tick();
    }
    void sendByte(uint8_t byte, bool stop) {
        hold(false, bitClocks);
        for (int bit = 0; bit < 8; ++bit)
            hold(byte >> bit & 1, bitClocks);
        hold(stop, bitClocks);
        if (stop)
            stream_.push_back(byte);
        else
            hold(true, bitClocks * (1 + random_.below(3)));
    }
    void sendNoise() {
        uint32_t what = random_.below(1000);
        if (what < 3)
            hold(false, bitClocks * (12 + random_.below(30))); // a break
        else if (what < 6)
            hold(false, bitClocks * 0.2); // a glitch
        else if (what < 16)
            // a gap, which may be long enough to end a packet
            hold(true, bitClocks * random_.below(60));
        else if (what < 18)
            memory_.hold(true);
        else if (what < 40)
            memory_.hold(false);
        else if (what < 60)
            useSoftware();
        clock_ = std::max(clock_, static_cast<double>(bench_.cycles()));
        if (what < 6)
            hold(true, bitClocks * 2);
        sendByte(static_cast<uint8_t>(random_.next()), random_.below(500) != 0);
    }
    void useSoftware() {
        auto now = oldest();
        if (!seen_.empty()) {
            ASSERT_EQ(now, seen_) << "a packet changed before it was released";
        }
        seen_ = now;
        for (uint32_t n = random_.below(6); n && !seen_.empty(); --n) {
            check(take());
            seen_ = oldest();
        }
    }
    void check(const std::vector<uint8_t>& packet) {
        ++packets_;
        ASSERT_LE(packet.size(), 100u);
        auto from = stream_.begin() + static_cast<std::ptrdiff_t>(checked_);
        auto found = std::search(from, stream_.end(), packet.begin(), packet.end());
        ASSERT_NE(found, stream_.end())
            << "packet " << packets_ << " is not a part of the bytes sent";
        checked_ = static_cast<size_t>(found - stream_.begin()) + packet.size();
        if (checked_ > 100'000) {
            stream_.erase(stream_.begin(), stream_.begin() + static_cast<std::ptrdiff_t>(checked_));
            checked_ = 0;
        }
    }
    Random random_{testSeed() + 77};
    std::vector<uint8_t> stream_, seen_;
    size_t checked_ = 0;
    uint64_t packets_ = 0;
    double clock_ = 0;
};

TEST_F(ModemSoak, NoiseIsReceivedUnchangedOrDroppedInWholePackets) {
    power(quick());
    configure();
    takeEvents();
    pinsIgnoreRts_ = true;
    clock_ = static_cast<double>(bench_.cycles());
    uint64_t bytes = wanted();
    for (uint64_t i = 0; i < bytes && !HasFatalFailure(); ++i) {
        sendNoise();
        if (bytes >= 1'000'000 && i % (bytes / 20) == 0)
            std::cout << 100 * i / bytes << " %, " << packets_ << " packets" << std::endl;
    }
    memory_.hold(false);
    hold(true, 2000);
    while (bus_.read(MODEM_RX_GET) & MODEM_RX_GET_VALID_MASK)
        check(take());
    RecordProperty("packets", static_cast<int>(packets_));
    EXPECT_GT(packets_, bytes / 400) << "SEED " << testSeed();
    for (uint32_t i = 0; i < 4096; ++i) {
        ASSERT_EQ(memory_.byte(rxRing - 1 - i), 0) << "the controller wrote below the ring";
        ASSERT_EQ(memory_.byte(rxRing + 2048 + i), 0) << "the controller wrote above the ring";
    }
    std::cout << "modem controller: " << bytes << " bytes of noise into its UART, " << packets_
              << " packets received, each a part of the bytes sent" << std::endl;
    noise_ = false;
    plain_.send(frame(50, 9), now());
    runMs(10);
    EXPECT_EQ(take(), frame(50, 9)) << "a packet after the faults must arrive";
}

} // namespace
