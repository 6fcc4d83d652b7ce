// SPDX-License-Identifier: MIT
//
// air: measures the radio link over two modems and the air between them, without chip and kernel:
// goodput in one direction and in both directions at the same time, and round trips, unencrypted
// and encrypted (docs/link.md). The option --api sets how many of the modems are in API mode
// (default: both). The ground modem uses 111,111 baud and the vehicle modem 250,000, as with the
// firmware. Goodput in one direction is measured from ground to vehicle. If calls are measured
// during a picture transfer, the vehicle sends the pictures.

#include "figures.h"
#include "modem_pair.h"

namespace {

// parameter RN of the modems, set by the controller and by the ground
unsigned leastExponent = 2;
// number of modems in API mode: 0, 1 (only the ground's) or 2
unsigned apiEnds = 2;
// parameter BD in API mode, for the ground modem and for the vehicle modem
unsigned rates[2] = {7, 250000};
constexpr int pictures = 0, calls = 1; // channels
const char* const key = "0123456789ABCDEF0123456789ABCDEF";

// Clear: no encryption. Encrypted: the modems encrypt. Keyed: the link layer encrypts, with a key
// (docs/link.md).
enum Mode { Clear, Encrypted, Keyed };
const char* const names[] = {"in the clear", "encrypted", "with a key"};

class End : public ModemEnd {
public:
    End(RfChannel& air, unsigned address, uint64_t seed, Mode mode)
        : ModemEnd(air, options(address, mode, address < apiEnds), seed) {
        if (mode == Keyed)
            Link_setKey(link(), 0, reinterpret_cast<const U8*>(key), address ? 0 : LINK_GROUND);
    }
    uint64_t advance(uint64_t now) {
        if (feed)
            fill();
        return ModemEnd::advance(now);
    }
    // echoSize: size of the reply to a call, bytes; called: number of messages received on channel
    // `calls`
    U32 echoSize = 0, called = 0;
    // bytes: number of bytes received on channel `pictures`; lastAt: time at which the last of them
    // arrived; calledAt: time of the last call
    uint64_t bytes = 0, lastAt = 0, calledAt = 0;
    bool feed = false; // true: pictures are sent continuously
    // Queues pictures for sending; all bytes of a picture are its number.
    void fill(U32 size = LINK_MAX_MESSAGE) {
        for (;; ++sent_) {
            const std::vector<U8> message(size, static_cast<U8>(sent_));
            if (Link_send(link(), pictures, message.data(), size, 0) != LINK_OK)
                return;
        }
    }

private:
    static XBee::Options options(unsigned address, Mode mode, bool isApi) {
        XBee::Options o = modemOptions(address, mode == Encrypted, leastExponent, isApi);
        if (isApi)
            o.set["BD"] = rates[address];
        if (mode == Encrypted)
            o.key = key;
        return o;
    }
    int onMessage(size_t, int channel, const U8* message, U32 size) override {
        static const U8 answer[LINK_MAX_PAYLOAD] = {1};
        if (channel == pictures) {
            const std::vector<U8> expected(size, static_cast<U8>(received_++));
            if (!std::equal(expected.begin(), expected.end(), message))
                throw std::runtime_error("a message was lost, doubled or changed");
            bytes += size;
            lastAt = now_;
            return 0;
        }
        ++called;
        calledAt = now_;
        if (echoSize)
            Link_send(link(), channel, answer, echoSize, 0);
        return 0;
    }
    unsigned sent_ = 0, received_ = 0; // pictures
};

class AirPair : public ModemPair<End> {
public:
    AirPair(const RfWeather& weather, Mode mode, uint64_t seed = testSeed())
        : ModemPair(weather, seed, 2, mode) {}
};

Figures figures("The radio link on a half-duplex air with the modems' own limits.");

// Sends for `seconds`. If `both` is true, both sides send, otherwise only the first side. Returns
// the total number of bytes per second that the two sides receive.
double flow(AirPair& w, bool both, uint64_t seconds) {
    const uint64_t start = w.now;
    w.until(
        [&] {
            w.a.fill(LINK_MAX_MESSAGE / 4);
            if (both)
                w.b.fill(LINK_MAX_MESSAGE / 4);
            return w.now >= start + seconds * 1'000'000'000;
        },
        1e9);
    double rate = 0;
    for (const End* to : {&w.b, &w.a})
        if (to->lastAt > start)
            rate += static_cast<double>(to->bytes) * 1e9 / static_cast<double>(to->lastAt - start);
    return rate;
}

// Returns the largest number of bytes per second that the modems can transfer under these radio
// conditions, with the best value of RN. A key of the link does not change this limit.
double limitOf(const std::string& what, const RfWeather& weather, bool isEncrypted, bool both) {
    static std::map<std::string, double> known;
    double& most = known[what + (isEncrypted ? ", encrypted" : "") + (both ? ", both ways" : "")];
    for (unsigned rn = 0, isKnown = most > 0; !isKnown && rn <= 3; ++rn)
        most = std::max(most, mostBytesPerSecond(weather, both, isEncrypted, rn,
                                                 figures.brief ? 1 : 200, testSeed()));
    return most;
}

// Returns the share of the limit that the link must reach in API mode. `share` is the measured
// share. In both directions at the same time, the link must reach the share that was measured
// before for one direction, less 5 percentage points.
double wantedShare(const std::string& what, bool both, double share) {
    static double oneWay;
    if (both)
        return oneWay - 0.05;
    oneWay = share;
    const bool isClear = what == "loss 0.00";
    const bool isTried = what.find("interferer") == 0 || what.find("fading") != what.npos;
    return isClear ? 0.95 : isTried ? 0.92 : 0.9;
}

// Measures goodput as the mean over several seeds, because single runs differ by a tenth. Both the
// figure and its limit count the bytes of a program, without the overhead of frames.
void goodput(const std::string& what, const RfWeather& weather, Mode mode, bool both) {
    const unsigned runs = figures.brief ? 1 : 9;
    const double packet = mode == Encrypted ? LINK_MAX_ENCRYPTED : LINK_MAX_FRAME;
    const double own = mode == Keyed ? LINK_SECURE_OVERHEAD : LINK_OVERHEAD;
    const double modems = limitOf(what, weather, mode == Encrypted, both);
    const double limit = modems * (packet - own) / packet;
    double rate = 0;
    uint64_t acks = 0;
    for (unsigned run = 0; run < runs; ++run) {
        AirPair w(weather, mode, testSeed() + 10 * run);
        rate += flow(w, both, figures.brief ? 1 : 20) / runs;
        acks += w.a.statistics().acksSent + w.b.statistics().acksSent;
    }
    std::printf("%.0f acknowledgements a run: ", static_cast<double>(acks) / runs);
    const std::string name =
        std::string("goodput ") + (both ? "both ways " : "one way ") + names[mode] + ", " + what;
    figures.add(name, rate, "bytes/s", limit)["gross"] = rate / modems;
    const double wanted = wantedShare(what, both, rate / limit);
    if (apiEnds == 2 && rate < wanted * limit)
        figures.miss(name + " is below " + std::to_string(wanted) + " of the limit");
}

void allGoodput(Mode mode) {
    for (const char* loss : {"0.00", "0.01", "0.10", "0.30"})
        for (bool both : {false, true}) {
            RfWeather weather;
            weather.loss = std::stod(loss);
            if (!figures.brief || weather.loss == 0.1)
                goodput("loss " + std::string(loss), weather, mode, both);
        }
}

void allWeather(Mode mode) {
    const auto& all = RfWeather::published();
    for (auto& [what, weather] : all)
        for (bool both : {false, true})
            if (!figures.brief || &weather == &all.front().second)
                goodput(what, weather, mode, both);
}

// Makes `count` calls, each with a message of `size` bytes and a reply of the same size. Returns
// the durations in ms, sorted.
std::vector<double> callTimes(AirPair& w, U32 size, int count) {
    std::vector<double> times;
    const std::vector<U8> message(size, 1);
    w.b.echoSize = size;
    for (int i = 0; i < (figures.brief ? 1 : count); ++i) {
        const U32 before = w.a.called;
        const uint64_t start = w.now;
        Link_send(w.a.link(), calls, message.data(), size, 0);
        w.need([&] { return w.a.called > before; });
        times.push_back(static_cast<double>(w.a.calledAt - start) / 1e6);
        w.pass(160'000'000 + static_cast<uint64_t>(i) * 330'000);
    }
    std::sort(times.begin(), times.end());
    return times;
}

void roundTrips(Mode mode) {
    const U32 overhead = mode == Keyed ? LINK_SECURE_OVERHEAD : LINK_OVERHEAD;
    const U32 packet = mode == Encrypted ? LINK_MAX_ENCRYPTED : LINK_MAX_FRAME;
    const U32 longest = packet - overhead - 1 - (mode == Keyed ? 0 : LINK_CHECK);
    AirPair w(RfWeather(), mode);
    for (U32 size : {1u, 5u, 10u, 20u, 40u, 60u, 80u, longest, 94u}) {
        const auto times = callTimes(w, size, 31);
        const double median = times[times.size() / 2];
        const U32 check = mode == Keyed || size <= LINK_UNCHECKED ? 0 : LINK_CHECK;
        const U32 frames = size + check + overhead > packet ? 2 : 1;
        const U32 onLine = size + check + frames * overhead;
        // The reply is one byte longer than the call, because the reply also contains the
        // acknowledgement.
        const double floor = floorMs(onLine, onLine + 1, mode == Encrypted);
        figures.add("round trip of " + std::to_string(size) + " bytes " + names[mode], median, "ms",
                    floor);
    }
}

// Measures MAVLink 2's COMMAND_LONG and COMMAND_ACK, sent as plain bytes without retransmission
// over the same air. With a key, these messages are signed.
void peers(Mode mode) {
    const bool isSigned = mode == Keyed;
    const double ms = floorMs(isSigned ? 58 : 45, isSigned ? 35 : 22, mode == Encrypted);
    AirPair w(RfWeather(), mode);
    const auto times = callTimes(w, 3, 31); // a call of setParameterA(short) takes 3 bytes
    const double own = times[times.size() / 2];
    figures.add(std::string("round trip of a command ") + names[mode] + ", limit: MAVLink 2", own,
                "ms", ms);
}

// Measures calls of one byte to a vehicle that continuously sends pictures of 8 KB. Their limit is
// the median of the floor.
void headOfLine(Mode mode) {
    const U32 call = 1 + (mode == Keyed ? LINK_SECURE_OVERHEAD : LINK_OVERHEAD);
    for (double loss : {0.0, 0.1}) {
        RfWeather weather;
        weather.loss = loss;
        const double floor = floorDuringStreamMs(call, call + 1, weather, mode == Encrypted);
        AirPair w(weather, mode);
        w.b.feed = true;
        const auto times = callTimes(w, 1, 201);
        char name[80];
        std::snprintf(name, sizeof name, "%s, loss %.2f", names[mode], loss);
        const std::string what = "call during a picture transfer, ";
        figures.add(what + "median " + name, times[times.size() / 2], "ms", floor);
        figures.add(what + "95th percentile " + name, times[times.size() * 19 / 20], "ms", floor);
    }
}

} // namespace

int main(int argc, char** argv) {
    figures.app.add_option("--rn", leastExponent, "RN of modems in transparent mode")
        ->check(CLI::Range(0u, 3u));
    figures.app.add_option("--api", apiEnds, "Modems in API mode: none, the ground's, both")
        ->check(CLI::Range(0u, 2u));
    figures.app.add_option("--ground-rate", rates[0], "the ground's BD, or its rate in baud");
    figures.app.add_option("--vehicle-rate", rates[1], "the vehicle's, in API mode");
    std::string only;
    const std::map<std::string, void (*)(Mode)> parts = {{"goodput", allGoodput},
                                                         {"round-trips", roundTrips},
                                                         {"head-of-line", headOfLine},
                                                         {"peers", peers},
                                                         {"weather", allWeather}};
    figures.app.add_option("part", only, "only this part")->check(CLI::IsMember(parts));
    return figures.run(argc, argv, [&] {
        for (auto& [name, measure] : parts)
            for (Mode mode : {Clear, Encrypted, Keyed})
                if (only.empty() || name == only)
                    measure(mode);
    });
}
