// SPDX-License-Identifier: MIT
//
// vehicles: more vehicles and a second ground in the air of a flight, and what befalls them.

#pragma once

#include "ground_step.h"
#include "key_file.h"
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

// A ground in the air of a flight: a modem on a pty, or on the recording of the flight that is
// flown again, with a clock and a recording of its own. Simulated time waits for its program.
struct Station {
    static constexpr uint32_t second = 0x00F0; // address of a second one's modem

    // `out`: folder of its files; `number`: behind their names; `head`: first line of the
    // recording.
    Station(RfChannel& air, const XBee::Options& options, const std::string& out,
            const std::string& number, std::shared_ptr<ReplayedLine> from,
            const nlohmann::json& head, std::function<bool()> goOn)
        : status(out + "/status" + number), replayed(std::move(from)),
          recorded(replayed ? nullptr
                            : std::make_unique<RecordedLine>(
                                  pty, out + "/flight" + number + ".jsonl", head)),
          modem(line(), air, options), step(*status, pty, std::move(goOn)) {}
    SerialLine& line() { return replayed ? static_cast<SerialLine&>(*replayed) : *recorded; }
    // Returns the time of its next call. A cable may be in the modem's place.
    uint64_t advance(uint64_t now, bool isWired = false) {
        if (!isWired)
            modem.advance(now);
        status.set(now); // its program's clock
        step.wait(now);
        return std::min(isWired ? never : modem.nextEvent(), std::max(step.nextEvent(), now + 1));
    }

    StatusFile status;
    PtyLine pty;
    const std::shared_ptr<ReplayedLine> replayed;
    const std::unique_ptr<RecordedLine> recorded; // none in a replay
    XBee modem;
    GroundStep step;
};

// Returns a vehicle's key in a file, if any; with a next key on its way, the old one.
inline std::vector<uint8_t> keyOf(const std::string& file, int address) {
    if (file.empty())
        return {};
    const XBeeAT::LinkKey key = XBeeAT::KeyFile(file).of(address).back();
    return {key.begin(), key.end()};
}

// Gives a vehicle its keys, from the ground's file and from the observer's: a second ground where
// there are several vehicles; of four and more the first two each other.
inline void giveKeys(M3Machine::Config& config, unsigned vehicles, const std::string& file,
                     const std::string& observer) {
    config.key = keyOf(file, static_cast<int>(config.address));
    try {
        if (auto key = keyOf(file, XBeeAT::everybody); !key.empty())
            config.peers.push_back({UAV_GROUP, UAV_EVERYBODY, key});
    } catch (const std::exception&) { // the file has no line for it
    }
    if (vehicles > 1)
        config.peers.push_back(
            {UAV_OBSERVER, Station::second, keyOf(observer, static_cast<int>(config.address))});
    if (vehicles > 3 && config.address < 3)
        config.peers.push_back({UAV_VEHICLE, 3 - config.address, keyOf(observer, 1)});
}

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
