// SPDX-License-Identifier: MIT
//
// rf_channel: the air between modems: delay, loss, bursts of loss, duplication, corruption, lost
// acknowledgements, collisions, by seed.

#ifndef RF_CHANNEL_H
#define RF_CHANNEL_H

#include "random.h"
#include "xbee.h"
#include <functional>
#include <list>
#include <memory>

class RfChannel {
public:
    // Each a probability unless it says otherwise.
    struct Weather {
        // Residual loss of a packet in one direction, after the MAC's tries; costs no air time
        // more.
        double loss = 0;
        double burstBegin = 0, burstEnd = 0.2, burstLoss = 0.9; // Gilbert-Elliott, per packet
        double duplication = 0, corruption = 0;
        uint64_t delayNs = 0; // beyond the time on the air
        // The MAC itself: one try is lost, or its acknowledgement, and it tries again.
        double tryLoss = 0, ackLoss = 0;
        // Modems share the channel: carrier sense, random waits (RN), collisions.
        bool contention = false;
    };
    enum class Outcome { Delivered, Lost, Corrupted, Nobody, NoRoom, NoClearChannel };
    struct Counters {
        uint64_t packets = 0, bytes = 0, lost = 0, duplicated = 0, corrupted = 0;
        uint64_t retries = 0, collisions = 0, noClearChannel = 0;
        uint64_t airNs = 0; // time that the tries took
    };
    using Listener = std::function<void(uint64_t now, const RfPacket&, Outcome)>;

    explicit RfChannel(uint64_t seed) : random_(seed) {}

    Weather weather;
    void onPacket(Listener listener) { listener_ = std::move(listener); }
    const Counters& counters() const { return counters_; }

    void join(XBee* modem) { modems_.push_back(modem); }
    void leave(XBee* modem);
    // The sender hears transmitted() when the packet has left or was given up.
    void transmit(XBee* sender, RfPacket packet, uint64_t now);
    void advance(uint64_t now);
    uint64_t nextEvent() const { return events_.empty() ? never : events_.begin()->first; }

    // Time on the air of n payload bytes with the MAC's acknowledgement: docs/modem.md.
    static uint64_t airTimeNs(size_t bytes);

private:
    struct OnAir { // one try, where modems share the channel
        uint8_t channel;
        uint64_t begin, end;
        bool collided = false;
    };
    struct Flight {
        XBee* sender;
        RfPacket packet;
        unsigned triesLeft;
        Outcome outcome;
        bool again;  // a duplicate: the sender has been told already
        bool begins; // still has to find the channel clear
        unsigned backoffs = 0, unanswered = 0;
        std::shared_ptr<OnAir> onAir;
    };
    void start(Flight flight, uint64_t now);
    void begin(Flight flight, uint64_t now);
    void land(Flight flight, uint64_t now);
    void retry(Flight flight, uint64_t now);
    void finish(Flight& flight, Outcome outcome, uint64_t now);
    Outcome deliver(Flight& flight, uint64_t now);
    Outcome fate();

    Random random_;
    bool inBurst_ = false;
    std::vector<XBee*> modems_;
    std::multimap<uint64_t, Flight> events_;
    std::list<std::shared_ptr<OnAir>> onAir_;
    Counters counters_;
    Listener listener_;
};

#endif
