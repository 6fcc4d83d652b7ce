// SPDX-License-Identifier: MIT
//
// follower: one more vehicle in the air of a flight: a chip of its own, with the firmware's ARM
// binary. It follows the first vehicle, which runs the air: pins would move too early otherwise.

#pragma once

#include "m3_machine.h"

class Follower {
public:
    Follower(RfChannel& air, const XBee::Options& modem, const M3Machine::Config& config)
        : soc(air, modem), machine_(soc, config, [] { return true; }) {
        soc.onAir([](uint64_t) {});
        soc.onTime([this](uint64_t now) { return std::max(until_, now + 1); });
        soc.reset(true);
    }
    // Runs up to this time. The air has brought nothing later than the last call.
    void advance(uint64_t now) {
        until_ = now;
        machine_.advance(now);
    }
    SocModel soc;

private:
    M3Machine machine_;
    uint64_t until_ = 0;
};
