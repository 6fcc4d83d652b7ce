// SPDX-License-Identifier: MIT
//
// attacker: a foreign modem on the air. It hears every packet, keeps all, and sends anything in
// anybody's name.

#pragma once

#include "rf_channel.h"

class Attacker {
public:
    using Bytes = std::vector<uint8_t>;

    // Listens from now on: it is the channel's only listener.
    Attacker(RfChannel& air, uint64_t seed)
        : air_(air), random_(seed), modem_(line_, air, modemOfNobody()) {
        air.onPacket([this](uint64_t, const RfPacket& packet, RfChannel::Outcome) {
            toHinder_ += hinders_ && packet.bytes != lure();
            // Its own packets arrive as the link's: the air does not tell them apart.
            if (heard_.size() < 100'000)
                heard_.push_back(packet);
        });
    }

    // Sends bytes, cut to a packet, in the name of `from`.
    void send(uint16_t from, uint16_t to, Bytes bytes, uint64_t now) {
        RfPacket packet;
        packet.from = from;
        packet.to = to;
        packet.pan = static_cast<uint16_t>(modem_.parameter("ID"));
        packet.channel = static_cast<uint8_t>(modem_.parameter("CH"));
        bytes.resize(std::min(bytes.size(), mostBytes));
        packet.bytes = std::move(bytes);
        ++sent_;
        air_.transmit(&modem_, packet, now);
    }
    // Does one of the things that are possible without a key, drawn at random: repeats a packet,
    // recent or old; reflects it to its sender, or sends it to another in another's name; changes a
    // bit; cuts it; joins two; makes up handshakes, resets, ends, acknowledgements and data, with
    // tags or CRCs; makes noise.
    void doMischief(uint64_t now) {
        if (heard_.empty() || random_.below(4) == 0) {
            const bool up = random_.below(2);
            return send(up ? ground : uav, up ? uav : ground, invented(), now);
        }
        const RfPacket& packet = recalled();
        Bytes bytes = packet.bytes;
        uint16_t from = packet.from, to = packet.to;
        const auto size = static_cast<uint32_t>(bytes.size());
        switch (random_.below(7)) {
        case 0:
            std::swap(from, to);
            break;
        case 1:
            if (size)
                bytes[random_.below(size)] ^= static_cast<uint8_t>(1u << random_.below(8));
            break;
        case 2:
            bytes.resize(random_.below(size + 1));
            break;
        case 3: {
            const Bytes& more = recalled().bytes;
            bytes.insert(bytes.begin(), more.begin(), more.end());
            break;
        }
        case 4:
            from = recalled().from;
            to = recalled().to;
            break;
        default: // unchanged
            break;
        }
        if (!bytes.empty())
            send(from, to, bytes, now);
    }
    // Adds 20 bytes to each packet from now on, or adds no more: what looks like six HELLOs, so
    // that a receiver looks for frames there, and pays for it, while the true next one waits.
    void hinder(bool isOn) { hinders_ = isOn; }
    void advance(uint64_t now) {
        modem_.advance(now);
        for (; toHinder_; --toHinder_) {
            send(ground, uav, lure(), now);
            send(uav, ground, lure(), now);
        }
    }
    uint64_t nextEvent() const { return modem_.nextEvent(); }

    uint64_t sent() const { return sent_; } // packets
    size_t heard() const { return heard_.size(); }

private:
    static constexpr size_t mostBytes = 100; // of a packet
    static constexpr uint16_t uav = 1, ground = 0;

    static XBee::Options modemOfNobody() {
        XBee::Options options;
        options.name = "attacker";
        options.set = {{"MY", 0x0BAD}, {"DL", uav}};
        return options;
    }
    static Bytes lure() {
        Bytes bytes = {0xFF};
        for (int i = 0; i < 6; ++i)
            bytes.insert(bytes.end(), {0x8E, 6, 0x20}); // a HELLO's header, protocol version 6
        bytes.push_back(0x8E);
        return bytes;
    }
    // One of the newest half of the time, else any.
    const RfPacket& recalled() {
        const auto count = static_cast<uint32_t>(heard_.size());
        const uint32_t span = random_.below(2) ? count : std::min(count, 20u);
        return heard_[count - 1 - random_.below(span)];
    }
    // Control frames of every kind and epoch, and data, whose tag is a guess.
    Bytes invented() {
        Bytes bytes;
        while (bytes.size() < mostBytes && (bytes.empty() || random_.below(4))) {
            const uint32_t size = random_.below(2) ? random_.below(20) : 0;
            bytes.push_back(static_cast<uint8_t>(size | (random_.below(4) ? 0x80 : 0)));
            bytes.push_back(static_cast<uint8_t>(random_.below(2) ? 3 : random_.next()));
            for (uint32_t i = 0; i < 1 + size + 8; ++i)
                bytes.push_back(static_cast<uint8_t>(random_.next()));
        }
        return bytes;
    }

    RfChannel& air_;
    Random random_;
    HostLine line_;
    XBee modem_;
    std::vector<RfPacket> heard_;
    uint64_t sent_ = 0;
    bool hinders_ = false;
    unsigned toHinder_ = 0; // packets heard, and not yet hindered
};
