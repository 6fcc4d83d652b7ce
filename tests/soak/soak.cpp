// SPDX-License-Identifier: MIT
//
// soak: two link layers over two XBee models in API mode and a bad radio, for any time: random
// messages both ways, loss, bursts, corruption, duplication; reboots of the UAV, of the ground and
// of modems; with --attacked a key on both sides, and a hostile third modem. No message may be
// wrong, doubled or out of order, and each is delivered or reported: the first violation ends the
// program.

#include "api_modem.h"
#include "attacker.h"
#include "ice_messages.h"
#include "rf_channel.h"
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fmt/format.h>
#include <memory>
#include <unordered_map>

extern "C" {
#include "link.h"
}

namespace {

using Bytes = std::vector<uint8_t>;

constexpr uint64_t msNs = 1'000'000, secondNs = 1000 * msNs;

class Fault : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

// Makes message `id` of a side: every byte follows from the two.
Bytes messageOf(uint32_t side, uint32_t id) {
    Random r(uint64_t(side) << 40 | id);
    uint32_t kind = r.below(10), size = r.below(40) ? r.below(60) : r.below(LINK_MAX_MESSAGE - 100);
    Bytes body;
    IceMessages::put32(body, id);
    for (uint32_t i = 0; i < size; ++i)
        body.push_back(static_cast<uint8_t>(r.next()));
    std::string object = "object" + std::to_string(r.below(20));
    if (kind < 5)
        return IceMessages::request(kind < 2 ? 0 : id, object, "operation", body);
    if (kind < 8)
        return IceMessages::reply(id, body, kind == 7);
    body.push_back(body[0]);
    body[0] = static_cast<uint8_t>(r.next()); // any first byte
    return body;
}

struct Totals {
    uint64_t sent = 0, delivered = 0, unknown = 0, received = 0, reboots = 0, modemResets = 0;
};

// One end: modem, link and program. It knows the peer's messages only to check them.
class End {
public:
    End(uint32_t side, RfChannel& air, Random& random, Totals& totals, bool hasKey)
        : side_(side), random_(random), totals_(totals), hasKey_(hasKey), link_(new Link) {
        XBee::Options options;
        options.name = side ? "uav" : "ground";
        options.set = {{"BD", 7}, {"MY", side}, {"DL", 1 - side}, {"D7", 1}, {"AP", 1}};
        modem_ = std::make_unique<XBee>(line_, air, options);
        boot(0);
    }
    void boot(uint64_t now) {
        static const Link_Port port = {
            [](void* c, const U8* f, U32 n) { return self(c).transmit(f, n); },
            [](void* c) { return self(c).random_.next(); },
            [](void* c, int channel, const U8* d, U32 n) {
                return self(c).onMessage(channel, d, n);
            },
            [](void*, int, int) {},
            [](void*, Link_State) {},
            [](void* c, int, U32 tag, Link_Outcome o) { self(c).onOutcome(tag, o); },
            nullptr};
        now_ = now;
        line_.received.clear();
        out_.clear();
        api_ = XBeeAT::ApiModem(false);
        // Messages on their way at the power's loss: their program calls them unknown.
        totals_.unknown += outstanding_.size();
        outstanding_.clear();
        Link_init(link_.get(), &port, this, 1440);
        static const U8 key[LINK_KEY_BYTES] = {1, 2, 3};
        if (hasKey_)
            Link_setKey(link_.get(), 0, key, side_ ? 0 : LINK_GROUND);
        Link_expectAnswers(link_.get(), 2 + side_);
        Link_start(link_.get(), us());
    }
    void advance(uint64_t now, double rate) {
        now_ = now;
        modem_->advance(now);
        for (; !out_.empty() && line_.cts(); out_.pop_front()) // as both drivers do
            line_.send({out_.front()}, now);
        api_.expire(us(), [&](int, bool) { Link_answer(link_.get(), 0, us()); });
        api_.feed(
            line_.received.data(), line_.received.size(),
            [&](int, const uint8_t* data, size_t size) {
                Link_receive(link_.get(), data, static_cast<U32>(size), us());
            },
            [&](int, bool isThere) { Link_answer(link_.get(), isThere, us()); });
        line_.received.clear();
        Link_poll(link_.get(), us());
        if (isUp() && random_.chance(rate))
            offer();
        if (random_.chance(0.001))
            busy_ = random_.chance(0.1); // takes no message for a while
    }
    bool isUp() const { return Link_state(link_.get()) == LINK_STATE_UP; }
    bool isQuiet() const { return outstanding_.empty(); }
    XBee& modem() { return *modem_; }
    void setPeer(End* peer) { peer_ = peer; }
    void wakeUp() { busy_ = false; }
    const Link_Statistics& statistics() const { return *Link_statistics(link_.get()); }

private:
    static End& self(void* c) { return *static_cast<End*>(c); }
    U32 us() const { return static_cast<U32>(now_ / 1000); }
    [[noreturn]] void fault(const std::string& what, uint32_t id) {
        throw Fault((side_ ? "uav" : "ground") + std::string(": message ") + std::to_string(id) +
                    " " + what);
    }
    int transmit(const U8* frame, U32 size) {
        if (out_.size() > 2 * LINK_MAX_FRAME)
            return 1;
        const auto bytes = api_.packet(static_cast<int>(1 - side_), frame, size,
                                       Link_randomWait(link_.get()), us());
        out_.insert(out_.end(), bytes.begin(), bytes.end());
        return 0;
    }
    void offer() {
        Bytes m = messageOf(side_, nextId_);
        int channel = static_cast<int>(nextId_ % LINK_CHANNELS);
        Link_Status status =
            Link_send(link_.get(), channel, m.data(), static_cast<U32>(m.size()), nextId_);
        if (status == LINK_CLOSED)
            Link_openChannel(link_.get(), channel);
        if (status != LINK_OK)
            return;
        outstanding_.emplace(nextId_++, false);
        ++totals_.sent;
    }
    void onOutcome(U32 id, Link_Outcome outcome) {
        auto it = outstanding_.find(id);
        if (it == outstanding_.end())
            fault("reported twice, or never sent", id);
        if (outcome == LINK_DELIVERED && !it->second)
            fault("reported delivered, and it was not", id);
        ++(outcome == LINK_DELIVERED ? totals_.delivered : totals_.unknown);
        outstanding_.erase(it);
    }
    // The link's and the program's acceptance of a message are one step here, unless the program is
    // busy.
    int onMessage(int channel, const U8* data, U32 size) {
        if (busy_)
            return 1;
        peer_->check(channel, Bytes(data, data + size));
        ++totals_.received;
        return 0;
    }
    // Checks a message for its receiver: it is the next or a later one of this end and channel, and
    // whole.
    void check(int channel, const Bytes& bytes) {
        uint32_t& expected = expected_[channel];
        uint32_t id = expected;
        while (id < nextId_ && bytes != messageOf(side_, id))
            id += LINK_CHANNELS;
        if (id >= nextId_)
            fault("or one before it arrived wrong, twice, out of order or on another channel",
                  expected);
        auto it = outstanding_.find(id);
        if (it != outstanding_.end())
            it->second = true;
        // A skipped message must no longer be on its way for the sender.
        for (; expected < id; expected += LINK_CHANNELS)
            if (outstanding_.count(expected))
                fault("was skipped", expected);
        expected += LINK_CHANNELS;
    }

    uint32_t side_;
    Random& random_;
    Totals& totals_;
    const bool hasKey_;
    HostLine line_;
    std::deque<uint8_t> out_; // handed over, not yet on the line
    std::unique_ptr<XBee> modem_;
    XBeeAT::ApiModem api_{false};
    std::unique_ptr<Link> link_;
    End* peer_ = nullptr;
    uint64_t now_ = 0;
    bool busy_ = false;
    uint32_t nextId_ = 0, expected_[LINK_CHANNELS] = {0, 1, 2, 3}; // a channel has each fourth one
    std::unordered_map<uint32_t, bool>
        outstanding_; // sent and not reported, with whether it has arrived
};

class Soak {
public:
    Soak(uint64_t seed, bool attacked)
        : random_(seed), air_(seed + 1), attacked_(attacked), attacker_(air_, seed + 2),
          ground_(0, air_, random_, totals_, attacked), uav_(1, air_, random_, totals_, attacked) {
        ground_.setPeer(&uav_);
        uav_.setPeer(&ground_);
    }
    // Passes one simulated second with random events.
    void second() {
        weather();
        misfortune();
        for (uint64_t end = now_ + secondNs; now_ < end; now_ += msNs / 2)
            step(rate_);
    }
    // Good weather, nothing new: everything that is under way must be reported.
    void settle() {
        air_.weather = {};
        attacker_.hinder(false);
        for (int s = 0;
             s < 120 && !(ground_.isQuiet() && uav_.isQuiet() && ground_.isUp() && uav_.isUp());
             ++s) {
            ground_.wakeUp();
            uav_.wakeUp();
            ground_.modem().power(true, now_);
            uav_.modem().power(true, now_);
            for (uint64_t end = now_ + secondNs; now_ < end; now_ += msNs / 2)
                step(0);
        }
        if (!ground_.isUp() || !uav_.isUp())
            throw Fault("the link does not come back in good weather");
        if (!ground_.isQuiet() || !uav_.isQuiet())
            throw Fault("messages are neither delivered nor reported in good weather");
    }
    const Totals& totals() const { return totals_; }
    uint64_t hostile() const { return attacker_.sent(); }
    double seconds() const { return static_cast<double>(now_) / 1e9; }
    const RfChannel::Counters& air() const { return air_.counters(); }
    uint64_t resent() const {
        return ground_.statistics().fragmentsResent + uav_.statistics().fragmentsResent;
    }

private:
    void step(double rate) {
        air_.advance(now_);
        if (attacked_) {
            attacker_.advance(now_);
            if (rate > 0 && random_.chance(0.01))
                attacker_.doMischief(now_);
        }
        ground_.advance(now_, rate);
        uav_.advance(now_, rate);
    }
    void weather() {
        if (random_.below(8))
            return;
        air_.weather = RfWeather::drawn(random_, 40);
        attacker_.hinder(attacked_ && random_.below(2));
        air_.weather.delayNs = random_.below(2) ? 0 : random_.below(20) * msNs;
        rate_ = random_.below(3)
                    ? 0.02
                    : 0.2; // messages a half millisecond: light, or more than it carries
    }
    void misfortune() {
        End& end = random_.below(2) ? ground_ : uav_;
        switch (random_.below(60)) {
        case 0:
            ++totals_.reboots;
            end.boot(now_);
            break;
        case 1:
            ++totals_.modemResets;
            end.modem().resetPin(true, now_);
            end.modem().resetPin(false, now_ + 1000);
            break;
        case 2:
            end.modem().power(false, now_); // for a second at least
            break;
        default:
            ground_.modem().power(true, now_);
            uav_.modem().power(true, now_);
        }
    }

    Random random_;
    RfChannel air_;
    Totals totals_;
    const bool attacked_;
    Attacker attacker_;
    End ground_, uav_;
    uint64_t now_ = 0;
    double rate_ = 0.1;
};

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

void report(const Soak& soak, Clock::time_point start) {
    const Totals& t = soak.totals();
    const RfChannel::Counters& air = soak.air();
    fmt::print("soak: {:7.0f} s simulated in {:4.0f} s: {} messages sent, {} received, {} "
               "delivered, {} reported unknown; {} reboots, {} modem resets; {} packets, {} lost, "
               "{} spoilt, {} doubled\n",
               soak.seconds(), secondsSince(start), t.sent, t.received, t.delivered, t.unknown,
               t.reboots, t.modemResets, air.packets, air.lost, air.corrupted, air.duplicated);
    std::fflush(stdout);
}

// Goes on for these minutes, or for `messages` if there are any.
void endure(Soak& soak, double minutes, uint64_t messages, Clock::time_point start) {
    double said = 0;
    for (int second = 1;
         messages ? soak.totals().sent < messages : secondsSince(start) < minutes * 60; ++second) {
        soak.second();
        if (second % 600 == 0)
            soak.settle();
        if (secondsSince(start) - said >= 15) {
            said = secondsSince(start);
            report(soak, start);
        }
    }
    soak.settle();
    const Totals& t = soak.totals();
    if (t.delivered + t.unknown != t.sent)
        throw Fault("delivered and reported messages are not all that were sent");
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app{"Endurance of the radio link: two link layers, two modems and a bad radio, faster "
                 "than the clock.\n"
                 "Ends with status 1, the seed and the second at the first message that is wrong, "
                 "doubled, out of\n"
                 "order, or neither delivered nor reported."};
    double minutes = 3;
    uint64_t seed = testSeed(), messages = 0;
    app.add_option("--minutes", minutes, "of the wall clock to go on for")
        ->check(CLI::PositiveNumber);
    app.add_option("--messages", messages,
                   "number of messages after which it stops instead, however long that takes");
    app.add_option("--seed", seed, "of everything that happens (default: $SEED, or 1)");
    bool attacked = false;
    app.add_flag("--attacked", attacked, "by a third modem that has no key; the two have one");
    CLI11_PARSE(app, argc, argv);
    const auto start = Clock::now();
    Soak soak(seed, attacked);
    try {
        endure(soak, minutes, messages, start);
    } catch (const Fault& fault) {
        report(soak, start);
        fmt::print(stderr, "soak: error: {} (seed {}, second {:.3f})\n", fault.what(), seed,
                   soak.seconds());
        return 1;
    }
    report(soak, start);
    if (attacked)
        fmt::print("soak: {} hostile packets\n", soak.hostile());
    fmt::print("soak: none wrong, none doubled, none out of order, each delivered or reported\n");
    return 0;
}
