// SPDX-License-Identifier: MIT
//
// attacker: models an attacker's modem on the air. It receives and stores every packet, and can
// send any packet in the name of any modem.

#pragma once

#include "mischief.h"
#include "rf_channel.h"
#include "xbee.h"
#include <list>
#include <memory>

class Attacker {
public:
    using Bytes = std::vector<uint8_t>;

    // Starts to listen; the channel must not have another listener.
    Attacker(RfChannel& air, uint64_t seed)
        : air_(air), random_(seed), modem_(line_, air, modemOfNobody()) {
        air.onPacket([this](uint64_t, const RfPacket& packet, RfChannel::Outcome) {
            toHinder_ += hinders_ && packet.bytes != lure_;
            // The attacker also hears its own packets, because the air does not distinguish them
            // from packets of the link.
            if (heard_.size() < 100'000)
                heard_.push_back(packet);
        });
    }

    // Sends one packet in the name of `from`. Bytes that do not fit into a packet are cut off.
    void send(uint16_t from, uint16_t to, Bytes bytes, uint64_t now) {
        RfPacket packet;
        packet.from = from;
        packet.to = to;
        packet.pan = static_cast<uint16_t>(modem_.parameter("ID"));
        packet.channel = static_cast<uint8_t>(modem_.parameter("CH"));
        bytes.resize(std::min(bytes.size(), mostBytes));
        packet.bytes = std::move(bytes);
        ++sent_;
        voices_.remove_if([](const auto& voice) { return voice->isDone; });
        voices_.push_back(std::make_unique<Voice>(air_));
        voices_.back()->mac.send(std::move(packet), now);
    }
    // Sends one hostile packet of a random kind, for which no key is needed. The packet has the
    // addresses of a recorded packet, sometimes with sender and receiver exchanged.
    void doMischief(uint64_t now) {
        if (heard_.empty())
            return;
        RfPacket as = recalled();
        if (random_.below(7) == 0)
            std::swap(as.from, as.to);
        else if (random_.below(7) == 0)
            as = recalled();
        const auto any = [this]() -> const Bytes& { return recalled().bytes; };
        send(as.from, as.to, mischief(random_, any), now);
    }
    // Starts or stops sending bytes after each packet. The bytes look like the beginning of a
    // frame.
    void hinder(bool isOn) { hinders_ = isOn; }
    void advance(uint64_t now) {
        modem_.advance(now);
        for (; toHinder_; --toHinder_) {
            send(ground, uav, lure_, now);
            send(uav, ground, lure_, now);
        }
    }
    uint64_t nextEvent() const { return modem_.nextEvent(); }

    uint64_t sent() const { return sent_; } // packets
    size_t heard() const { return heard_.size(); }

private:
    static constexpr size_t mostBytes = 100; // size of the longest packet, bytes
    static constexpr uint16_t uav = 1, ground = 0;

    // The MAC of one packet. Each packet has a separate MAC, because the attacker does not wait for
    // the end of its previous packet.
    struct Voice : Mac::Modem {
        explicit Voice(RfChannel& air) : mac(air, *this) {}
        bool hears(const RfPacket&) const override { return false; }
        Reception receive(const RfPacket&, uint64_t) override { return Reception::Absent; }
        uint64_t busyUntil() const override { return 0; }
        void transmitted(uint64_t, Mac::Fate) override { isDone = true; }
        Mac mac;
        bool isDone = false;
    };

    static XBee::Options modemOfNobody() {
        XBee::Options options;
        options.name = "attacker";
        options.set = {{"MY", 0x0BAD}, {"DL", uav}};
        return options;
    }
    // Returns a stored packet: in half of the cases one of the newest, otherwise any.
    const RfPacket& recalled() {
        const auto count = static_cast<uint32_t>(heard_.size());
        const uint32_t span = random_.below(2) ? count : std::min(count, 20u);
        return heard_[count - 1 - random_.below(span)];
    }
    const Bytes lure_ = lure(LINK_VERSION);
    RfChannel& air_;
    Random random_;
    HostLine line_;
    XBee modem_;
    std::list<std::unique_ptr<Voice>> voices_; // packets that are being sent
    std::vector<RfPacket> heard_;
    uint64_t sent_ = 0;
    bool hinders_ = false;
    // number of received packets after which the misleading bytes must still be sent
    unsigned toHinder_ = 0;
};
