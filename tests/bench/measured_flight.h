// SPDX-License-Identifier: MIT
//
// measured_flight: the vehicle's ARM binary in the air with its ground station, and the cycles that
// its processor takes.

#ifndef MEASURED_FLIGHT_H
#define MEASURED_FLIGHT_H

#include "ground.h"
#include "m3_machine.h"
#include <cstring>

extern "C" {
#include "uav.h"
}

constexpr double hclk = 120e6; // the board's

// The vehicle with its ground station, in the air.
class MeasuredFlight {
public:
    // `scaled` 1: the board's ratio of clocks; 50: the processor's time in the radio's. `key`: the
    // link's, if any.
    MeasuredFlight(const std::string& elf, double scaled, const std::vector<uint8_t>& key = {})
        : warp(scaled),
          machine(soc,
                  {elf, scaled > 1 ? static_cast<uint32_t>(hclk) : 0, Ground::guardMs, {}, key},
                  [this] { return poll(); }) {
        ground.key = key;
        ground.start();
        soc.onTime([this](uint64_t now) { return ground.advance(now); });
        soc.reset();
        const uint32_t size[2] = {48, 32};
        std::memcpy(soc.memory().data() + UAV_FRAME_HEADER, size, sizeof size);
        until([this] { return ground.validated; }, 25, "the connection");
    }
    // Runs until `done`, asked each simulated millisecond; fails after `seconds`.
    void until(std::function<bool()> done, double seconds, const char* what) {
        done_ = std::move(done);
        uint64_t end = soc.now() + static_cast<uint64_t>(seconds * 1e9);
        late_ = false;
        end_ = end;
        machine.run();
        if (late_)
            throw std::runtime_error(std::string(what) + " has not happened within " +
                                     std::to_string(seconds) + " simulated seconds");
    }
    void wait(double seconds) {
        uint64_t end = soc.now() + static_cast<uint64_t>(seconds * 1e9);
        until([this, end] { return soc.now() >= end; }, seconds + 1, "waiting");
    }
    // Makes this many calls, each after the answer of the one before: `call` gets their numbers,
    // from 1 on.
    void inTurn(int count, double seconds, const std::function<void(int number)>& call) {
        ground.replies.clear();
        int sent = 0;
        until(
            [&] {
                const int answered = static_cast<int>(ground.replies.size());
                if (answered == sent && sent < count)
                    call(++sent);
                return answered == count;
            },
            seconds, "the calls");
    }
    // Cycles on the board: while the processor was awake, and of these while it waited for the
    // FSMC.
    double awake() { return own() + waiting(); }
    double waiting() { return static_cast<double>(cpu().busCycles()) / warp; }
    double own() {
        return static_cast<double>(cpu().cycles()) - static_cast<double>(cpu().sleepingCycles()) -
               static_cast<double>(cpu().busCycles());
    }
    CortexM3& cpu() { return machine.cpu(); }
    double seconds() const { return static_cast<double>(soc.now()) / 1e9; }

    double warp;
    RfChannel air{1};
    Ground ground{air, 6};
    SocModel soc{air, Ground::uavModem()};
    M3Machine machine;

private:
    bool poll() {
        late_ = soc.now() > end_;
        return !late_ && !done_();
    }
    std::function<bool()> done_;
    uint64_t end_ = 0;
    bool late_ = false;
};

#endif
