// SPDX-License-Identifier: MIT
//
// rf_channel: the air between modems: delay, loss, bursts of loss, duplication, corruption, by
// seed.

#ifndef RF_CHANNEL_H
#define RF_CHANNEL_H

#include "random.h"
#include "xbee.h"
#include <functional>

class RfChannel {
public:
    // `loss` is the residual loss of a packet in one direction, after the MAC's retries.
    struct Weather {
        double loss = 0;
        double burstBegin = 0, burstEnd = 0.2, burstLoss = 0.9; // Gilbert-Elliott, per packet
        double duplication = 0, corruption = 0;
        uint64_t delayNs = 0; // beyond the time on the air
    };
    enum class Outcome { Delivered, Lost, Corrupted, Nobody, NoRoom };
    struct Counters {
        uint64_t packets = 0, bytes = 0, lost = 0, duplicated = 0, corrupted = 0;
    };
    using Listener = std::function<void(uint64_t now, const RfPacket&, Outcome)>;

    explicit RfChannel(uint64_t seed) : random_(seed) {}

    Weather weather;
    void onPacket(Listener listener) { listener_ = std::move(listener); }
    const Counters& counters() const { return counters_; }

    void join(XBee* modem) { modems_.push_back(modem); }
    void leave(XBee* modem);
    // The sender hears transmitted() when the packet has left.
    void transmit(XBee* sender, RfPacket packet, uint64_t now);
    void advance(uint64_t now);
    uint64_t nextEvent() const { return events_.empty() ? never : events_.begin()->first; }

    // Time on the air of n payload bytes with the MAC's acknowledgement: docs/modem.md.
    static uint64_t airTimeNs(size_t bytes);

private:
    struct Flight {
        XBee* sender;
        RfPacket packet;
        unsigned triesLeft;
        Outcome outcome;
        bool again; // a duplicate: the sender has been told already
    };
    void land(Flight flight, uint64_t now);
    Outcome fate();

    Random random_;
    bool inBurst_ = false;
    std::vector<XBee*> modems_;
    std::multimap<uint64_t, Flight> events_;
    Counters counters_;
    Listener listener_;
};

#endif
