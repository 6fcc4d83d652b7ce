// SPDX-License-Identifier: MIT
//
// modem_pair: simulates link layers over modem models and the air between them, event by event.
// Each end has a modem, a serial line, and one link layer for each peer, like the engine on the
// ground. The lines have 111,111 baud, unless the options of a modem set another rate.

#pragma once

#include "../support/link_end.h"
#include "api_modem.h"
#include "rf_channel.h"
#include "serial_line.h"
#include "xbee.h"
#include <algorithm>
#include <deque>
#include <memory>
#include <stdexcept>

extern "C" {
#include "link.h"
}

// A serial line to a modem. Each byte takes the same time as on a wire, and the line obeys CTS.
class TimedLine : public SerialLine {
public:
    void send(const uint8_t* bytes, size_t count, uint64_t now) {
        if (out_.empty())
            outFree_ = std::max(outFree_, static_cast<double>(now));
        out_.insert(out_.end(), bytes, bytes + count);
    }
    size_t waiting() const { return out_.size(); }
    void forget() { // Discards all bytes in transit, as when the host restarts.
        out_.clear();
        received.clear();
    }
    std::vector<uint8_t> received;
    bool hangs = false; // true: the host hangs, so nothing is transferred

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

// Returns the settings of modem 0 or 1; the modems send to each other. RN is `leastExponent`. In
// API mode, ModemEnd changes RN.
inline XBee::Options modemOptions(unsigned address, bool encrypts = false,
                                  unsigned leastExponent = 2, bool isApi = false) {
    XBee::Options o;
    o.set = {{"BD", 7},        {"MY", address},       {"DL", 1 - address}, {"D7", 1},
             {"EE", encrypts}, {"RN", leastExponent}, {"AP", isApi}};
    return o;
}

// One side: a modem and its links, one for each peer. As in the engine, the link that has used the
// least air time sends first. A derived class handles the messages, and calls Link_setKey and
// Link_start.
class ModemEnd {
public:
    // `targets`: addresses of the peers; if it is empty, the only peer is the address in the
    // modem's DL.
    ModemEnd(RfChannel& air, const XBee::Options& options, uint64_t seed,
             std::vector<int> targets = {})
        : modem(line, air, options), encrypts_(options.set.at("EE") != 0),
          mostWaiting_(options.set.at("BD") > 7 ? 2 : 3), random_(seed) {
        if (targets.empty())
            targets.push_back(static_cast<int>(modem.parameter("DL")));
        for (int target : targets)
            peers_.push_back(std::make_unique<Target>(*this, peers_.size(), target));
        for (auto& p : peers_)
            order_.push_back(p.get());
        begin();
    }
    virtual ~ModemEnd() = default;
    ModemEnd(const ModemEnd&) = delete;
    ModemEnd& operator=(const ModemEnd&) = delete;
    // Handles a message from the peer with index `peer` in `targets`. Returns 0 if the message is
    // accepted.
    virtual int onMessage(size_t peer, int channel, const U8* message, U32 size) = 0;
    virtual void onOutcome(size_t, U32, Link_Outcome) {}

    // Begins without earlier state, like a program that has just been started.
    void begin() {
        if (modem.parameter("AP"))
            api_ = std::make_unique<XBeeAT::ApiModem>(modem.parameter("AP") == 2);
        line.forget();
        for (auto& p : peers_) {
            p->begin();
            if (encrypts_)
                Link_limitFrame(p->link(), LINK_MAX_ENCRYPTED);
            Link_shareRadio(p->link(), link());
            Link_expectAnswers(p->link(), api_ ? mostWaiting_ : 0);
        }
    }
    size_t peers() const { return peers_.size(); }
    int target(size_t peer) const { return peers_[peer]->target; }
    Link* link(size_t peer = 0) const { return peers_[peer]->link(); }
    const Link_Statistics& statistics(size_t peer = 0) const {
        return *Link_statistics(link(peer));
    }
    bool isUp(size_t peer = 0) const { return Link_state(link(peer)) == LINK_STATE_UP; }
    bool areUp() const {
        return std::all_of(peers_.begin(), peers_.end(),
                           [this](const auto& p) { return isUp(p->number); });
    }
    // Advances this end to `now`. Returns the time at which this function must be called again.
    uint64_t advance(uint64_t now) {
        now_ = now;
        modem.advance(now);
        if (now >= nextPoll_ || !line.received.empty()) {
            const U32 us = this->us();
            receive(us);
            U32 wait = longestRestUs;
            std::sort(order_.begin(), order_.end(),
                      [](const Target* a, const Target* b) { return a->airUs < b->airUs; });
            for (Target* p : order_) {
                Link_poll(p->link(), us);
                wait = std::min(wait, Link_deadline(p->link(), us));
            }
            nextPoll_ = now + wait * 1000ull + 100'000;
        }
        return std::min(modem.nextEvent(), nextPoll_);
    }
    TimedLine line;
    XBee modem;
    U32 longestRestUs = 1000; // longest time between two polls, us

protected:
    U32 us() const { return static_cast<U32>(now_ / 1000); }
    uint64_t now_ = 0;

private:
    struct Target : LinkEnd { // The link to one peer.
        Target(ModemEnd& e, size_t n, int t) : end(e), number(n), target(t) {}
        using LinkEnd::begin;
        bool transmit(const U8* frame, U32 size) override {
            return end.transmit(*this, frame, size) == 0;
        }
        U32 random() override { return end.random_.next(); }
        bool take(int channel, const U8* message, U32 size) override {
            return end.onMessage(number, channel, message, size) == 0;
        }
        void onOutcome(int, U32 tag, Link_Outcome outcome) override {
            end.onOutcome(number, tag, outcome);
        }
        ModemEnd& end;
        const size_t number;
        const int target;
        uint64_t airUs = 0;
    };
    void receive(U32 us) {
        const auto take = [&](int source, const U8* data, size_t count) {
            for (auto& p : peers_)
                if (p->target == source)
                    Link_receive(p->link(), data, static_cast<U32>(count), us);
        };
        if (!api_) {
            take(peers_[0]->target, line.received.data(), line.received.size());
        } else {
            api_->expire(us, [&] { Link_answer(link(), 0, us); });
            api_->feed(line.received.data(), line.received.size(), take,
                       [&](bool isThere) { Link_answer(link(), isThere, us); });
        }
        line.received.clear();
    }
    int transmit(Target& peer, const U8* frame, U32 size) {
        U32 rn = Link_randomWait(peer.link());
        for (size_t i = 0; i < peers(); ++i)
            if (isUp(i))
                rn = std::max(rn, Link_randomWait(link(i)));
        if (!api_ && line.waiting())
            return 1;
        const auto bytes = api_ ? api_->packet(peer.target, frame, size, rn, us())
                                : std::vector<uint8_t>(frame, frame + size);
        line.send(bytes.data(), bytes.size(), now_);
        peer.airUs = std::max(peer.airUs, airUs_);
        airUs_ = peer.airUs;
        peer.airUs += LINK_PACKET_US + size * LINK_BYTE_US;
        return 0;
    }
    const bool encrypts_;
    const unsigned mostWaiting_;
    std::unique_ptr<XBeeAT::ApiModem> api_; // null in transparent mode
    std::vector<std::unique_ptr<Target>> peers_;
    std::vector<Target*> order_;
    Random random_;
    uint64_t nextPoll_ = 0, airUs_ = 0;
};

// Advances time until `done` returns true or time reaches `end`. Returns the last result of `done`.
template <class Ends, class Done>
bool passUntil(uint64_t& now, uint64_t end, RfChannel& air, Ends& ends, Done done) {
    while (!done()) {
        if (now > end)
            return false;
        air.advance(now);
        uint64_t next = never;
        for (auto& e : ends)
            next = std::min(next, e.advance(now));
        now = std::max(now + 1, std::min(next, air.nextEvent()));
    }
    return true;
}

// Two ends, and the air between them. End is a class that is derived from ModemEnd. The constructor
// starts the first end's link, and returns when both links are up and channels 0 to `channels` - 1
// are open.
template <class End> class ModemPair {
public:
    template <class... Arguments>
    ModemPair(const RfWeather& weather, uint64_t seed, int channels, const Arguments&... arguments)
        : air(seed), ends_{{air, 0, seed + 1, arguments...}, {air, 1, seed + 2, arguments...}} {
        air.weather = weather;
        Link_start(a.link(), 0);
        need([&] { return a.isUp() && b.isUp(); });
        for (int channel = 0; channel < channels; ++channel) {
            Link_openChannel(a.link(), channel);
            need([&] { return Link_openChannel(b.link(), channel) == LINK_OK; });
        }
        pass(500'000'000);
    }
    // Advances time until `done` returns true. Returns false if this takes longer than `seconds`.
    template <class Done> bool until(Done done, double seconds) {
        return passUntil(now, now + static_cast<uint64_t>(seconds * 1e9), air, ends_, done);
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

private:
    End ends_[2];

public:
    End &a = ends_[0], &b = ends_[1];
};

// Two modems with serial lines of 111,111 baud, and the air, without any link layer. Their
// throughput is the upper limit for a link. `rate` is the second modem's parameter BD.
struct BareModems {
    struct End {
        End(RfChannel& channel, const XBee::Options& options) : modem(line, channel, options) {}
        TimedLine line;
        XBee modem;
    };
    BareModems(const RfWeather& weather, uint64_t seed, bool encrypts, unsigned leastExponent,
               unsigned rate = 7)
        : air(seed), a(air, modemOptions(0, encrypts, leastExponent)),
          b(air, options(encrypts, leastExponent, rate)) {
        air.weather = weather;
    }
    static XBee::Options options(bool encrypts, unsigned leastExponent, unsigned rate) {
        XBee::Options o = modemOptions(1, encrypts, leastExponent);
        o.set["BD"] = rate;
        return o;
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

// Returns the lower limit of a round trip on half-duplex air (formula in docs/link.md), in ms: the
// median of many simulated trips. One modem sends `out` bytes; when the last of them has arrived,
// the other modem returns `back` bytes. Each of the two messages must fit into one packet. RN is 2.
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

// Returns the lower limit of a call during a stream, in ms: the median of many simulated calls. The
// second modem always sends full packets; each packet is complete in the modem just before the
// modem needs it. The first modem sends `out` bytes. The next packet after their arrival begins
// with the reply, `back` bytes. A lost packet is sent again at once. RN is 2, and the second
// modem's line has 250,000 baud.
inline double floorDuringStreamMs(size_t out, size_t back, const RfWeather& weather,
                                  bool isEncrypted) {
    BareModems w(weather, 1, isEncrypted, 2, 250'000);
    const size_t packet = isEncrypted ? LINK_MAX_ENCRYPTED : LINK_MAX_FRAME;
    const std::vector<uint8_t> call(out, 1);
    // `isDue`: the call has arrived, its reply has not; `isSent`: the current packet has the reply
    bool isDue = false, isSent = false;
    const auto sendPacket = [&](uint64_t now) {
        std::vector<uint8_t> bytes(packet, 0);
        std::fill_n(bytes.begin(), isDue ? back : 0, 1);
        isSent = isDue;
        w.b.line.send(bytes.data(), packet, now - packet * 40'000);
    };
    w.air.onPacket([&](uint64_t now, const RfPacket& sent, RfChannel::Outcome outcome) {
        const bool isThere = outcome == RfChannel::Outcome::Delivered;
        if (sent.from == 1) {
            isDue = isDue && !(isSent && isThere);
            sendPacket(now);
        } else if (!isThere) {
            w.a.line.send(call.data(), out, now - out * 90'000);
        }
    });
    const auto arrived = [](const TimedLine& line) {
        return static_cast<size_t>(std::count(line.received.begin(), line.received.end(), 1));
    };
    std::vector<double> times;
    w.now += 10'000'000;
    w.step(); // ends the boot of the modems
    sendPacket(w.now);
    for (uint64_t i = 0; i < 201; ++i) {
        const uint64_t start = w.now;
        bool isCalled = true;
        w.a.line.received.clear();
        w.b.line.received.clear();
        w.a.line.send(call.data(), out, w.now);
        for (; isCalled || w.now < start + 200'000'000 + i * 330'000; w.next()) {
            w.step();
            if (arrived(w.b.line) == out) {
                isDue = true;
                w.b.line.received.clear();
            }
            if (isCalled && arrived(w.a.line) == back) {
                isCalled = false;
                times.push_back(static_cast<double>(w.now - start) / 1e6);
            }
        }
    }
    std::sort(times.begin(), times.end());
    return times[times.size() / 2];
}

// Returns the largest number of bytes per second that two modems can transfer under these radio
// conditions, in one direction or in both. A full packet is always ready, and a lost packet costs
// only its air time, as if the sender noticed the loss immediately.
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
