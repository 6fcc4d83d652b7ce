// SPDX-License-Identifier: MIT
//
// fleet: measures calls per second on one channel, to several vehicles. The vehicles are called one
// after the other or all at once. The callers are one ground station, one ground station per
// vehicle, or two ground stations that share the vehicles. Links, modems in API mode and air are
// the same as in air.cpp; the links of a ground station share its modem, as in the engine.

#include "figures.h"
#include "modem_pair.h"
#include <list>

namespace {

Figures figures("Calls a second of several vehicles on one channel.");

constexpr U32 callBytes = 3; // size of a call of setParameterA(short) with a compressed head, bytes

// A ground station or a vehicle. A ground station makes a new call on each of its links as soon as
// the previous call has been answered. A vehicle replies with the bytes of the request.
class Station : public ModemEnd {
public:
    Station(RfChannel& air, int address, bool isGround, bool isKeyed,
            const std::vector<int>& targets, uint64_t seed)
        : ModemEnd(air, options(address, isGround), seed, targets), isGround_(isGround),
          calls_(targets.size()) {
        for (size_t i = 0; i < peers(); ++i) {
            // number of the vehicle; each vehicle has a different key
            const int vehicle = isGround ? targets[i] : address;
            const std::vector<U8> key(LINK_KEY_BYTES, static_cast<U8>(vehicle));
            if (isKeyed)
                Link_setKey(link(i), 0, key.data(),
                            static_cast<U32>(vehicle) | (isGround ? LINK_GROUND : 0));
            if (isGround)
                Link_start(link(i), 0);
        }
    }
    uint64_t advance(uint64_t now) {
        for (size_t i = 0; calls && isGround_ && i < peers(); ++i)
            call(i);
        return ModemEnd::advance(now);
    }
    std::vector<double> times; // durations of the calls, ms
    bool calls = false;

private:
    struct Call {
        uint64_t at = 0;
        U16 number = 0;
        bool isOpen = false, isWaiting = false;
    };
    static XBee::Options options(int address, bool isGround) {
        XBee::Options o = modemOptions(static_cast<unsigned>(address), false, 2, true);
        o.set["DL"] = 0;
        o.set["BD"] = isGround ? 7 : 250000;
        return o;
    }
    void call(size_t peer) {
        Call& c = calls_[peer];
        if (c.isWaiting)
            return;
        c.isOpen = c.isOpen || Link_openChannel(link(peer), 0) == LINK_OK;
        const U16 number = static_cast<U16>(c.number + 1);
        const U8 message[callBytes] = {static_cast<U8>(target(peer)), static_cast<U8>(number),
                                       static_cast<U8>(number >> 8)};
        if (c.isOpen && Link_send(link(peer), 0, message, callBytes, 0) == LINK_OK)
            c = {now_, number, true, true};
    }
    int onMessage(size_t peer, int, const U8* m, U32 size) override {
        if (!isGround_)
            return Link_send(link(peer), 0, m, size, 0) == LINK_FULL;
        Call& c = calls_[peer];
        if (m[0] != target(peer) || (m[1] | m[2] << 8) != c.number || !c.isWaiting)
            throw std::runtime_error("an answer is another vehicle's, or another call's");
        times.push_back(static_cast<double>(now_ - c.at) / 1e6);
        c.isWaiting = false;
        call(peer);
        return 0;
    }
    const bool isGround_;
    std::vector<Call> calls_; // current call to each peer
};

// Measures `grounds` ground stations and `vehicles` vehicles. The vehicles are divided among the
// stations, so that each vehicle is called by one station.
void measure(const std::string& what, int grounds, int vehicles, bool isKeyed,
             double foundOutside) {
    std::vector<double> times;
    double rate = 0;
    const int runs = figures.brief ? 1 : 3;
    const uint64_t spanNs = (figures.brief ? 1 : 20) * 1'000'000'000ull;
    for (int run = 0; run < runs; ++run) {
        const uint64_t seed = testSeed() + static_cast<uint64_t>(100 * run);
        constexpr int firstGround = 0x0100;
        RfChannel air(seed);
        std::list<Station> stations;
        for (int g = 0; g < grounds; ++g) {
            std::vector<int> own;
            for (int v = g; v < vehicles; v += grounds)
                own.push_back(v + 1);
            stations.emplace_back(air, firstGround + g, true, isKeyed, own, seed + 1);
            for (int v : own)
                stations.emplace_back(air, v, false, isKeyed, std::vector<int>{firstGround + g},
                                      seed + 1 + static_cast<uint64_t>(v));
        }
        uint64_t now = 0;
        const auto areUp = [&] {
            return std::all_of(stations.begin(), stations.end(),
                               [](const Station& s) { return s.areUp(); });
        };
        if (!passUntil(now, 120'000'000'000, air, stations, areUp))
            throw std::runtime_error("no session within two minutes");
        const auto pass = [&](uint64_t end) {
            passUntil(now, never, air, stations, [&] { return now >= end; });
        };
        for (Station& s : stations)
            s.calls = true;
        const uint64_t begin = now + 2'000'000'000;
        pass(begin);
        for (Station& s : stations)
            s.times.clear();
        pass(begin + spanNs);
        for (const Station& s : stations) {
            rate += static_cast<double>(s.times.size()) * 1e9 / static_cast<double>(spanNs) / runs;
            times.insert(times.end(), s.times.begin(), s.times.end());
        }
    }
    std::sort(times.begin(), times.end());
    const std::string name = what + (isKeyed ? " with a key" : " in the clear");
    const std::string count =
        ", " + std::to_string(vehicles) + (vehicles == 1 ? " vehicle" : " vehicles");
    figures.add(name + count, rate, "calls/s", foundOutside);
    if (rate < 0.9 * foundOutside)
        figures.miss(name + " is below nine tenths of what others found");
    for (auto [part, share] : {std::pair("median", 50u), std::pair("95th percentile", 95u)})
        figures.add(name + count + ": " + part,
                    times.empty() ? 0 : times[(times.size() - 1) * share / 100], "ms");
}

} // namespace

int main(int argc, char** argv) {
    return figures.run(argc, argv, [&] {
        // Published results for models of the same modems, without encryption: number of vehicles,
        // calls per second with one ground station, and with one ground station per vehicle.
        const std::vector<std::tuple<int, double, double>> fleets = {
            {1, 34.6, 34.6}, {2, 60.4, 69}, {5, 78, 125}, {10, 80, 130}, {20, 80, 128}};
        for (bool isKeyed : {false, true})
            for (auto [vehicles, oneGround, pairs] : fleets) {
                if (!figures.brief || vehicles == 2)
                    measure("one ground", 1, vehicles, isKeyed, isKeyed ? 0 : oneGround);
                if (!figures.brief || vehicles == 2 || vehicles == 20)
                    measure("one ground per vehicle", vehicles, vehicles, isKeyed,
                            isKeyed ? 0 : pairs);
                if (!figures.brief && vehicles > 2)
                    measure("two grounds", 2, vehicles, isKeyed, 0);
            }
    });
}
