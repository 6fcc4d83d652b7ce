// SPDX-License-Identifier: MIT
//
// vehicles: additional vehicles and a second ground station in a flight, and the faults that need
// several vehicles.

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

// An additional vehicle in a flight: a separate chip that runs the firmware's ARM binary. It must
// be advanced after the first vehicle, because the first vehicle also advances the air; otherwise
// the pins of this vehicle would change too early.
class Follower {
public:
    Follower(RfChannel& air, const XBee::Options& modem, const M3Machine::Config& config)
        : soc(air, modem), machine_(soc, config, [] { return true; }) {
        soc.onAir([](uint64_t) {});
        soc.onTime([this](uint64_t now) { return std::max(until_, now + 1); });
        soc.reset(true);
    }
    // Runs up to this time. Since the last call, the air must not have delivered a packet to this
    // vehicle.
    void advance(uint64_t now) {
        until_ = now;
        machine_.advance(now);
    }
    SocModel soc;

private:
    M3Machine machine_;
    uint64_t until_ = 0;
};

// A ground station in a flight: a modem on a pty (in a replay: on the recording), with a separate
// clock and a separate recording. Simulated time waits for the station's program.
struct Station {
    static constexpr uint32_t second = 0x00F0; // modem address of a second ground station

    // `out` is the folder for station files; `number` is appended to their names; `head` is
    // the first line of the recording.
    Station(RfChannel& air, const XBee::Options& options, const std::string& out,
            const std::string& number, std::shared_ptr<ReplayedLine> from,
            const nlohmann::json& head, std::function<bool()> goOn)
        : status(out + "/status" + number), replayed(std::move(from)),
          recorded(replayed ? nullptr
                            : std::make_unique<RecordedLine>(
                                  pty, out + "/flight" + number + ".jsonl", head)),
          modem(line(), air, options), step(*status, pty, std::move(goOn)) {}
    SerialLine& line() { return replayed ? static_cast<SerialLine&>(*replayed) : *recorded; }
    // Advances the station. Returns the time at which this function must be called next. If
    // `isWired` is true, a cable replaces the modem.
    uint64_t advance(uint64_t now, bool isWired = false) {
        if (!isWired)
            modem.advance(now);
        status.set(now); // updates the clock that the station's program reads
        step.wait(now);
        return std::min(isWired ? never : modem.nextEvent(), std::max(step.nextEvent(), now + 1));
    }

    StatusFile status;
    PtyLine pty;
    const std::shared_ptr<ReplayedLine> replayed;
    const std::unique_ptr<RecordedLine> recorded; // null in a replay
    XBee modem;
    GroundStep step;
};

// Returns a vehicle's key from a file; returns an empty key if no file is given. While a key change
// is pending, returns the old key.
inline std::vector<uint8_t> keyOf(const std::string& file, int address) {
    if (file.empty())
        return {};
    const XBeeAT::LinkKey key = XBeeAT::KeyFile(file).of(address).back();
    return {key.begin(), key.end()};
}

// Gives a vehicle its keys from the ground's file. If there are several vehicles, each vehicle also
// gets the keys of the observer, a second ground station. If there are at least four vehicles, the
// first two get each other's key.
inline void giveKeys(M3Machine::Config& config, unsigned vehicles, const std::string& file,
                     const std::string& observer) {
    config.key = keyOf(file, static_cast<int>(config.address));
    try {
        if (auto key = keyOf(file, XBeeAT::everybody); !key.empty())
            config.peers.push_back({UAV_GROUP, UAV_EVERYBODY, key});
    } catch (const std::exception&) { // the file has no line for this address
    }
    if (vehicles > 1)
        config.peers.push_back(
            {UAV_OBSERVER, Station::second, keyOf(observer, static_cast<int>(config.address))});
    if (vehicles > 3 && config.address < 3)
        config.peers.push_back({UAV_VEHICLE, 3 - config.address, keyOf(observer, 1)});
}

// A fault, described by a text: `away:2:1.5:3` takes the modem with the address 2 out of reach for
// 3 s, 1.5 s after the beginning of the flight. `twin:2:...` brings another vehicle with this
// address and a different key into reach. `babble:2:...` adds a modem that continuously
// sends noise to this address.
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
    // Prepares the fault. `modem` is the modem with the fault's address (away), the modem of the
    // twin, or null (babble).
    void begin(RfChannel& air, const XBee* modem) {
        air_ = &air;
        modem_ = modem;
        XBee::Options options;
        options.set = {{"MY", 0x0BAB}, {"DL", static_cast<uint32_t>(address)}, {"BD", 7}};
        babbler_ = std::make_unique<XBee>(line_, air, options);
    }
    // Starts or ends the fault when its time has come. Returns the time at which this function must
    // be called next.
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
