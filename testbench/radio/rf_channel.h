// SPDX-License-Identifier: MIT
//
// rf_channel: models the air between modems. It is half duplex and shared, so frames can collide.
// The simulated air loses, damages, delays and duplicates frames at random; a seed makes this
// repeatable.

#pragma once

#include "random.h"
#include "rf_packet.h"
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <functional>
#include <list>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

// The recording of a radio link: a CSV file with the heading `time_s,loss,rssi_dbm,delay_ms`. A row
// is valid until the time of the next row; the last row is valid for ever.
class RfTrace {
public:
    struct Row {
        uint64_t ns;
        double loss;      // fraction of packets that are lost in spite of the MAC's retries
        double rssi;      // dBm
        uint64_t delayNs; // delay in addition to the time on the air, ns
    };
    // Reads a file. Throws std::runtime_error with the name of the file, the line and the error.
    explicit RfTrace(const std::string& path) {
        std::ifstream file(path);
        std::string line;
        size_t number = 1;
        auto fail = [&](const std::string& what) {
            throw std::runtime_error(path + ":" + std::to_string(number) + ": " + what);
        };
        if (!file || !std::getline(file, line))
            throw std::runtime_error(path +
                                     ": expected a trace (CSV), got a missing or empty file");
        if (line != heading)
            fail(std::string("expected the heading '") + heading + "'");
        while (++number, std::getline(file, line)) {
            if (line.empty() || line[0] == '#')
                continue;
            double time, loss, rssi, delay;
            char more;
            if (std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf%c", &time, &loss, &rssi, &delay,
                            &more) != 4)
                fail("expected four numbers");
            if (time < 0 || loss < 0 || loss > 1 || delay < 0)
                fail("expected time and delay of at least 0, and a loss of 0 to 1");
            uint64_t ns = static_cast<uint64_t>(time * 1e9);
            if (!rows_.empty() && ns <= rows_.back().ns)
                fail("expected a later time than in the row before");
            rows_.push_back({ns, loss, rssi, static_cast<uint64_t>(delay * 1e6)});
        }
        if (rows_.empty())
            fail("expected at least one row");
    }
    const Row& at(uint64_t ns) const {
        auto next = std::upper_bound(rows_.begin(), rows_.end(), ns,
                                     [](uint64_t time, const Row& row) { return time < row.ns; });
        return next == rows_.begin() ? *next : *std::prev(next);
    }

private:
    static constexpr const char* heading = "time_s,loss,rssi_dbm,delay_ms";

    std::vector<Row> rows_;
};

// RfWeather: the radio conditions. Fields are probabilities unless stated otherwise.
struct RfWeather {
    // Probability that a packet is lost in one direction in spite of the MAC's retries. Such a loss
    // takes no additional air time.
    double loss = 0;
    double burstBegin = 0, burstEnd = 0.2,
           // Parameters of bursts of losses (Gilbert-Elliott model). The state of the model is
           // drawn for each packet, or every 10 ms without packets.
        burstLoss = 0.9;
    double duplication = 0, corruption = 0;
    uint64_t delayNs = 0; // delay in addition to the time on the air, ns
    // Probabilities that one try of the MAC is lost, and that the acknowledgement of a try is lost.
    // The MAC then retries.
    double tryLoss = 0, ackLoss = 0;
    // Distance between the modems, m, in free space with Rayleigh fading for each try; 0 disables
    // this model.
    double distance = 0;
    // Fraction of each period during which an interferer sends. The channel is then busy, and a try
    // that overlaps with this time is lost. A microwave oven sends for about half of 20 ms (50 Hz).
    double interference = 0;
    uint64_t interferencePeriodNs = 20'000'000;
    // Recorded link; its values replace `loss` and `delayNs`.
    std::shared_ptr<const RfTrace> trace;
    // Perfect air, for unit tests: frames may be sent in both directions at the same time, without
    // carrier sense, collisions, or processing time in the modems. No real radio behaves like this.
    bool perfect = false;

    // Radio conditions from publications: losses in bursts as on flights, lost tries as in field
    // tests, a distance in open terrain, an interferer. Sources: docs/simulation.md.
    static const std::vector<std::pair<std::string, RfWeather>>& published() {
        static const auto all = [] {
            std::vector<std::pair<std::string, RfWeather>> list;
            auto add = [&](const std::string& name) -> RfWeather& {
                return list.emplace_back(name, RfWeather()).second;
            };
            auto bursts = [&](const char* name, double begin, double end, double inside,
                              double outside) {
                RfWeather& w = add(name);
                w.burstBegin = begin, w.burstEnd = end, w.burstLoss = inside, w.loss = outside;
            };
            bursts("bursts, long", 0.01, 0.08, 1, 0.02);
            bursts("bursts, mean", 0.03, 0.4, 0.95, 0.01);
            bursts("bursts, frequent", 0.08, 0.5, 0.9, 0);
            add("a quarter of the tries lost").tryLoss = 0.25;
            for (unsigned metres : {100u, 200u, 300u, 400u})
                add(std::to_string(metres) + " m, fading").distance = metres;
            for (unsigned percent : {10u, 25u, 50u})
                add("interferer " + std::to_string(percent) + " %").interference = percent / 100.0;
            return list;
        }();
        return all;
    }
    // Draws radio conditions at random: one of the published kinds, or independent losses below
    // `mostLoss` percent, or no losses; sometimes also duplicated and damaged packets.
    static RfWeather drawn(Random& random, unsigned mostLoss) {
        RfWeather w;
        const size_t kind = random.below(static_cast<uint32_t>(3 * published().size()));
        if (kind < published().size())
            w = published()[kind].second;
        else if (kind < 2 * published().size())
            w.loss = random.below(mostLoss) / 100.0;
        w.duplication = random.below(2) ? 0 : 0.1;
        w.corruption = random.below(2) ? 0 : 0.03;
        return w;
    }

    bool interferes(uint64_t from, uint64_t to) const {
        if (interference <= 0)
            return false;
        auto on = static_cast<uint64_t>(interference * static_cast<double>(interferencePeriodNs));
        uint64_t phase = from % interferencePeriodNs;
        return phase < on || phase + (to - from) >= interferencePeriodNs;
    }
    // Returns the received strength, in dBm, of a modem that sends with 0 dBm at `distance`.
    double meanRssi() const {
        // loss on the first metre, dB, in free space at 2.4 GHz
        constexpr double lossOfFirstMetre = 40;
        return -lossOfFirstMetre - 20 * std::log10(std::max(distance, 1.0));
    }
};

// A receiver to which the air delivers packets.
class RfReceiver {
public:
    virtual ~RfReceiver() = default;
    virtual bool
    // Returns whether the packet is addressed to this receiver.
    hears(const RfPacket& packet) const = 0;
    // Result of receive(). Absent: the modem is off or is booting. NoRoom: the packet is
    // acknowledged but lost, because the buffer to the host is full.
    enum class Reception { Absent, NoRoom, Taken };
    virtual Reception receive(const RfPacket& packet, uint64_t now) = 0;
};

// A sender; the air calls it while a packet is being sent.
class RfSender {
public:
    virtual ~RfSender() = default;
    virtual void wake(uint64_t now) = 0; // called at the time that was requested by wakeAt()
    virtual void ended(uint64_t now, const RfPacket& arrived, RfOutcome outcome,
                       bool isAnswered) = 0; // Called at the end of a frame with its result.
};

class RfChannel {
public:
    using Weather = RfWeather;
    using Outcome = RfOutcome;
    struct Counters {
        uint64_t packets = 0, bytes = 0, lost = 0, duplicated = 0, corrupted = 0;
        uint64_t retries = 0, collisions = 0, noClearChannel = 0;
        uint64_t airNs = 0; // air time that all tries of a packet took, ns
    };
    using Listener = std::function<void(uint64_t now, const RfPacket&, Outcome)>;

    explicit RfChannel(uint64_t seed) : random_(seed) {}

    Weather weather;
    // Sets a function that is called once per packet, when its outcome is known.
    void onPacket(Listener listener) { listener_ = std::move(listener); }
    const Counters& counters() const { return counters_; }

    void join(RfReceiver* modem) { modems_.push_back(modem); }
    void leave(RfReceiver* modem);
    // Moves a modem out of reach of all others, or back into reach.
    void carryAway(const RfReceiver* modem, bool isAway);
    // Returns the processing time `ns` of a modem, varied at random by up to 5 %; 0 in perfect air.
    uint64_t jittered(uint64_t ns);
    void advance(uint64_t now);
    uint64_t nextEvent() const { return events_.empty() ? ~uint64_t(0) : events_.begin()->first; }

    // Returns the air time of a packet with `bytes` of payload between modems with 16-bit
    // addresses, ns. It includes the maker's header, carrier sense, the MAC's acknowledgement and
    // the gap after it (docs/simulation.md).
    static uint64_t airTimeNs(size_t bytes);

    // Functions that the MACs of the modems call:

    // Draws the strength and the outcome of a new packet.
    Outcome announce(const RfReceiver& from, RfPacket& packet, uint64_t now);
    // Returns whether carrier sense finds the channel clear from `from` to `to`.
    bool isClear(uint8_t channel, uint64_t from, uint64_t to) const;
    // Makes one try of a packet, with carrier sense at `now`. Calls the sender's ended() at the end
    // of the frame.
    void put(RfSender& sender, const RfReceiver& from, RfPacket packet, Outcome drawn,
             uint64_t now);
    // Calls the sender's wake() at the time `at`.
    void wakeAt(uint64_t at, RfSender* sender) { events_.emplace(at, Event{sender, nullptr}); }
    // Removes a sender; its functions are then no longer called.
    void forget(const RfSender* sender);
    void report(uint64_t now, const RfPacket& packet, Outcome outcome);
    void countRetry() { ++counters_.retries; }
    uint32_t below(uint32_t limit) { return random_.below(limit); }

private:
    struct Frame { // A try of a packet that is on the air.
        RfPacket packet;
        Outcome drawn; // outcome drawn for the packet
        const RfReceiver* from;
        // times at which the frame begins and ends, and at which its acknowledgement ends
        uint64_t begin, frameEnd, end;
        bool collided = false;
        // Returns the time at which the air is free again. A frame that collided is not
        // acknowledged.
        uint64_t over() const { return collided ? frameEnd : end; }
    };
    struct Event {
        // sender of the frame; null if the frame is a duplicate, or if the sender was reset or
        // removed
        RfSender* sender;
        // frame that ends at this time; null if this event calls the sender's wake()
        std::shared_ptr<Frame> frame;
    };
    void land(RfSender* sender, Frame& frame, uint64_t now);
    bool isMissed(Frame& frame);
    Outcome deliver(const Frame& frame, uint64_t now);
    Outcome fate(uint64_t now);
    bool faded(RfPacket& packet);
    uint64_t delayNs(uint64_t now) const;

    Random random_;
    bool inBurst_ = false;
    uint64_t fateAt_ = 0; // time of the last packet
    std::vector<RfReceiver*> modems_;
    std::set<const RfReceiver*> away_;
    std::multimap<uint64_t, Event> events_;
    std::list<std::shared_ptr<Frame>> onAir_;
    Counters counters_;
    Listener listener_;
};
