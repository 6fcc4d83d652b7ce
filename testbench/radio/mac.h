// SPDX-License-Identifier: MIT
//
// mac: the IEEE 802.15.4 MAC of one modem. It waits for a clear channel, sends a packet, and tries
// again until the packet is acknowledged or its tries are used up. Sources: docs/simulation.md.

#pragma once

#include "rf_packet.h"
#include <cstdint>

class RfChannel;
class XBee;

class Mac {
public:
    enum class Fate { Sent, NoAck, NoClearChannel };

    Mac(RfChannel& air, XBee& modem) : air_(air), modem_(modem) {}
    ~Mac() { abort(); }
    Mac(const Mac&) = delete;
    Mac& operator=(const Mac&) = delete;

    // Sends a packet; one at a time. XBee::transmitted follows.
    void send(RfPacket packet, uint64_t now);
    // Drops the packet; a frame that is on the air still arrives.
    void abort();

    XBee& modem() const { return modem_; }

    // Called by the air: at the time that was asked for, and when a frame has ended.
    void wake(uint64_t now);
    void ended(uint64_t now, const RfPacket& arrived, RfOutcome outcome, bool isAnswered);

    // Returns the time in ns from carrier sense to the end of the acknowledgement.
    static uint64_t tryNs(const RfPacket& packet);
    static constexpr uint64_t byteNs = 32'000, ccaNs = 128'000, turnaroundNs = 192'000;
    static constexpr uint64_t ackNs = turnaroundNs + 11 * byteNs, gapNs = 640'000; // LIFS

private:
    enum class State { Idle, Waiting, OnAir, Gap };

    void startRound(uint64_t now, uint64_t ready);
    void startTry(uint64_t now, uint64_t ready);
    void waitUntil(uint64_t at, uint64_t now);
    void sense(uint64_t now);
    void failed(uint64_t now, uint64_t ready, Fate fate);
    uint64_t randomWaitNs(unsigned exponent);
    void finish(uint64_t now, Fate fate);

    RfChannel& air_;
    XBee& modem_;
    State state_ = State::Idle;
    RfPacket packet_;
    RfOutcome drawn_ = RfOutcome::Delivered; // the weather's decision on this packet
    // Tries of this round, rounds of RR, and copies of a broadcast that are left.
    unsigned triesLeft_ = 0, roundsLeft_ = 0, copiesLeft_ = 0;
    unsigned busySenses_ = 0; // of this try
    Fate fate_ = Fate::Sent;
};
