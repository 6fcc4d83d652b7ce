// SPDX-License-Identifier: MIT
//
// variant: link layers compiled with different options, each loaded from a library of its own, and
// a radio between two of them that loses, doubles and spoils packets.

#ifndef LINK_VARIANT_H
#define LINK_VARIANT_H

#include "random.h"
#include <deque>
#include <dlfcn.h>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

extern "C" {
#include "link.h"
}

using Bytes = std::vector<uint8_t>;

// A variant's functions, and a Link of its size.
class Peer {
public:
    Peer(const std::string& variant, uint64_t seed, const Bytes& key = {})
        : random_(seed), key_(key) {
        std::string path = VARIANTS + variant + ".so";
        library_ = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
        if (!library_)
            throw std::runtime_error(dlerror());
        load(init, "Link_init");
        load(start, "Link_start");
        load(stop, "Link_stop");
        load(poll, "Link_poll");
        load(deadline, "Link_deadline");
        load(receive, "Link_receive");
        load(statistics, "Link_statistics");
        if (!key.empty())
            load(setKey, "Link_setKey");
        load(send_, "Link_send");
        load(open_, "Link_openChannel");
        load(close_, "Link_closeChannel");
        load(state, "Link_state");
        load(size, "LinkVariant_size");
        load(maxMessage, "LinkVariant_maxMessage");
        memory_.resize(size() / sizeof(uint64_t) + 1);
        boot();
    }
    ~Peer() { dlclose(library_); }
    Peer(const Peer&) = delete;
    Peer& operator=(const Peer&) = delete;

    // Forgets everything, like a reboot after a power cut.
    void boot() {
        static const Link_Port port = {
            [](void* c, const U8* f, U32 n) { return static_cast<Peer*>(c)->transmit(f, n); },
            [](void* c) { return static_cast<Peer*>(c)->random_.next(); },
            [](void* c, int channel, const U8* d, U32 n) {
                auto* self = static_cast<Peer*>(c);
                if (!self->refuse)
                    self->received.emplace_back(channel, Bytes(d, d + n));
                return self->refuse ? 1 : 0;
            },
            [](void* c, int channel, int isOpen) {
                static_cast<Peer*>(c)->events.push_back((isOpen ? "open " : "close ") +
                                                        std::to_string(channel));
            },
            [](void* c, Link_State s) {
                static_cast<Peer*>(c)->events.push_back(s == LINK_STATE_UP ? "up" : "down");
            },
            [](void* c, int, U32 tag, Link_Outcome o) {
                if (!static_cast<Peer*>(c)->outcomes.emplace(tag, o).second)
                    throw std::logic_error("two outcomes for message " + std::to_string(tag));
            },
            nullptr};
        init(link(), &port, this, 1440);
        if (!key_.empty())
            setKey(link(), 0, key_.data());
        air.clear();
    }
    Link* link() { return reinterpret_cast<Link*>(memory_.data()); }
    bool isUp() { return state(link()) == LINK_STATE_UP; }
    U32 us() const { return static_cast<U32>(now); }
    Link_Status send(int channel, const Bytes& m, U32 tag) {
        return send_(link(), channel, m.data(), static_cast<U32>(m.size()), tag);
    }
    Link_Status open(int channel) { return open_(link(), channel); }
    Link_Status close(int channel) { return close_(link(), channel); }

    decltype(&Link_init) init;
    decltype(&Link_start) start;
    decltype(&Link_stop) stop;
    decltype(&Link_poll) poll;
    decltype(&Link_deadline) deadline;
    decltype(&Link_receive) receive;
    decltype(&Link_state) state;
    decltype(&Link_statistics) statistics;
    decltype(&Link_setKey) setKey;
    U32 (*size)();
    U32 (*maxMessage)();
    std::deque<std::pair<uint64_t, Bytes>> air; // to the other side, with the time of arrival
    std::vector<std::pair<int, Bytes>> received;
    std::map<U32, Link_Outcome> outcomes;
    std::vector<std::string> events;
    bool refuse = false; // the program takes no message
    double loss = 0, duplication = 0, corruption = 0;
    uint64_t now = 0, free = 0;
    uint64_t sent = 0; // bytes
    unsigned lost = 0; // packets

private:
    template <class F> void load(F& f, const char* name) {
        f = reinterpret_cast<F>(dlsym(library_, name));
        if (!f)
            throw std::runtime_error(name);
    }
    // One serial port of 11.1 kB/s, then the air; the modem and its ring hold 30 ms.
    int transmit(const U8* frame, U32 bytes) {
        if (free > now + 30000)
            return 1;
        free = std::max(free, now) + bytes * 90;
        sent += bytes;
        if (random_.chance(loss)) {
            ++lost;
            return 0;
        }
        Bytes packet(frame, frame + bytes);
        if (random_.chance(corruption))
            packet[random_.below(bytes)] ^= static_cast<uint8_t>(1 + random_.below(255));
        for (int copies = random_.chance(duplication) ? 2 : 1; copies > 0; --copies)
            air.emplace_back(free + 8000, packet);
        return 0;
    }
    decltype(&Link_send) send_;
    decltype(&Link_openChannel) open_;
    decltype(&Link_closeChannel) close_;
    Random random_;
    void* library_;
    const Bytes key_;
    std::vector<uint64_t> memory_;
};

// Two peers and the time, in steps of the firmware's tick.
class Radio {
public:
    Radio(const std::string& a, const std::string& b, uint64_t seed, const Bytes& key = {})
        : a_(a, seed * 2, key), b_(b, seed * 2 + 1, key) {}

protected:
    template <class Done> bool until(Done done, uint64_t limitUs) {
        for (uint64_t end = now_ + limitUs; now_ < end; now_ += 1000) {
            a_.now = b_.now = now_;
            for (auto [from, to] : {std::pair(&a_, &b_), std::pair(&b_, &a_)}) {
                while (!from->air.empty() && from->air.front().first <= now_) {
                    Bytes bytes = from->air.front().second;
                    from->air.pop_front();
                    to->receive(to->link(), bytes.data(), static_cast<U32>(bytes.size()), us());
                }
                to->poll(to->link(), us());
            }
            if (done())
                return true;
        }
        return false;
    }
    void run(uint64_t forUs) {
        until([] { return false; }, forUs);
    }
    bool bothUp() { return a_.isUp() && b_.isUp(); }
    bool connect() {
        a_.start(a_.link(), us());
        return until([this] { return bothUp(); }, 30'000'000);
    }
    void setWeather(double loss, double duplication, double corruption) {
        for (Peer* p : {&a_, &b_}) {
            p->loss = loss;
            p->duplication = duplication;
            p->corruption = corruption;
        }
    }
    U32 us() const { return static_cast<U32>(now_); }
    Peer a_, b_;
    uint64_t now_ = 0xFFFF0000; // so that the 32-bit time wraps in every test
};

// The frames in a packet.
inline std::vector<Bytes> framesOf(const Bytes& packet) {
    std::vector<Bytes> frames;
    for (size_t at = 0; at < packet.size();) {
        size_t size = LINK_LENGTH(&packet[at]) + LINK_OVERHEAD;
        frames.emplace_back(packet.begin() + static_cast<long>(at),
                            packet.begin() + static_cast<long>(std::min(at + size, packet.size())));
        at += size;
    }
    return frames;
}

#endif
