// SPDX-License-Identifier: MIT
//
// link_pair: two link layers joined by a radio that loses, doubles, spoils and delays packets.

#ifndef LINK_PAIR_H
#define LINK_PAIR_H

extern "C" {
#include "link.h"
}

#include "random.h"
#include <cstring>
#include <deque>
#include <functional>
#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

// The radio's faults, with the probability of each for a packet.
struct Weather {
    double loss = 0, duplication = 0, corruption = 0;
    uint32_t delayUs = 8000;
};

constexpr uint32_t byteTimeUs16 = 1440; // 111,111 baud

class Side {
public:
    using Bytes = std::vector<uint8_t>;

    explicit Side(uint64_t seed, const Bytes& key = {})
        : random_(seed), link_(std::make_unique<Link>()), key_(key) {
        boot();
    }

    // Forgets everything, like a reboot after a power cut.
    void boot() {
        static const Link_Port port = {transmit, random, message, channel, state, outcome, nullptr};
        Link_init(link_.get(), &port, this, byteTimeUs16);
        if (!key_.empty())
            Link_setKey(link_.get(), 0, key_.data());
        air.clear();
        serialFreeUs = 0;
    }

    Link* link() { return link_.get(); }

    struct Packet {
        uint64_t arrives;
        Bytes bytes;
    };

    uint64_t nowUs = 0, serialFreeUs = 0;
    Weather weather;
    std::deque<Packet> air; // towards the peer, in order of arrival
    std::vector<std::pair<int, Bytes>> received;
    std::map<uint32_t, Link_Outcome> outcomes;
    std::vector<std::string> events;
    bool refuse = false; // the program takes no message
    unsigned queued() const { return static_cast<unsigned>(air.size()); }

private:
    static Side& self(void* context) { return *static_cast<Side*>(context); }

    // One serial port of 11.1 kB/s, then the air; four packets fit the modem and its ring.
    static int transmit(void* context, const U8* frame, U32 size) {
        Side& s = self(context);
        if (s.serialFreeUs > s.nowUs + 4 * 9000)
            return 1;
        uint64_t start = std::max(s.serialFreeUs, s.nowUs);
        s.serialFreeUs = start + size * byteTimeUs16 / 16;
        if (s.random_.chance(s.weather.loss))
            return 0;
        Packet packet{s.serialFreeUs + s.weather.delayUs, Bytes(frame, frame + size)};
        if (s.random_.chance(s.weather.corruption))
            packet.bytes[s.random_.below(size)] ^= static_cast<uint8_t>(1 + s.random_.below(255));
        s.air.push_back(packet);
        if (s.random_.chance(s.weather.duplication))
            s.air.push_back(packet);
        return 0;
    }
    static U32 random(void* context) { return self(context).random_.next(); }
    static int message(void* context, int channel, const U8* data, U32 size) {
        if (self(context).refuse)
            return 1;
        self(context).received.emplace_back(channel, Bytes(data, data + size));
        return 0;
    }
    static void channel(void* context, int channel, int isOpen) {
        self(context).events.push_back((isOpen ? "open " : "close ") + std::to_string(channel));
    }
    static void state(void* context, Link_State state) {
        static const char* const names[] = {"idle", "connecting", "up"};
        self(context).events.push_back(names[state]);
    }
    static void outcome(void* context, int, U32 tag, Link_Outcome outcome) {
        auto& outcomes = self(context).outcomes;
        if (!outcomes.emplace(tag, outcome).second)
            throw std::logic_error("two outcomes for message " + std::to_string(tag));
    }

    Random random_;
    std::unique_ptr<Link> link_;
    const Bytes key_;
};

class Pair {
public:
    explicit Pair(uint64_t seed, const Side::Bytes& key = {})
        : a(seed * 2 + 1, key), b(seed * 2 + 2, key) {}

    void setWeather(Weather weather) { a.weather = b.weather = weather; }

    // Lets `us` microseconds pass, in steps of the firmware's tick.
    void run(uint64_t us) {
        for (uint64_t end = nowUs + us; nowUs < end; nowUs += 1000) {
            a.nowUs = b.nowUs = nowUs;
            deliver(a, b);
            deliver(b, a);
            Link_poll(a.link(), now32());
            Link_poll(b.link(), now32());
        }
    }
    bool runUntil(const std::function<bool()>& done, uint64_t limitUs) {
        for (uint64_t end = nowUs + limitUs; nowUs < end; run(1000))
            if (done())
                return true;
        return done();
    }
    bool bothUp() {
        return Link_state(a.link()) == LINK_STATE_UP && Link_state(b.link()) == LINK_STATE_UP;
    }
    bool connect() {
        Link_start(a.link(), now32());
        return runUntil([&] { return bothUp(); }, 30000000);
    }
    U32 now32() const { return static_cast<U32>(nowUs); }

    Side a, b;
    uint64_t nowUs = 0xFFFF0000u; // so that the 32-bit time wraps in every test

private:
    void deliver(Side& from, Side& to) {
        while (!from.air.empty() && from.air.front().arrives <= nowUs) {
            Side::Packet packet = from.air.front();
            from.air.pop_front();
            Link_receive(to.link(), packet.bytes.data(), static_cast<U32>(packet.bytes.size()),
                         now32());
        }
    }
};

#endif
