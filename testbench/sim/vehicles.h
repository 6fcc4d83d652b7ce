// SPDX-License-Identifier: MIT
//
// vehicles: further vehicles and a second ground station in a flight, and fault injection for them.

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

// One more vehicle in the air of a flight: a separate chip, with the firmware's ARM binary. It
// follows the first vehicle, which runs the air: otherwise pins would move too early.
class Follower {
public:
    Follower(RfChannel& air, const XBee::Options& modem, const M3Machine::Config& config)
        : soc(air, modem), machine_(soc, config, [] { return true; }) {
        soc.onAir([](uint64_t) {});
        soc.onTime([this](uint64_t now) { return std::max(until_, now + 1); });
        soc.reset(true);
    }
    // Runs up to this time. The air has delivered nothing later than the last call.
    void advance(uint64_t now) {
        until_ = now;
        machine_.advance(now);
    }
    SocModel soc;

private:
    M3Machine machine_;
    uint64_t until_ = 0;
};

// A ground station in the air of a flight: a modem on a pty, or on the recording of a replayed
// flight, with a separate clock and recording. Simulated time waits for its program.
struct Station {
    static constexpr uint32_t second = 0x00F0; // address of a second one's modem

    // `out`: folder of its files; `number`: appended to their names; `head`: first line of the
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
    // Returns the time of its next call. A cable may replace the modem.
    uint64_t advance(uint64_t now, bool isWired = false) {
        if (!isWired)
            modem.advance(now);
        status.set(now); // clock of its program
        step.wait(now);
        return std::min(isWired ? never : modem.nextEvent(), std::max(step.nextEvent(), now + 1));
    }

    StatusFile status;
    PtyLine pty;
    const std::shared_ptr<ReplayedLine> replayed;
    const std::unique_ptr<RecordedLine> recorded; // empty in a replay
    XBee modem;
    GroundStep step;
};

// Returns a vehicle's key from a file, if any; the old one while a next key is pending.
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
    // `modem`: the modem with this address, or the twin's; null for babble.
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
