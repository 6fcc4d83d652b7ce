// SPDX-License-Identifier: MIT
//
// mac: the IEEE 802.15.4 MAC of one modem. It waits for a clear channel, sends a packet, and
// repeats this until the packet is acknowledged or the number of tries is used up. Sources:
// docs/simulation.md.

#pragma once

#include "rf_channel.h"
#include <cstdint>

class Mac : private RfSender {
public:
    enum class Fate { Sent, NoAck, NoClearChannel };

    // Interface of the modem to which a MAC belongs.
    class Modem : public RfReceiver {
    public:
        // Returns the time until which the modem is busy with other packets and cannot send one.
        virtual uint64_t busyUntil() const = 0;
        // Called when the current packet has been sent or has failed.
        virtual void transmitted(uint64_t now, Fate fate) = 0;
    };

    Mac(RfChannel& air, Modem& modem) : air_(air), modem_(modem) {}
    ~Mac() { abort(); }
    Mac(const Mac&) = delete;
    Mac& operator=(const Mac&) = delete;

    // Sends a packet. The previous packet must have ended. Calls Modem::transmitted at the end.
    void send(RfPacket packet, uint64_t now);
    // Abandons the packet. A frame that is already on the air still arrives.
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
    // outcome that the model of the air has drawn for this packet
    RfOutcome drawn_ = RfOutcome::Delivered;
    // Number of tries left in this round, number of rounds left (RR), and number of copies of a
    // broadcast left.
    unsigned triesLeft_ = 0, roundsLeft_ = 0, copiesLeft_ = 0;
    unsigned busySenses_ = 0; // number of carrier senses of this try that found the channel busy
    Fate fate_ = Fate::Sent;
};
