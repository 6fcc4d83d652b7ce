// SPDX-License-Identifier: MIT
//
// link: the radio link's figures in simulated time: link layer and driver in the firmware's
// kernel, FSMC, RTL, UART, modems, air; on the ground the same link layer behind a serial line at
// 111,111 baud; in the clear and under a key. Beside each the physical limit (docs/link.md).

#include "figures.h"
#include "frame_pacer.h"
#include "modem_floor.h"
#include "rf_channel.h"
#include "timed_line.h"
#include "uav_machine.h"
#include <chrono>
#include <cstdio>

extern "C" {
#include "link.h"
#include "radio.h"
#include "ucos_ii.h"
}

namespace {

const char* const modes[] = {"in the clear", "with a key"}; // by hasKey

// The modem's own time for a packet, and the mean wait of RN 2 (docs/models.md); ms.
constexpr double modemMs = 4.688, waitMs = 1.5 * 0.320;
// The limit one way: full packets through the modem, which is slower than its serial port at
// 111,111 baud.
constexpr double mostBytesPerSecond = 100 / (modemMs + waitMs + 5.312) * 1000;

// One end's link: counts what arrives, and may echo it in another size.
class End {
public:
    End(std::function<int(const U8*, U32)> send, std::function<uint64_t()> clock, uint32_t seed)
        : send_(std::move(send)), clock_(std::move(clock)), random_(seed) {
        static const Link_Port port = {
            [](void* c, const U8* f, U32 n) { return self(c).send_(f, n); },
            [](void* c) { return self(c).random_.next(); },
            [](void* c, int channel, const U8*, U32 n) { return self(c).onMessage(channel, n); },
            [](void*, int, int) {},
            [](void*, Link_State) {},
            nullptr,
            nullptr};
        Link_init(link(), &port, this, 1440);
    }
    Link* link() { return link_.get(); }
    const Link_Statistics& statistics() const { return *Link_statistics(link_.get()); }
    bool isUp() const { return Link_state(link_.get()) == LINK_STATE_UP; }
    U32 echoSize = 0, messages = 0;
    uint64_t bytes = 0, lastAt = 0; // lastAt: ns, when the program got the last message

private:
    static End& self(void* c) { return *static_cast<End*>(c); }
    int onMessage(int channel, U32 size) {
        ++messages;
        bytes += size;
        lastAt = clock_();
        static const U8 answer[LINK_MAX_PAYLOAD] = {1};
        if (echoSize)
            Link_send(link(), channel, answer, echoSize, 0);
        return 0;
    }
    std::unique_ptr<Link> link_{new Link};
    std::function<int(const U8*, U32)> send_;
    std::function<uint64_t()> clock_;
    Random random_;
};

class World {
public:
    explicit World(double loss, unsigned guardMs, bool hasKey = false) : guardMs_(guardMs) {
        air_.weather.loss = loss;
        static const U8 key[LINK_KEY_BYTES] = {1, 2, 3};
        if (hasKey)
            for (End* end : {&near, &far})
                Link_setKey(end->link(), 0, key);
        soc_.onTime([this](uint64_t now) {
            ground_.advance(now);
            write(now);
            if (now >= nextPoll_ || !line_.received.empty()) {
                // Acts as the ground's engine: it wakes when bytes come or time is due.
                U32 us = static_cast<U32>(now / 1000);
                Link_receive(far.link(), line_.received.data(),
                             static_cast<U32>(line_.received.size()), us);
                line_.received.clear();
                Link_poll(far.link(), us);
                nextPoll_ =
                    now + std::min<uint64_t>(Link_deadline(far.link(), us), 1000) * 1000 + 100'000;
            }
            return std::min({ground_.nextEvent(), nextPoll_, nextWrite_});
        });
        soc_.reset();
    }
    // Runs `body` as the firmware's radio task, the modem set up.
    void run(std::function<void()> body) {
        static std::function<void()> task;
        static OS_STK stack[1024];
        task = [&] {
            const XBeeInitTypeDef conf = {XBEE_BD_115200, 1, 0, 0, 0, static_cast<U16>(guardMs_),
                                          nullptr};
            const Radio_Memory rings = {0, 0x1000};
            uint64_t start = soc_.now();
            if (xbeeInit(&conf, &rings) != RADIO_OK)
                throw std::runtime_error("the modem cannot be set up");
            setUpMs = static_cast<double>(soc_.now() - start) / 1e6;
            irqOn_ = true;
            work_ = OSSemCreate(0);
            body();
            OsHost::stop();
        };
        UavMachine::Firmware firmware;
        firmware.start = [](const FSMC_Port* port, void* context) {
            if (FSMC_init(port, context) != FSMC_OK)
                throw std::runtime_error("no FPGA");
            OSTaskCreate([](void*) { task(); }, nullptr, &stack[1023], 5);
        };
        firmware.irqHandler = [this] {
            Radio_interrupt();
            OSSemPost(work_);
        };
        firmware.irqEnabled = [this] { return irqOn_; };
        UavMachine machine(
            soc_, [] { return true; }, firmware);
        machine.run();
    }
    // One turn of the radio task, as in sw/apps/uav.
    void turn() {
        INT8U error;
        Radio_receive([](void* c, const U8* bytes,
                         U32 size) { Link_receive(static_cast<Link*>(c), bytes, size, us()); },
                      near.link());
        Link_poll(near.link(), us());
        U32 ticks = Link_deadline(near.link(), us()) / (1000000U / OS_TICKS_PER_SEC);
        OSSemPend(work_, std::max<U32>(1, std::min<U32>(ticks, 5)), &error);
    }
    template <class F> void until(F done, double limitSeconds) {
        for (uint64_t end = soc_.now() + static_cast<uint64_t>(limitSeconds * 1e9); !done(); turn())
            if (soc_.now() > end)
                throw std::runtime_error("not done after " + std::to_string(limitSeconds) +
                                         " simulated seconds");
    }
    void connect() {
        Link_start(near.link(), us());
        until([&] { return near.isUp() && far.isUp(); }, 60);
        Link_openChannel(near.link(), 0);
        until([&] { return near.statistics().framesSent > 2; }, 1);
    }
    static U32 us() { return OSTimeGet() * (1000000U / OS_TICKS_PER_SEC); }
    uint64_t now() const { return soc_.now(); }

    double setUpMs = 0;

private:
    void write(uint64_t now) {
        U32 us = static_cast<U32>(now / 1000);
        std::vector<U8> frame = pacer_.due(us);
        line_.send(frame.data(), frame.size(), now);
        U32 wait = pacer_.deadline(us);
        nextWrite_ = wait == 0xFFFFFFFFu ? never : now + wait * 1000ull;
    }
    static XBee::Options modem(unsigned guardMs, std::map<std::string, uint32_t> more) {
        XBee::Options options;
        options.set = {{"GT", guardMs}};
        for (auto& [letters, value] : more)
            options.set[letters] = value;
        return options;
    }
    unsigned guardMs_;
    RfChannel air_{testSeed()};
    TimedLine line_;
    XBee ground_{line_, air_, modem(1000, {{"BD", 7}, {"MY", 0}, {"DL", 1}, {"D7", 1}, {"RN", 2}})};
    SocModel soc_{air_, modem(guardMs_, {})};
    bool irqOn_ = false;
    OS_EVENT* work_ = nullptr;
    uint64_t nextPoll_ = 0, nextWrite_ = never;
    XBeeAT::FramePacer pacer_{90, LINK_MAX_FRAME};

public:
    End near{[](const U8* f, U32 n) { return Radio_transmit(nullptr, f, n); },
             [this] { return soc_.now(); }, 11};
    // This end is the engine on the ground.
    End far{[this](const U8* f, U32 n) {
                U32 us = static_cast<U32>(soc_.now() / 1000);
                if (!pacer_.offer(f, n, us))
                    return 1;
                write(soc_.now());
                return 0;
            },
            [this] { return soc_.now(); }, 12};
};

Figures figures("The radio link through the RTL, in simulated time.");

void goodput(double loss, double target, bool down, bool hasKey) {
    World w(loss, 20, hasKey);
    w.run([&] {
        w.connect();
        const std::vector<U8> message(945, 1);
        End &from = down ? w.near : w.far, &to = down ? w.far : w.near;
        const unsigned count = 50;
        unsigned sent = 0;
        uint64_t start = w.now();
        w.until(
            [&] {
                while (sent < count &&
                       Link_send(from.link(), 0, message.data(), 945, sent) == LINK_OK)
                    ++sent;
                return to.messages >= count;
            },
            300);
        double rate =
            static_cast<double>(to.bytes) / (static_cast<double>(to.lastAt - start) / 1e9);
        std::printf("goodput %s %s, %4.0f %% lost: %7.0f bytes/s, %.1f %% of %.0f (wanted %.0f "
                    "%%), %u fragments sent again\n",
                    down ? "UAV to ground" : "ground to UAV", modes[hasKey], loss * 100, rate,
                    rate / mostBytesPerSecond * 100, mostBytesPerSecond, target * 100,
                    from.statistics().fragmentsResent);
        char name[80];
        std::snprintf(name, sizeof name, "goodput %s %s, loss %.2f",
                      down ? "UAV to ground" : "ground to UAV", modes[hasKey], loss);
        figures.add(name, rate, "bytes/s", mostBytesPerSecond);
    });
}

void roundTrips(bool hasKey) {
    World w(0, 20, hasKey);
    const U32 overhead = hasKey ? LINK_SECURE_OVERHEAD : LINK_OVERHEAD;
    w.run([&] {
        w.connect();
        for (auto [out, back] : {std::pair<U32, U32>{1, 1},
                                 {5, 2},
                                 {20, 10},
                                 {40, 25},
                                 {60, 60},
                                 {86, 86},
                                 {94, 94}}) {
            std::vector<double> times;
            w.far.echoSize = back;
            const std::vector<U8> message(out, 1);
            for (int i = 0; i < 31; ++i) {
                U32 before = w.near.messages;
                uint64_t start = w.now();
                Link_send(w.near.link(), 0, message.data(), out, 0);
                w.until([&] { return w.near.messages > before; }, 5);
                times.push_back(static_cast<double>(w.near.lastAt - start) / 1e6);
                uint64_t rest = w.now() + 60'000'000 + static_cast<uint64_t>(i) * 330'000;
                w.until([&] { return w.now() >= rest; }, 5);
            }
            std::sort(times.begin(), times.end());
            // What is longer than 20 bytes has a check unless there is a key; the answer takes the
            // acknowledgement along.
            auto onLine = [&](U32 size) {
                size += hasKey || size <= LINK_UNCHECKED ? 0 : LINK_CHECK;
                return size + overhead * (size + overhead > LINK_MAX_FRAME ? 2 : 1);
            };
            const U32 there = onLine(out), here = onLine(back) + 1;
            const double median = times[times.size() / 2], floor = floorMs(there, here);
            std::printf("round trip %s, %2u bytes out and %2u back (%u and %u on the line): median "
                        "%.1f ms, longest %.1f, floor %.1f, ratio %.2f (wanted 1.15)\n",
                        modes[hasKey], out, back, there, here, median, times.back(), floor,
                        median / floor);
            figures.add("round trip " + std::to_string(out) + "/" + std::to_string(back) + " " +
                            modes[hasKey],
                        median, "ms", floor);
        }
        w.far.echoSize = 0;
    });
}

void setUp(unsigned guardMs) {
    World w(0, guardMs);
    w.run([&] {});
    // Guard time before and after +++, at the target rate (in vain) and at the factory's 9600.
    double limit = 4.0 * guardMs;
    std::printf(
        "modem set-up from factory settings, guard time %4u ms: %.0f ms (four guard times: %.0f)\n",
        guardMs, w.setUpMs, limit);
    figures.add("modem set-up, guard " + std::to_string(guardMs) + " ms", w.setUpMs, "ms", limit);
}

// Counts the bytes that the firmware copies for a byte that the application sends or receives, and
// its cost for the host.
void copies() {
    World w(0, 20);
    const unsigned messages = 8;
    w.run([&] {
        w.connect();
        const std::vector<U8> message(4000, 1);
        Radio_Counters before = *Radio_counters();
        for (unsigned i = 0; i < messages; ++i) {
            w.until([&] { return Link_send(w.near.link(), 0, message.data(), 4000, 0) == LINK_OK; },
                    60);
            w.until([&] { return Link_send(w.far.link(), 0, message.data(), 4000, 0) == LINK_OK; },
                    60);
        }
        w.until([&] { return w.near.messages == messages && w.far.messages == messages; }, 60);
        const Radio_Counters& after = *Radio_counters();
        double out = (after.bytesCopiedOut - before.bytesCopiedOut) / (4000.0 * messages);
        double in = (after.bytesCopiedIn - before.bytesCopiedIn) / (4000.0 * messages);
        std::printf(
            "bytes over the FSMC for a byte of a message: %.2f sent, %.2f received (headers and "
            "acknowledgements included)\n",
            out, in);
        figures.add("bytes over the FSMC a byte sent", out, "bytes");
        figures.add("bytes over the FSMC a byte received", in, "bytes");
    });
}

void hostTime() {
    std::deque<std::vector<U8>> wire[2];
    auto clock = [] { return uint64_t(0); };
    End a([&](const U8* f, U32 n) { return wire[0].emplace_back(f, f + n), 0; }, clock, 1);
    End b([&](const U8* f, U32 n) { return wire[1].emplace_back(f, f + n), 0; }, clock, 2);
    U32 now = 0;
    auto pass = [&] {
        now += 10000;
        for (auto [from, to] : {std::pair{&wire[0], &b}, {&wire[1], &a}})
            for (; !from->empty(); from->pop_front())
                Link_receive(to->link(), from->front().data(),
                             static_cast<U32>(from->front().size()), now);
        Link_poll(a.link(), now);
        Link_poll(b.link(), now);
    };
    Link_start(a.link(), now);
    while (!a.isUp() || !b.isUp())
        pass();
    Link_openChannel(a.link(), 0);
    const std::vector<U8> message(945, 1);
    auto start = std::chrono::steady_clock::now();
    unsigned sent = 0;
    while (b.messages < 2000) {
        while (sent < 2000 && Link_send(a.link(), 0, message.data(), 945, 0) == LINK_OK)
            ++sent;
        pass();
    }
    double ns =
        std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count();
    std::printf("link layer on this machine, both ends: %.1f ns a byte of a message\n",
                ns / (2000 * 945.0));
    figures.add("link layer on the host, both ends", ns / (2000 * 945.0), "ns/byte");
}

void allGoodput() {
    const double targets[][2] = {{0, 0.95}, {0.01, 0.94}, {0.1, 0.88}, {0.3, 0.70}};
    for (bool hasKey : {false, true})
        for (bool down : {true, false})
            for (auto [loss, target] : targets)
                goodput(loss, target, down, hasKey);
}

} // namespace

int main(int argc, char** argv) {
    std::string only;
    const std::map<std::string, std::function<void()>> parts = {
        {"set-up", [] { setUp(1000), setUp(20); }},
        {"goodput", allGoodput},
        {"round-trips", [] { roundTrips(false), roundTrips(true); }},
        {"copies", copies},
        {"host", hostTime}};
    figures.app.add_option("part", only, "only this part")->check(CLI::IsMember(parts));
    return figures.run(argc, argv, [&] {
        for (auto& [name, measure] : parts)
            if (only.empty() ? !figures.brief || name == "host" : name == only)
                measure();
        if (figures.brief)
            setUp(20);
    });
}
