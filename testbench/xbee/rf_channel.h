// SPDX-License-Identifier: MIT
//
// rf_channel: the air between modems, half duplex and shared: carrier sense, random waits,
// collisions, tries and acknowledgements of the MAC, and the weather (rf_weather.h), by seed.

#pragma once

#include "random.h"
#include "rf_weather.h"
#include "xbee.h"
#include <functional>
#include <list>
#include <memory>
#include <set>

class RfChannel {
public:
    using Weather = RfWeather;
    enum class Outcome { Delivered, Lost, Corrupted, Nobody, NoRoom, NoClearChannel };
    struct Counters {
        uint64_t packets = 0, bytes = 0, lost = 0, duplicated = 0, corrupted = 0;
        uint64_t retries = 0, collisions = 0, noClearChannel = 0;
        uint64_t airNs = 0; // time of the tries
    };
    using Listener = std::function<void(uint64_t now, const RfPacket&, Outcome)>;

    explicit RfChannel(uint64_t seed) : random_(seed) {}

    Weather weather;
    void onPacket(Listener listener) { listener_ = std::move(listener); }
    const Counters& counters() const { return counters_; }

    void join(XBee* modem) { modems_.push_back(modem); }
    void leave(XBee* modem);
    // Puts a modem out of reach of all others, or brings it back.
    void carryAway(const XBee* modem, bool isAway);
    // Sends a packet when its modem is free; the sender's transmitted() is called when the packet
    // has left or was given up.
    void transmit(XBee* sender, RfPacket packet, uint64_t now);
    // Returns a time of a modem's own work: it varies by a twentieth; 0 in perfect air.
    uint64_t jittered(uint64_t ns);
    void advance(uint64_t now);
    uint64_t nextEvent() const { return events_.empty() ? never : events_.begin()->first; }

    // Time on the air of n payload bytes from one 16-bit address to another, with the maker's
    // header, carrier sense, the MAC's acknowledgement and the gap after it: docs/simulation.md.
    static uint64_t airTimeNs(size_t bytes);

private:
    struct OnAir { // one try
        uint8_t channel;
        uint64_t begin, end; // of the frame; of its acknowledgement
        bool collided = false;
    };
    struct Flight {
        XBee* sender;
        RfPacket packet;
        unsigned triesLeft, roundsLeft, copiesLeft; // of the MAC; by RR; of a broadcast with RR
        Outcome outcome;
        bool again;  // a duplicate: the sender has been informed already
        bool begins; // still has to find the channel clear
        unsigned backoffs = 0, unanswered = 0;
        bool answered = true; // the last try's acknowledgement came
        std::shared_ptr<OnAir> onAir = nullptr;
    };
    void start(Flight flight, uint64_t now, uint64_t ready);
    void begin(Flight flight, uint64_t now);
    void land(Flight flight, uint64_t now);
    void retry(Flight flight, uint64_t now);
    void finish(Flight& flight, Outcome outcome, uint64_t now);
    Outcome deliver(Flight& flight, uint64_t now);
    Outcome fate(uint64_t now);
    bool faded(RfPacket& packet);
    uint64_t delayNs(uint64_t now) const;

    Random random_;
    bool inBurst_ = false;
    uint64_t fateAt_ = 0; // of the last packet
    std::vector<XBee*> modems_;
    std::set<const XBee*> away_;
    std::multimap<uint64_t, Flight> events_;
    std::list<std::shared_ptr<OnAir>> onAir_;
    Counters counters_;
    Listener listener_;
};
