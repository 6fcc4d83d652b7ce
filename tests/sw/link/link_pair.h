// SPDX-License-Identifier: MIT
//
// link_pair: two link layers connected by a radio that loses, duplicates, corrupts and delays
// packets.

#pragma once

extern "C" {
#include "layer.h"
}

#include "link_program.h"
#include "random.h"
#include <deque>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

using Bytes = std::vector<uint8_t>;
// messages, each with its channel and its content
using Messages = std::vector<std::pair<int, Bytes>>;

// Faults of the radio: probabilities with which a packet is lost, duplicated or corrupted; and the
// delay of each packet.
struct Weather {
    double loss = 0, duplication = 0, corruption = 0;
    uint32_t delayUs = 8000;
};

// A link with its program and its radio. `now` refers to the time of the pair.
class Side : private LinkProgram {
public:
    Side(const Layer& of, const uint64_t& now, uint64_t seed, const Bytes& key, U32 side)
        : layer(of), now_(now), random_(seed), key_(key), side_(side),
          memory_(of.size / sizeof(uint64_t) + 1) {
        boot();
    }

    // Discards all state, like a reboot after a power failure.
    void boot() {
        layer.init(link(), linkPort(), linkProgram(), byteTimeUs * 16);
        if (!key_.empty())
            layer.setKey(link(), 0, key_.data(), side_);
        air.clear();
        serialFreeUs = 0;
    }
    Link* link() { return reinterpret_cast<Link*>(memory_.data()); }
    bool isUp() { return layer.state(link()) == LINK_STATE_UP; }
    // Returns the number of sessions that have begun.
    unsigned sessions() const {
        unsigned count = 0;
        for (auto& event : events)
            count += event == "up";
        return count;
    }
    Link_Status send(int channel, const Bytes& m, U32 tag) {
        return layer.send(link(), channel, m.data(), static_cast<U32>(m.size()), tag);
    }
    Link_Status open(int channel) { return layer.openChannel(link(), channel); }
    Link_Status close(int channel) { return layer.closeChannel(link(), channel); }
    void start() { layer.start(link(), us()); }
    void stop() { layer.stop(link(), us()); }
    void poll() { layer.poll(link(), us()); }
    U32 deadline() { return layer.deadline(link(), us()); }
    void receive(const Bytes& bytes) {
        layer.receive(link(), bytes.data(), static_cast<U32>(bytes.size()), us());
    }
    const Link_Statistics& statistics() { return *layer.statistics(link()); }

    struct Packet {
        uint64_t arrives;
        Bytes bytes;
    };

    const Layer& layer;
    Weather weather;
    std::deque<Packet> air; // packets on their way to the peer, in the order of arrival
    Messages received;
    std::map<U32, Link_Outcome> outcomes;
    std::vector<std::string> events;
    bool refuse = false; // true: the program accepts no messages
    uint64_t serialFreeUs = 0, bytesSent = 0;
    unsigned packetsLost = 0;

private:
    static constexpr U32 byteTimeUs = 90; // 111,111 baud

    U32 us() const { return static_cast<U32>(now_); }

    // Sends a frame over the serial port and then over the air. Modem and ring hold up to four
    // packets.
    bool transmit(const U8* frame, U32 size) override {
        if (serialFreeUs > now_ + 4 * 9000)
            return false;
        serialFreeUs = std::max(serialFreeUs, now_) + size * byteTimeUs;
        bytesSent += size;
        if (random_.chance(weather.loss)) {
            ++packetsLost;
            return true;
        }
        Packet packet{serialFreeUs + weather.delayUs, Bytes(frame, frame + size)};
        if (random_.chance(weather.corruption))
            packet.bytes[random_.below(size)] ^= static_cast<uint8_t>(1 + random_.below(255));
        air.push_back(packet);
        if (random_.chance(weather.duplication))
            air.push_back(packet);
        return true;
    }
    U32 random() override { return random_.next(); }
    bool take(int channel, const U8* data, U32 size) override {
        if (!refuse)
            received.emplace_back(channel, Bytes(data, data + size));
        return !refuse;
    }
    void onChannel(int channel, bool isOpen) override {
        events.push_back((isOpen ? "open " : "close ") + std::to_string(channel));
    }
    void onState(Link_State state) override {
        static const char* const names[] = {"idle", "connecting", "up"};
        events.push_back(names[state]);
    }
    void onOutcome(int, U32 tag, Link_Outcome outcome) override {
        if (!outcomes.emplace(tag, outcome).second)
            throw std::logic_error("two outcomes for message " + std::to_string(tag));
    }

    const uint64_t& now_;
    Random random_;
    const Bytes key_;
    const U32 side_; // number of the side, as for Link_setKey
    std::vector<uint64_t> memory_;
};

// A pair of links: a ground station (a) and a vehicle (b), unless a test uses them in another way.
class LinkPair {
public:
    explicit LinkPair(uint64_t seed, const Bytes& key = {}, const Layer& ofA = layer,
                      const Layer& ofB = layer, U32 sideA = LINK_GROUND | 1, U32 sideB = 1)
        : a(ofA, now, seed * 2 + 1, key, sideA), b(ofB, now, seed * 2 + 2, key, sideB) {}

    void setWeather(const Weather& weather) { a.weather = b.weather = weather; }

    // Advances time in steps of the firmware's tick until `done` returns true. Returns false if
    // this takes longer than `limitUs`.
    template <class Done> bool until(Done done, uint64_t limitUs) {
        for (uint64_t end = now + limitUs; now < end; now += 1000) {
            deliver(a, b);
            deliver(b, a);
            a.poll();
            b.poll();
            if (done())
                return true;
        }
        return false;
    }
    void run(uint64_t us) {
        until([] { return false; }, us);
    }
    bool bothUp() { return a.isUp() && b.isUp(); }
    bool connect() {
        a.start();
        return until([this] { return bothUp(); }, 30'000'000);
    }

    // time, us; starts near its end, so that the 32-bit time wraps in every test
    uint64_t now = 0xFFFF0000u;
    Side a, b;

private:
    void deliver(Side& from, Side& to) {
        while (!from.air.empty() && from.air.front().arrives <= now) {
            const Bytes bytes = from.air.front().bytes;
            from.air.pop_front();
            to.receive(bytes);
        }
    }
};
