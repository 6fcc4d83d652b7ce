// SPDX-License-Identifier: MIT
//
// attacker: a foreign modem on the air. It hears every packet, keeps all, and sends anything in
// anybody's name.

#ifndef ATTACKER_H
#define ATTACKER_H

#include "rf_channel.h"

class Attacker {
public:
    using Bytes = std::vector<uint8_t>;

    // Listens from now on: it is the channel's only listener.
    Attacker(RfChannel& air, uint64_t seed);

    // Sends bytes, cut to a packet, in the name of `from`.
    void send(uint16_t from, uint16_t to, Bytes bytes, uint64_t now);
    // Does one of the things that are possible without a key, drawn at random: repeats a packet,
    // recent or old; reflects it to its sender; changes a bit; cuts it; joins two; makes up
    // handshakes, resets, ends, acknowledgements and data, with tags or CRCs; makes noise.
    void doMischief(uint64_t now);
    // Adds 20 bytes to each packet from now on, or adds no more: what looks like six HELLOs, so
    // that a receiver looks for frames there, and pays for it, while the true next one waits.
    void hinder(bool isOn) { hinders_ = isOn; }
    void advance(uint64_t now);
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
    bool hinders_ = false;
    unsigned toHinder_ = 0; // packets heard, and not yet hindered
};

#endif
