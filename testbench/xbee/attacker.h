// SPDX-License-Identifier: MIT
//
// attacker: a modem of nobody's on the air. It hears every packet, keeps them for ever, and sends
// what it likes in anybody's name.

#ifndef ATTACKER_H
#define ATTACKER_H

#include "rf_channel.h"

class Attacker {
public:
    using Bytes = std::vector<uint8_t>;

    // Listens from now on: it is the channel's only listener.
    Attacker(RfChannel& air, uint64_t seed);

    // Sends bytes, cut to a packet, as if `from` did.
    void send(uint16_t from, uint16_t to, Bytes bytes, uint64_t now);
    // Does one thing of all that it can do without a key, drawn at random: repeats what it heard,
    // now or long ago; sends it back to who said it; changes a bit; cuts it; puts two together;
    // makes handshakes, resets, ends, acknowledgements and data up, with tags or CRCs; makes noise.
    void doMischief(uint64_t now);
    void advance(uint64_t now) { modem_.advance(now); }
    uint64_t nextEvent() const { return modem_.nextEvent(); }

    uint64_t sent() const { return sent_; } // packets
    size_t heard() const { return heard_.size(); }

private:
    const RfPacket& recalled();
    Bytes invented();

    RfChannel& air_;
    Random random_;
    HostLine line_;
    XBee modem_;
    std::vector<RfPacket> heard_;
    uint64_t sent_ = 0;
};

#endif
