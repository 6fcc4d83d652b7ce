// SPDX-License-Identifier: MIT
//
// fleet: calls a second on one channel, with vehicles that are called one after the other each,
// all at once: by one ground, by grounds of their own, by two grounds that share them. Links,
// modems in API mode and air, as in air.cpp; a ground shares its modem as the engine does.

#include "figures.h"
#include "modem_pair.h"
#include <numeric>

namespace {

Figures figures("Calls a second of several vehicles on one channel.");

constexpr U32 callBytes = 3; // setParameterA(short), its head compressed

// A modem and the links that it carries, one for each station that it talks to. A ground calls on
// each link as soon as the call before is answered; a vehicle answers with the call.
class Station {
public:
    Station(RfChannel& air, int address, bool isGround, bool isKeyed,
            const std::vector<int>& targets, uint64_t seed)
        : modem_(line_, air, options(address, isGround)), isGround_(isGround), random_(seed) {
        static const Link_Port port = {
            [](void* c, const U8* f, U32 n) { return of(c).station.transmit(of(c), f, n); },
            [](void* c) { return of(c).station.random_.next(); },
            [](void* c, int, const U8* m, U32 n) { return of(c).station.take(of(c), m, n); },
            [](void*, int, int) {},
            [](void*, Link_State) {},
            nullptr,
            nullptr};
        for (int target : targets) {
            peers_.push_back(std::make_unique<Peer>(Peer{*this, target}));
            Link* link = peers_.back()->link.get();
            Link_init(link, &port, peers_.back().get(), 1440);
            const int vehicle = isGround ? target : address; // each has a key of its own
            const std::vector<U8> key(LINK_KEY_BYTES, static_cast<U8>(vehicle));
            if (isKeyed)
                Link_setKey(link, 0, key.data(),
                            static_cast<U32>(vehicle) | (isGround ? LINK_GROUND : 0));
            Link_expectAnswers(link, mostWaiting());
            if (isGround)
                Link_start(link, 0);
        }
    }
    uint64_t advance(uint64_t now) {
        now_ = now;
        modem_.advance(now);
        if (now >= nextPoll_ || !line_.received.empty())
            work(static_cast<U32>(now / 1000));
        return std::min(modem_.nextEvent(), nextPoll_);
    }
    bool isUp() const {
        return std::all_of(peers_.begin(), peers_.end(), [](const auto& p) {
            return Link_state(p->link.get()) == LINK_STATE_UP;
        });
    }
    std::vector<double> times; // of calls, in ms
    bool calls = false;

private:
    struct Peer {
        Station& station;
        int target;
        std::unique_ptr<Link> link{new Link};
        uint64_t airUs = 0, calledAt = 0;
        U16 calls = 0;
        bool isOpen = false, isWaiting = false;
    };
    static Peer& of(void* c) { return *static_cast<Peer*>(c); }
    static XBee::Options options(int address, bool isGround) {
        XBee::Options o = modemOptions(static_cast<unsigned>(address), false, 2, true);
        o.set["DL"] = 0;
        o.set["BD"] = isGround ? 7 : 250000;
        return o;
    }
    unsigned mostWaiting() const { return isGround_ ? 3 : 2; }
    void work(U32 us) {
        api_.feed(
            line_.received.data(), line_.received.size(),
            [&](int source, const U8* data, size_t count) {
                for (auto& p : peers_)
                    if (p->target == source)
                        Link_receive(p->link.get(), data, static_cast<U32>(count), us);
            },
            [&](int target, bool isThere) {
                for (auto& p : peers_)
                    if (p->target == target)
                        Link_answer(p->link.get(), isThere, us);
            });
        line_.received.clear();
        std::vector<Peer*> order;
        for (auto& p : peers_)
            order.push_back(p.get());
        std::sort(order.begin(), order.end(),
                  [](const Peer* a, const Peer* b) { return a->airUs < b->airUs; });
        U32 wait = 1000;
        for (Peer* p : order) {
            call(*p);
            Link_poll(p->link.get(), us);
            wait = std::min(wait, Link_deadline(p->link.get(), us));
        }
        nextPoll_ = now_ + wait * 1000ull + 100'000;
    }
    void call(Peer& p) {
        if (!isGround_ || p.isWaiting || !calls)
            return;
        p.isOpen = p.isOpen || Link_openChannel(p.link.get(), 0) == LINK_OK;
        const U16 number = static_cast<U16>(p.calls + 1);
        const U8 message[callBytes] = {static_cast<U8>(p.target), static_cast<U8>(number),
                                       static_cast<U8>(number >> 8)};
        if (!p.isOpen || Link_send(p.link.get(), 0, message, callBytes, 0) != LINK_OK)
            return;
        p.calls = number;
        p.isWaiting = true;
        p.calledAt = now_;
    }
    int take(Peer& p, const U8* m, U32 size) {
        if (!isGround_)
            return Link_send(p.link.get(), 0, m, size, 0) == LINK_FULL;
        if (m[0] != p.target || (m[1] | m[2] << 8) != p.calls || !p.isWaiting)
            throw std::runtime_error("an answer is another vehicle's, or another call's");
        times.push_back(static_cast<double>(now_ - p.calledAt) / 1e6);
        p.isWaiting = false;
        nextPoll_ = now_;
        return 0;
    }
    int transmit(Peer& p, const U8* frame, U32 size) {
        if (api_.unanswered() >= mostWaiting())
            return 1;
        U32 rn = Link_randomWait(p.link.get());
        for (auto& other : peers_)
            if (Link_state(other->link.get()) == LINK_STATE_UP)
                rn = std::max(rn, Link_randomWait(other->link.get()));
        const auto bytes =
            api_.packet(p.target, frame, size, rn, static_cast<uint32_t>(now_ / 1000));
        line_.send(bytes.data(), bytes.size(), now_);
        p.airUs = std::max(p.airUs, airUs_); // as the engine's peers
        airUs_ = p.airUs;
        p.airUs += LINK_PACKET_US + size * LINK_BYTE_US;
        return 0;
    }

    TimedLine line_;
    XBee modem_;
    const bool isGround_;
    XBeeAT::ApiModem api_{false};
    std::vector<std::unique_ptr<Peer>> peers_;
    Random random_;
    uint64_t now_ = 0, nextPoll_ = 0, airUs_ = 0;
};

// So many grounds call so many vehicles, each ground its own ones.
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
        std::vector<std::unique_ptr<Station>> stations;
        for (int g = 0; g < grounds; ++g) {
            std::vector<int> own;
            for (int v = g; v < vehicles; v += grounds)
                own.push_back(v + 1);
            stations.push_back(
                std::make_unique<Station>(air, firstGround + g, true, isKeyed, own, seed + 1));
            for (int v : own)
                stations.push_back(std::make_unique<Station>(air, v, false, isKeyed,
                                                             std::vector<int>{firstGround + g},
                                                             seed + 1 + static_cast<uint64_t>(v)));
        }
        uint64_t now = 0;
        const auto pass = [&](auto isDone) {
            while (!isDone()) {
                air.advance(now);
                uint64_t next = never;
                for (auto& s : stations)
                    next = std::min(next, s->advance(now));
                now = std::max(now + 1, std::min(next, air.nextEvent()));
            }
        };
        pass([&] {
            if (now > 120'000'000'000)
                throw std::runtime_error("no session within two minutes");
            return std::all_of(stations.begin(), stations.end(),
                               [](const auto& s) { return s->isUp(); });
        });
        for (auto& s : stations)
            s->calls = true;
        const uint64_t begin = now + 2'000'000'000;
        pass([&] { return now >= begin; });
        for (auto& s : stations)
            s->times.clear();
        pass([&] { return now >= begin + spanNs; });
        for (auto& s : stations) {
            rate += static_cast<double>(s->times.size()) * 1e9 / static_cast<double>(spanNs) / runs;
            times.insert(times.end(), s->times.begin(), s->times.end());
        }
    }
    std::sort(times.begin(), times.end());
    const std::string name = what + (isKeyed ? " with a key" : " in the clear");
    figures.add(name + ", of " + std::to_string(vehicles) + " vehicles", rate, "calls/s",
                foundOutside);
    for (auto [part, share] : {std::pair("median", 50u), std::pair("95 of 100 within", 95u)})
        figures.add(name + ", of " + std::to_string(vehicles) + " vehicles: " + part,
                    times.empty() ? 0 : times[(times.size() - 1) * share / 100], "ms");
}

} // namespace

int main(int argc, char** argv) {
    return figures.run(argc, argv, [&] {
        // Beside what others found in the clear, with models of the same modems.
        const std::vector<std::tuple<int, double, double>> fleets = {
            {1, 34.6, 34.6}, {2, 60.4, 69}, {5, 78, 125}, {10, 80, 130}, {20, 80, 128}};
        for (bool isKeyed : {false, true})
            for (auto [vehicles, oneGround, pairs] : fleets) {
                if (figures.brief && vehicles != 2)
                    continue;
                measure("one ground", 1, vehicles, isKeyed, isKeyed ? 0 : oneGround);
                measure("a ground each", vehicles, vehicles, isKeyed, isKeyed ? 0 : pairs);
                if (vehicles > 2)
                    measure("two grounds", 2, vehicles, isKeyed, 0);
            }
    });
}
