// SPDX-License-Identifier: MIT
//
// mac: the IEEE 802.15.4 MAC of one modem. It waits for a clear channel, sends a packet, and tries
// again until the packet is acknowledged or its tries are used up. Sources: docs/simulation.md.

#pragma once

#include "rf_channel.h"
#include <cstdint>

class Mac : private RfSender {
public:
    enum class Fate { Sent, NoAck, NoClearChannel };

    // The modem that the MAC belongs to.
    class Modem : public RfReceiver {
    public:
        // Returns when the modem's work on packets ends; until then it sends none.
        virtual uint64_t busyUntil() const = 0;
        // The packet in flight has ended.
        virtual void transmitted(uint64_t now, Fate fate) = 0;
    };

    Mac(RfChannel& air, Modem& modem) : air_(air), modem_(modem) {}
    ~Mac() { abort(); }
    Mac(const Mac&) = delete;
    Mac& operator=(const Mac&) = delete;

    // Sends a packet; one at a time. Modem::transmitted follows.
    void send(RfPacket packet, uint64_t now);
    // Drops the packet; a frame that is on the air still arrives.
    void abort();

private:
    void wake(uint64_t now) override;
    void ended(uint64_t now, const RfPacket& arrived, RfOutcome outcome, bool isAnswered) override;

    enum class State { Idle, Waiting, OnAir, Gap };

    void startRound(uint64_t now, uint64_t ready);
    void startTry(uint64_t now, uint64_t ready);
    void waitUntil(uint64_t at, uint64_t now);
    void sense(uint64_t now);
    void failed(uint64_t now, uint64_t ready, Fate fate);
    uint64_t randomWaitNs(unsigned exponent);
    void finish(uint64_t now, Fate fate);

    RfChannel& air_;
    Modem& modem_;
    State state_ = State::Idle;
    RfPacket packet_;
    RfOutcome drawn_ = RfOutcome::Delivered; // the weather's decision on this packet
    // Remaining tries of this round, rounds of RR, and copies of a broadcast.
    unsigned triesLeft_ = 0, roundsLeft_ = 0, copiesLeft_ = 0;
    unsigned busySenses_ = 0; // busy carrier senses in this try
    Fate fate_ = Fate::Sent;
};
