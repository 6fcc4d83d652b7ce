// SPDX-License-Identifier: MIT
//
// trouble: what befalls several vehicles of a flight: `away:2:1.5:3` takes the modem with the
// address 2 out of reach, 1.5 s after the beginning, for 3 s; `twin:2:...` brings one more vehicle
// into reach, with this address and another key; `babble:2:...` a modem that sends noise to this
// address as fast as it can.

#pragma once

#include "random.h"
#include "rf_channel.h"
#include <cstdlib>
#include <sstream>

class Trouble {
public:
    explicit Trouble(const std::string& text) {
        std::istringstream in(text);
        std::string whom, from, seconds;
        std::getline(in, kind, ':');
        std::getline(in, whom, ':');
        std::getline(in, from, ':');
        std::getline(in, seconds);
        address = std::strtoul(whom.c_str(), nullptr, 0);
        from_ = static_cast<uint64_t>(std::atof(from.c_str()) * 1e9);
        until_ = from_ + static_cast<uint64_t>(std::atof(seconds.c_str()) * 1e9);
    }
    // `modem`: the one with the address, or the twin's; none where somebody babbles.
    void begin(RfChannel& air, const XBee* modem) {
        air_ = &air;
        modem_ = modem;
        XBee::Options options;
        options.set = {{"MY", 0x0BAB}, {"DL", static_cast<uint32_t>(address)}, {"BD", 7}};
        babbler_ = std::make_unique<XBee>(line_, air, options);
    }
    // Returns the time of its next call.
    uint64_t advance(uint64_t now) {
        const bool isOn = now >= from_ && now < until_;
        if (modem_)
            air_->carryAway(modem_, isOn == (kind == "away"));
        else if (isOn && now >= nextWords_) {
            line_.send(random_.items<uint8_t>(90), now);
            nextWords_ = now + wordsNs;
        }
        babbler_->advance(now);
        const uint64_t then = now < from_ ? from_ : isOn ? until_ : never;
        return std::min({then, babbler_->nextEvent(), isOn && !modem_ ? nextWords_ : never});
    }
    std::string kind;
    unsigned long address;

private:
    static constexpr uint64_t wordsNs = 20'000'000;

    RfChannel* air_ = nullptr;
    const XBee* modem_ = nullptr;
    uint64_t from_, until_, nextWords_ = 0;
    HostLine line_;
    std::unique_ptr<XBee> babbler_;
    Random random_{1};
};
