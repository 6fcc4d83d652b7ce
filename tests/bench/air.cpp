// SPDX-License-Identifier: MIT
//
// air: the radio link over two modems and the air between them, without chip and kernel: goodput
// one way and both ways at once, round trips, in the clear and encrypted (docs/link.md). Both ends
// are as the ground's: link layer, pacer, serial line of 111,111 baud.

#include "figures.h"
#include "frame_pacer.h"
#include "rf_channel.h"
#include "timed_line.h"
#include <array>
#include <cstdio>

extern "C" {
#include "link.h"
}

namespace {

constexpr U32 byteTimeUs16 = 1440;
unsigned leastExponent = 2; // RN, as controller and ground set it
const char* const key = "0123456789ABCDEF0123456789ABCDEF";

// Who encrypts: nobody, the modems, or the link layer with a key (docs/link.md).
enum Mode { Clear, Encrypted, Keyed };
const char* const columns[] = {"clear    ", "encrypted", "keyed    "};
const char* const names[] = {"in the clear", "encrypted", "with a key"};

class End {
public:
    End(RfChannel& air, unsigned address, Mode mode, uint64_t seed)
        : modem_(line_, air, options(address, mode)),
          pacer_(90, mode == Encrypted ? LINK_MAX_ENCRYPTED : LINK_MAX_FRAME), random_(seed) {
        static const Link_Port port = {
            [](void* c, const U8* f, U32 n) { return self(c).transmit(f, n); },
            [](void* c) { return self(c).random_.next(); },
            [](void* c, int channel, const U8*, U32 n) { return self(c).onMessage(channel, n); },
            [](void*, int, int) {},
            [](void*, Link_State) {},
            nullptr,
            nullptr};
        Link_init(link(), &port, this, byteTimeUs16);
        if (mode == Keyed)
            Link_setKey(link(), 0, reinterpret_cast<const U8*>(key));
        if (mode == Encrypted)
            Link_limitFrame(link(), LINK_MAX_ENCRYPTED);
    }
    Link* link() { return link_.get(); }
    const Link_Statistics& statistics() const { return *Link_statistics(link_.get()); }
    bool isUp() const { return Link_state(link_.get()) == LINK_STATE_UP; }
    const XBee& modem() const { return modem_; }

    // Returns when it wants to be called again.
    uint64_t advance(uint64_t now) {
        now_ = now;
        modem_.advance(now);
        write();
        if (now >= nextPoll_ || !line_.received.empty()) {
            U32 us = static_cast<U32>(now / 1000);
            Link_receive(link(), line_.received.data(), static_cast<U32>(line_.received.size()),
                         us);
            line_.received.clear();
            Link_poll(link(), us);
            nextPoll_ = now + std::min<uint64_t>(Link_deadline(link(), us), 1000) * 1000 + 100'000;
        }
        return std::min({modem_.nextEvent(), nextPoll_, nextWrite_});
    }
    U32 echoSize = 0, messages = 0;
    uint64_t bytes = 0, lastAt = 0;

private:
    static End& self(void* c) { return *static_cast<End*>(c); }
    static XBee::Options options(unsigned address, Mode mode) {
        XBee::Options o;
        o.set = {{"BD", 7},
                 {"MY", address},
                 {"DL", 1 - address},
                 {"D7", 1},
                 {"EE", mode == Encrypted ? 1u : 0u},
                 {"RN", leastExponent}};
        if (mode == Encrypted)
            o.key = key;
        return o;
    }
    int transmit(const U8* frame, U32 size) {
        if (!pacer_.offer(frame, size, static_cast<U32>(now_ / 1000)))
            return 1;
        write();
        return 0;
    }
    void write() {
        U32 us = static_cast<U32>(now_ / 1000);
        std::vector<U8> frame = pacer_.due(us);
        line_.send(frame.data(), frame.size(), now_);
        U32 wait = pacer_.deadline(us);
        nextWrite_ = wait == 0xFFFFFFFFu ? never : now_ + wait * 1000ull;
    }
    int onMessage(int channel, U32 size) {
        static const U8 answer[LINK_MAX_PAYLOAD] = {1};
        ++messages;
        bytes += size;
        lastAt = now_;
        if (echoSize)
            Link_send(link(), channel, answer, echoSize, 0);
        return 0;
    }
    TimedLine line_;
    XBee modem_;
    XBeeAT::FramePacer pacer_;
    Random random_;
    std::unique_ptr<Link> link_{new Link};
    uint64_t now_ = 0, nextPoll_ = 0, nextWrite_ = never;
};

class World {
public:
    World(const RfWeather& weather, Mode mode, uint64_t seed = testSeed())
        : air(seed), a(air, 0, mode, seed + 1), b(air, 1, mode, seed + 2) {
        air.weather = weather;
        Link_start(a.link(), 0);
        until([&] { return a.isUp() && b.isUp(); }, 60);
        Link_openChannel(a.link(), 0);
        until([&] { return Link_openChannel(b.link(), 0) == LINK_OK; }, 60);
        const uint64_t rest = now + 500'000'000;
        until([&] { return now >= rest; }, 10);
    }
    template <class Done> void until(Done done, double limitSeconds) {
        for (const uint64_t end = now + static_cast<uint64_t>(limitSeconds * 1e9); !done();) {
            if (now > end)
                throw std::runtime_error("not done in time");
            air.advance(now);
            const uint64_t next = std::min(a.advance(now), b.advance(now));
            now = std::max(now + 1, std::min(next, air.nextEvent()));
        }
    }
    uint64_t now = 0;
    RfChannel air;
    End a, b;
};

Figures figures("The radio link on a half-duplex air with the modems' own limits.");

// Bytes a second that come to the second and to the first modem, in so many seconds.
std::array<double, 2> flow(World& w, bool both, uint64_t seconds) {
    const std::vector<U8> message(LINK_MAX_MESSAGE / 4, 1);
    const uint64_t start = w.now;
    auto feed = [&](End& end) {
        while (Link_send(end.link(), 0, message.data(), static_cast<U32>(message.size()), 0) ==
               LINK_OK)
            ;
    };
    w.until(
        [&] {
            feed(w.a);
            if (both)
                feed(w.b);
            return w.now >= start + seconds * 1'000'000'000;
        },
        1e9);
    std::array<double, 2> rate = {0, 0};
    for (const End* to : {&w.b, &w.a})
        if (to->lastAt > start)
            rate[to == &w.a] =
                static_cast<double>(to->bytes) * 1e9 / static_cast<double>(to->lastAt - start);
    return rate;
}

// The mean over some seeds: single runs differ by a tenth.
void goodput(double loss, Mode mode, bool both) {
    RfWeather weather;
    weather.loss = loss;
    const unsigned runs = figures.brief ? 1 : 9;
    double rate[2] = {0, 0}, least = 1e9, most = 0;
    for (unsigned run = 0; run < runs; ++run) {
        World w(weather, mode, testSeed() + 10 * run);
        const auto one = flow(w, both, figures.brief ? 1 : 20);
        for (int i = 0; i < 2; ++i)
            rate[i] += one[i] / runs;
        least = std::min(least, one[0] + one[1]);
        most = std::max(most, one[0] + one[1]);
    }
    const double limit = mode == Encrypted ? 47000.0 / 8 : 10000;
    const double all = rate[0] + rate[1];
    std::printf("%s, %s, %2.0f %% lost: %5.0f + %5.0f bytes/s, %.1f %% of %.0f (%.1f to %.1f)\n",
                columns[mode], both ? "both ways" : "one way  ", loss * 100, rate[0], rate[1],
                all / limit * 100, limit, least / limit * 100, most / limit * 100);
    char name[80];
    std::snprintf(name, sizeof name, "goodput %s %s, loss %.2f", both ? "both ways" : "one way",
                  names[mode], loss);
    figures.add(name, all, "bytes/s", limit);
}

void roundTrips(Mode mode) {
    World w(RfWeather(), mode);
    for (U32 size : {1u, 20u, 94u - (mode == Encrypted ? 5u : mode == Keyed ? 6u : 0u)}) {
        std::vector<double> times;
        w.b.echoSize = size;
        const std::vector<U8> message(size, 1);
        for (int i = 0; i < (figures.brief ? 1 : 31); ++i) {
            U32 before = w.a.messages;
            uint64_t start = w.now;
            Link_send(w.a.link(), 0, message.data(), size, 0);
            w.until([&] { return w.a.messages > before; }, 5);
            times.push_back(static_cast<double>(w.a.lastAt - start) / 1e6);
            uint64_t rest = w.now + 160'000'000 + static_cast<uint64_t>(i) * 330'000;
            w.until([&] { return w.now >= rest; }, 5);
        }
        std::sort(times.begin(), times.end());
        std::printf("%s: round trip of %2u bytes: median %.1f ms, longest %.1f\n", columns[mode],
                    size, times[times.size() / 2], times.back());
        figures.add("round trip of " + std::to_string(size) + " bytes " + names[mode],
                    times[times.size() / 2], "ms");
    }
}

} // namespace

int main(int argc, char** argv) {
    figures.app.add_option("--rn", leastExponent, "RN of both modems")->check(CLI::Range(0u, 3u));
    return figures.run(argc, argv, [&] {
        for (Mode mode : {Clear, Encrypted, Keyed}) {
            for (bool both : {false, true})
                for (double loss : {0.0, 0.01, 0.1, 0.3})
                    if (!figures.brief || loss == 0.1)
                        goodput(loss, mode, both);
            roundTrips(mode);
        }
    });
}
