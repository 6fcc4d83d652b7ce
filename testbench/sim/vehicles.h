// SPDX-License-Identifier: MIT
//
// vehicles: more vehicles and a second ground in the air of a flight, and what befalls them.

#pragma once

#include "ground_step.h"
#include "m3_machine.h"
#include "random.h"
#include "recording.h"
#include "rf_channel.h"
#include "xbee.h"
#include <cstdlib>
#include <sstream>

// One more vehicle in the air of a flight: a chip of its own, with the firmware's ARM
// binary. It follows the first vehicle, which runs the air: pins would move too early otherwise.
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

// One more ground in the air of a flight: a modem on a pty of its own, with a clock
// and a recording of its own, for which simulated time waits as for the first one.
class SecondGround {
public:
    static constexpr uint32_t address = 0x00F0; // of its modem

    // `out`: folder of its files; `replayed`: folder of the flight that is flown again, or none.
    SecondGround(RfChannel& air, const XBee::Options& modem, const std::string& out,
                 const std::string& replayed, std::function<bool()> goOn)
        : status_(out + "/status2"), replayed_(replayed.empty() ? nullptr : open(replayed)),
          recorded_(replayed_ ? nullptr
                              : std::make_unique<RecordedLine>(
                                    pty_, out + "/" + recording,
                                    nlohmann::json{{"flight", nlohmann::json::object()}})),
          modem_(replayed_ ? static_cast<SerialLine&>(*replayed_) : *recorded_, air, modem),
          step_(*status_, pty_, std::move(goOn)) {}
    const std::string& device() const { return pty_.path(); }
    // Returns the time of its next call.
    uint64_t advance(uint64_t now) {
        modem_.advance(now);
        status_.set(now);
        step_.wait(now);
        return std::min(modem_.nextEvent(), std::max(step_.nextEvent(), now + 1));
    }

private:
    static constexpr const char* recording = "flight2.jsonl";
    static std::unique_ptr<ReplayedLine> open(const std::string& folder) {
        return std::make_unique<ReplayedLine>(folder + "/" + recording);
    }

    StatusFile status_;
    PtyLine pty_;
    std::unique_ptr<ReplayedLine> replayed_;
    std::unique_ptr<RecordedLine> recorded_;
    XBee modem_;
    GroundStep step_;
};

// Trouble takes effect by a text: `away:2:1.5:3` takes the modem with the
// address 2 out of reach, 1.5 s after the beginning, for 3 s; `twin:2:...` brings one more vehicle
// into reach, with this address and another key; `babble:2:...` a modem that sends noise to this
// address as fast as it can.
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
