// SPDX-License-Identifier: MIT
//
// modem_pair: two link layers over two modem models and the air between them, from event to event.
// Both ends are as the ground's: link layer, pacer, serial line of 111,111 baud.

#pragma once

#include "api_modem.h"
#include "frame_pacer.h"
#include "rf_channel.h"
#include "serial_line.h"
#include <algorithm>
#include <deque>
#include <stdexcept>

extern "C" {
#include "link.h"
}

// A serial line to a modem that takes a wire's time for each byte, and heeds CTS.
class TimedLine : public SerialLine {
public:
    void send(const uint8_t* bytes, size_t count, uint64_t now) {
        if (out_.empty())
            outFree_ = std::max(outFree_, static_cast<double>(now));
        out_.insert(out_.end(), bytes, bytes + count);
    }
    size_t waiting() const { return out_.size(); }
    std::vector<uint8_t> received;
    bool hangs = false; // its host: nothing moves

    void advance(uint64_t now) override {
        if (hangs)
            return;
        const double byteNs = 10 * bitNs_, time = static_cast<double>(now);
        while (!out_.empty() && cts_ && outFree_ + byteNs <= time) {
            outFree_ += byteNs;
            client_->fromHost(out_.front(), now);
            out_.pop_front();
        }
        if (!out_.empty() && !cts_)
            outFree_ = std::max(outFree_, time);
        while (busy_ && inDone_ <= time) {
            received.push_back(byte_);
            busy_ = client_->nextToHost(byte_);
            inDone_ += byteNs;
        }
    }
    uint64_t nextEvent() const override {
        if (hangs)
            return never;
        double at = busy_ ? inDone_ : 1e300;
        if (!out_.empty())
            at = std::min(at, outFree_ + 10 * bitNs_);
        return at > 1e299 ? never : static_cast<uint64_t>(at) + 1;
    }
    void wake(uint64_t now) override {
        if (busy_ || !client_->nextToHost(byte_))
            return;
        busy_ = true;
        inDone_ = static_cast<double>(now) + 10 * bitNs_;
    }

private:
    std::deque<uint8_t> out_;
    double outFree_ = 0, inDone_ = 0;
    bool busy_ = false;
    uint8_t byte_ = 0;
};

// The settings of modem 0 or 1, which talks to the other; RN is `leastExponent`, unless the modem
// is in API mode, where the end changes it.
inline XBee::Options modemOptions(unsigned address, bool encrypts = false,
                                  unsigned leastExponent = 2, bool isApi = false) {
    XBee::Options o;
    o.set = {{"BD", 7},        {"MY", address},       {"DL", 1 - address}, {"D7", 1},
             {"EE", encrypts}, {"RN", leastExponent}, {"AP", isApi}};
    return o;
}

// One end. A derived class handles the messages; it calls Link_setKey before time passes, if at
// all.
class ModemEnd {
public:
    ModemEnd(RfChannel& air, const XBee::Options& options, uint64_t seed)
        : modem(line, air, options), target_(static_cast<int>(modem.parameter("DL"))),
          random_(seed) {
        if (modem.parameter("AP"))
            packets_ = std::make_unique<XBeeAT::ApiModem>(modem.parameter("AP") == 2);
        else
            packets_ = std::make_unique<XBeeAT::FramePacer>(
                target_, 90, options.set.at("EE") ? LINK_MAX_ENCRYPTED : LINK_MAX_FRAME, 0);
        static const Link_Port port = {
            [](void* c, const U8* f, U32 n) { return self(c).transmit(f, n); },
            [](void* c) { return self(c).random_.next(); },
            [](void* c, int channel, const U8* m, U32 n) {
                self(c).onMessage(channel, m, n);
                return 0;
            },
            [](void*, int, int) {},
            [](void*, Link_State) {},
            nullptr,
            nullptr};
        Link_init(link(), &port, this, 1440);
        if (options.set.at("EE"))
            Link_limitFrame(link(), LINK_MAX_ENCRYPTED);
        Link_expectAnswers(link(), !packets_->answers() ? 0 : options.set.at("BD") > 7 ? 2 : 3);
    }
    virtual ~ModemEnd() = default;
    ModemEnd(const ModemEnd&) = delete;
    ModemEnd& operator=(const ModemEnd&) = delete;
    virtual void onMessage(int channel, const U8* message, U32 size) = 0;

    Link* link() { return link_.get(); }
    const Link_Statistics& statistics() const { return *Link_statistics(link_.get()); }
    bool isUp() const { return Link_state(link_.get()) == LINK_STATE_UP; }
    // Returns the time of its next call.
    uint64_t advance(uint64_t now) {
        now_ = now;
        modem.advance(now);
        write();
        if (now >= nextPoll_ || !line.received.empty()) {
            const U32 us = static_cast<U32>(now / 1000);
            receive(us);
            Link_poll(link(), us);
            nextPoll_ =
                now + std::min(Link_deadline(link(), us), longestRestUs) * 1000ull + 100'000;
        }
        return std::min({modem.nextEvent(), nextPoll_, nextWrite_});
    }
    TimedLine line;
    XBee modem;
    U32 longestRestUs = 1000; // between two polls

protected:
    uint64_t now_ = 0;

private:
    static ModemEnd& self(void* c) { return *static_cast<ModemEnd*>(c); }
    void receive(U32 us) {
        const auto answer = [&](int, bool isThere) { Link_answer(link(), isThere, us); };
        packets_->expire(us, answer);
        packets_->feed(
            line.received.data(), line.received.size(),
            [&](int source, const U8* data, size_t count) {
                if (source == target_)
                    Link_receive(link(), data, static_cast<U32>(count), us);
            },
            answer);
        line.received.clear();
    }
    int transmit(const U8* frame, U32 size) {
        if (!packets_->offer(target_, frame, size, Link_randomWait(link()), line.waiting(),
                             static_cast<U32>(now_ / 1000)))
            return 1;
        write();
        return 0;
    }
    void write() {
        const U32 us = static_cast<U32>(now_ / 1000);
        const auto frame = packets_->due(us);
        line.send(frame.data(), frame.size(), now_);
        const U32 wait = packets_->deadline(us);
        nextWrite_ = wait == 0xFFFFFFFFu ? never : now_ + wait * 1000ull;
    }
    const int target_;
    std::unique_ptr<XBeeAT::PacketLine> packets_;
    std::unique_ptr<Link> link_{new Link};
    Random random_;
    uint64_t nextPoll_ = 0, nextWrite_ = never;
};

// Two ends of a class derived from ModemEnd, and the air; the first has called, and both are up
// with the channels 0 to `channels` - 1 open.
template <class End> class ModemPair {
public:
    template <class... Arguments>
    ModemPair(const RfWeather& weather, uint64_t seed, int channels, const Arguments&... arguments)
        : air(seed), a(air, 0, seed + 1, arguments...), b(air, 1, seed + 2, arguments...) {
        air.weather = weather;
        Link_start(a.link(), 0);
        need([&] { return a.isUp() && b.isUp(); });
        for (int channel = 0; channel < channels; ++channel) {
            Link_openChannel(a.link(), channel);
            need([&] { return Link_openChannel(b.link(), channel) == LINK_OK; });
        }
        pass(500'000'000);
    }
    // Lets time pass until `done`. Returns whether that is within this many seconds.
    template <class Done> bool until(Done done, double seconds) {
        for (const uint64_t end = now + static_cast<uint64_t>(seconds * 1e9); !done();) {
            if (now > end)
                return false;
            air.advance(now);
            const uint64_t next = std::min(a.advance(now), b.advance(now));
            now = std::max(now + 1, std::min(next, air.nextEvent()));
        }
        return true;
    }
    template <class Done> void need(Done done) {
        if (!until(done, 60))
            throw std::runtime_error("not done in time");
    }
    void pass(uint64_t ns) {
        const uint64_t end = now + ns;
        until([&] { return now >= end; }, 1e9);
    }
    uint64_t now = 0;
    RfChannel air;
    End a, b;
};

// Two modems with their serial lines of 111,111 baud and the air, nothing else: what a link could
// reach at most.
struct BareModems {
    struct End {
        End(RfChannel& channel, const XBee::Options& options) : modem(line, channel, options) {}
        TimedLine line;
        XBee modem;
    };
    BareModems(const RfWeather& weather, uint64_t seed, bool encrypts, unsigned leastExponent)
        : air(seed), a(air, modemOptions(0, encrypts, leastExponent)),
          b(air, modemOptions(1, encrypts, leastExponent)) {
        air.weather = weather;
    }
    void step() {
        air.advance(now);
        a.modem.advance(now);
        b.modem.advance(now);
    }
    void next() {
        now = std::max(now + 1,
                       std::min({air.nextEvent(), a.modem.nextEvent(), b.modem.nextEvent()}));
    }
    RfChannel air;
    End a, b;
    uint64_t now = 1'000'000;
};

// The floor of a round trip on a half-duplex air, measured; docs/link.md has it as a formula.
// Returns the median in ms of `out` bytes there and, from the moment of the last one on, `back`
// bytes here; each at most a packet. RN is 2.
inline double floorMs(size_t out, size_t back, bool isEncrypted = false) {
    BareModems w(RfWeather(), 1, isEncrypted, 2);
    const std::vector<uint8_t> bytes(std::max(out, back), 1);
    std::vector<double> times;
    for (int i = 0; i < 201; ++i) {
        const uint64_t start = w.now;
        bool isBack = false;
        w.a.line.received.clear();
        w.b.line.received.clear();
        w.a.line.send(bytes.data(), out, w.now);
        for (;; w.next()) {
            w.step();
            if (w.a.line.received.size() == back)
                break;
            if (!isBack && w.b.line.received.size() == out) {
                isBack = true;
                w.b.line.send(bytes.data(), back, w.now);
            }
        }
        times.push_back(static_cast<double>(w.now - start) / 1e6);
        w.now += 160'000'000;
    }
    std::sort(times.begin(), times.end());
    return times[times.size() / 2];
}

// The most bytes a second that two modems bring over the air in this weather, one way or both ways
// together: full packets are always at hand, and a lost one costs its own time only, as with a
// sender that learns at once what was lost.
inline double mostBytesPerSecond(const RfWeather& weather, bool both, bool isEncrypted,
                                 unsigned leastExponent, uint64_t seconds, uint64_t seed) {
    BareModems w(weather, seed, isEncrypted, leastExponent);
    const size_t packet = isEncrypted ? LINK_MAX_ENCRYPTED : LINK_MAX_FRAME;
    uint64_t arrived = 0;
    w.air.onPacket([&](uint64_t, const RfPacket&, RfChannel::Outcome outcome) {
        arrived += outcome == RfChannel::Outcome::Delivered ? packet : 0;
    });
    const std::vector<uint8_t> bytes(packet, 1);
    for (const uint64_t start = w.now; w.now < start + seconds * 1'000'000'000; w.next()) {
        for (BareModems::End* end : {&w.a, &w.b}) {
            end->line.received.clear();
            if (!end->line.waiting() && (both || end == &w.a))
                end->line.send(bytes.data(), packet, w.now);
        }
        w.step();
    }
    return static_cast<double>(arrived) / static_cast<double>(seconds);
}
