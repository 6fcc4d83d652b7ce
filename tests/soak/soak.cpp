// SPDX-License-Identifier: MIT
//
// soak: link layers over XBee models in API mode and a bad radio, for any time: one vehicle and one
// ground, or --vehicles and --grounds, each of which talks to all of the others. Random messages
// both ways; loss, bursts, corruption, duplication; reboots of vehicles, grounds and modems; some
// that are away for a while. With --attacked, or of several, each pair has a key of its own, and a
// hostile modem listens, lies and babbles; a second vehicle comes with the address of another; keys
// are changed. No message may be wrong, doubled, out of order or at another, and each is delivered
// or reported: the first violation ends the program.

#include "attacker.h"
#include "ice_messages.h"
#include "modem_pair.h"
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <fmt/format.h>
#include <unordered_map>

namespace {

using Bytes = std::vector<uint8_t>;

constexpr uint64_t msNs = 1'000'000, secondNs = 1000 * msNs;

class Fault : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

struct Totals {
    uint64_t sent = 0, delivered = 0, unknown = 0, received = 0;
    uint64_t reboots = 0, modemResets = 0, absences = 0, twins = 0, keys = 0, babbles = 0;
};

// What one end sends to another: messages with numbers, of which a channel has each fourth one.
class Mail {
public:
    Mail(int from, int to, Totals& totals) : from_(from), to_(to), totals_(totals) {}
    // The next message, until `sent`.
    Bytes next() const { return message(next_); }
    U32 number() const { return next_; }
    int channel() const { return static_cast<int>(next_ % LINK_CHANNELS); }
    void sent() {
        outstanding_.emplace(next_++, false);
        ++totals_.sent;
    }
    void report(uint32_t id, Link_Outcome outcome) {
        auto it = outstanding_.find(id);
        if (it == outstanding_.end())
            fault("reported twice, or never sent", id);
        if (outcome == LINK_DELIVERED && !it->second)
            fault("reported delivered, and it was not", id);
        ++(outcome == LINK_DELIVERED ? totals_.delivered : totals_.unknown);
        outstanding_.erase(it);
    }
    // Messages on their way at the power's loss: their program calls them unknown.
    void forget() {
        totals_.unknown += outstanding_.size();
        outstanding_.clear();
    }
    // Checks a message for its receiver: it is the next or a later one of this mail and channel,
    // and whole.
    void arrived(int channel, const Bytes& bytes) {
        uint32_t& expected = expected_[channel];
        uint32_t id = expected;
        while (id < next_ && bytes != message(id))
            id += LINK_CHANNELS;
        if (id >= next_)
            fault("or one before it arrived wrong, twice, out of order, or is another's", expected);
        auto it = outstanding_.find(id);
        if (it != outstanding_.end())
            it->second = true;
        // A skipped message must no longer be on its way for the sender.
        for (; expected < id; expected += LINK_CHANNELS)
            if (outstanding_.count(expected))
                fault("was skipped", expected);
        expected += LINK_CHANNELS;
        ++totals_.received;
    }
    bool isQuiet() const { return outstanding_.empty(); }

private:
    [[noreturn]] void fault(const std::string& what, uint32_t id) const {
        throw Fault(fmt::format("from 0x{:04x} to 0x{:04x}: message {} {}", from_, to_, id, what));
    }
    // Every byte follows from the sides and the number.
    Bytes message(uint32_t id) const {
        Random r(uint64_t(from_) << 48 | uint64_t(to_) << 32 | id);
        uint32_t kind = r.below(10);
        uint32_t size = r.below(40) ? r.below(60) : r.below(LINK_MAX_MESSAGE - 100);
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

    const int from_, to_;
    Totals& totals_;
    uint32_t next_ = 0, expected_[LINK_CHANNELS] = {0, 1, 2, 3};
    std::unordered_map<uint32_t, bool> outstanding_; // not reported, with whether it has arrived
};

// A vehicle or a ground, and its program. It knows what others send only to check it.
class End : public ModemEnd {
public:
    using MailOf = std::function<Mail*(int from, int to)>; // null: nothing may arrive
    End(RfChannel& air, Random& random, int address, bool isGround, const std::vector<int>& targets,
        const MailOf& mailOf)
        : ModemEnd(air, options(address), random.next(), targets), random_(random),
          isGround_(isGround), address_(address), keys_(targets.size(), 0) {
        for (int target : targets) {
            in_.push_back(mailOf(target, address));
            out_.push_back(mailOf(address, target));
        }
    }
    // `hasKeys`: one of each vehicle and ground, with the number of its changes.
    void boot(uint64_t now, bool hasKeys) {
        now_ = now;
        begin();
        for (size_t peer = 0; peer < peers(); ++peer) {
            if (out_[peer])
                out_[peer]->forget();
            if (hasKeys)
                setKey(peer, keys_[peer], true);
            if (hasKeys && isGround_ && keys_[peer])
                setKey(peer, keys_[peer] - 1, true);
            Link_start(link(peer), us());
        }
    }
    unsigned keyOf(size_t peer) const { return keys_[peer]; } // its number
    // The ground has two keys, the present and the next one; the vehicle's session ends.
    void takeNextKey(size_t peer) {
        setKey(peer, ++keys_[peer], true);
        if (!isGround_)
            setKey(peer, keys_[peer] - 1, false);
    }
    // Makes one step of a program: with this chance it sends a message to each peer.
    void work(double rate) {
        for (size_t peer = 0; peer < peers(); ++peer)
            if (out_[peer] && isUp(peer) && random_.chance(rate))
                offer(peer);
        if (random_.chance(0.002))
            isBusy_ = random_.chance(0.1); // takes no message for a while
    }
    bool isWell() const {
        for (size_t peer = 0; peer < peers(); ++peer)
            if (!isUp(peer) || !out_[peer]->isQuiet())
                return false;
        return true;
    }
    void wakeUp() { isBusy_ = false; }
    uint64_t awayUntil = 0;

private:
    static XBee::Options options(int address) {
        XBee::Options o = modemOptions(static_cast<unsigned>(address), false, 2, true);
        o.name = fmt::format("0x{:04x}", address);
        o.set["DL"] = 0;
        return o;
    }
    void setKey(size_t peer, unsigned number, bool isGiven) {
        const int vehicle = isGround_ ? target(peer) : address_;
        const int ground = isGround_ ? address_ : target(peer);
        const U8 key[LINK_KEY_BYTES] = {static_cast<U8>(vehicle), static_cast<U8>(ground),
                                        static_cast<U8>(number), static_cast<U8>(!out_[peer])};
        Link_setKey(link(peer), number % 2, isGiven ? key : nullptr,
                    static_cast<U32>(vehicle) | (isGround_ ? LINK_GROUND : 0));
    }
    void offer(size_t peer) {
        Mail& mail = *out_[peer];
        const Bytes m = mail.next();
        const auto status = Link_send(link(peer), mail.channel(), m.data(),
                                      static_cast<U32>(m.size()), mail.number());
        if (status == LINK_CLOSED)
            Link_openChannel(link(peer), mail.channel());
        else if (status == LINK_OK)
            mail.sent();
    }
    void onOutcome(size_t peer, U32 id, Link_Outcome outcome) override {
        out_[peer]->report(id, outcome);
    }
    // The link's and the program's acceptance of a message are one step here, unless the program is
    // busy.
    int onMessage(size_t peer, int channel, const U8* data, U32 size) override {
        if (isBusy_)
            return 1;
        if (!in_[peer])
            throw Fault(modem.name() + ": a message came to another one of this address");
        in_[peer]->arrived(channel, Bytes(data, data + size));
        return 0;
    }

    Random& random_;
    const bool isGround_;
    const int address_;
    std::vector<Mail*> in_, out_; // of each peer
    std::vector<unsigned> keys_;  // how often each was changed
    bool isBusy_ = false;
};

class Soak {
public:
    Soak(uint64_t seed, bool attacked, int vehicles, int grounds)
        : random_(seed), air_(seed + 1), attacked_(attacked || vehicles * grounds > 1),
          attacker_(air_, seed + 2) {
        std::vector<int> all[2]; // addresses of vehicles, of grounds
        for (int i = 0; i < vehicles; ++i)
            all[0].push_back(1 + i);
        for (int i = 0; i < grounds; ++i)
            all[1].push_back(i ? 0x00F0 + i : 0);
        for (int vehicle : all[0])
            for (int ground : all[1])
                for (auto [from, to] : {std::pair(vehicle, ground), std::pair(ground, vehicle)})
                    mail_.emplace(std::pair(from, to), Mail(from, to, totals_));
        for (bool isGround : {false, true})
            for (int address : all[isGround])
                ends_.push_back(std::make_unique<End>(
                    air_, random_, address, isGround, all[!isGround],
                    [this](int from, int to) { return &mail_.at({from, to}); }));
        vehicles_ = all[0].size();
        twin_ = std::make_unique<End>(air_, random_, all[0].back(), false, all[1],
                                      [](int, int) { return nullptr; });
        for (auto& end : ends_)
            end->boot(now_, attacked_);
        twin_->boot(now_, attacked_);
        twin_->awayUntil = never;
        twin_->modem.power(false, now_);
    }
    // Passes one simulated second with random events.
    void second() {
        weather();
        misfortune();
        pass(rate_ / static_cast<double>(mail_.size()));
    }
    // Good weather, nothing new: everything that is under way must be reported.
    void settle() {
        air_.weather = {};
        attacker_.hinder(false);
        twin_->modem.power(false, now_);
        twin_->awayUntil = never;
        babblesUntil_ = 0;
        for (auto& end : ends_)
            end->awayUntil = 0;
        for (int s = 0; s < 120 && !isWell(); ++s) {
            for (auto& end : ends_) {
                end->wakeUp();
                end->modem.power(true, now_);
            }
            pass(0);
        }
        if (!isWell())
            throw Fault("in good weather a link does not come back, or a message is neither "
                        "delivered nor reported");
    }
    const Totals& totals() const { return totals_; }
    uint64_t hostile() const { return attacker_.sent(); }
    double seconds() const { return static_cast<double>(now_) / 1e9; }
    const RfChannel::Counters& air() const { return air_.counters(); }

private:
    bool isWell() const {
        return std::all_of(ends_.begin(), ends_.end(), [](auto& end) { return end->isWell(); });
    }
    // Passes a second, in which programs and the attacker act each millisecond.
    void pass(double rate) {
        for (const uint64_t end = now_ + secondNs; now_ < end;) {
            air_.advance(now_);
            uint64_t next = std::min(nextWork_, end);
            if (attacked_) {
                attacker_.advance(now_);
                next = std::min(next, attacker_.nextEvent());
            }
            for (auto& e : ends_)
                next = std::min(next, e->advance(now_));
            if (!twin_->awayUntil)
                next = std::min(next, twin_->advance(now_));
            if (now_ >= nextWork_)
                work(rate);
            now_ = std::max(now_ + 1, std::min(next, air_.nextEvent()));
        }
    }
    void work(double rate) {
        nextWork_ = now_ + msNs;
        for (auto& end : ends_)
            end->work(rate);
        if (attacked_ && rate > 0 && random_.chance(now_ < babblesUntil_ ? 0.1 : 0.02))
            attacker_.doMischief(now_);
    }
    void weather() {
        if (random_.below(8))
            return;
        air_.weather = RfWeather::drawn(random_, 40);
        attacker_.hinder(attacked_ && mail_.size() == 2 && random_.below(2));
        air_.weather.delayNs = random_.below(2) ? 0 : random_.below(20) * msNs;
        // messages a ms: light, or more than the air carries, of which many links use more
        rate_ = (random_.below(3) ? 0.08 : 0.8) / (mail_.size() > 2 ? 8 : 1);
    }
    // What may befall one of the ends, more often where there are many.
    void misfortune() {
        for (auto& end : ends_)
            if (end->awayUntil && end->awayUntil <= now_) {
                end->awayUntil = 0;
                end->modem.power(true, now_);
            }
        if (random_.below(60) >= 2 * ends_.size())
            return;
        End& end = *ends_[random_.below(static_cast<uint32_t>(ends_.size()))];
        switch (random_.below(attacked_ ? 6 : 3)) {
        case 0:
            ++totals_.reboots; // of a vehicle, or another program takes the ground over
            end.boot(now_, attacked_);
            break;
        case 1:
            ++totals_.modemResets;
            end.modem.resetPin(true, now_);
            end.modem.resetPin(false, now_ + 1000);
            break;
        case 2:
            ++totals_.absences; // out of reach, for a second or until the session has died
            end.modem.power(false, now_);
            end.awayUntil = now_ + (random_.below(3) ? 1 : random_.below(40)) * secondNs;
            break;
        case 3:
            ++totals_.babbles;
            babblesUntil_ = now_ + random_.below(5) * secondNs;
            break;
        case 4:
            totals_.twins += twin_->awayUntil != 0;
            twin_->awayUntil = twin_->awayUntil ? 0 : never;
            twin_->modem.power(!twin_->awayUntil, now_);
            break;
        case 5:
            changeKey();
        }
    }
    // A ground takes the next key of a vehicle; the vehicle does, some time later.
    void changeKey() {
        const size_t vehicle = random_.below(static_cast<uint32_t>(vehicles_));
        const size_t ground = random_.below(static_cast<uint32_t>(ends_.size() - vehicles_));
        End &v = *ends_[vehicle], &g = *ends_[vehicles_ + ground];
        if (g.keyOf(vehicle) == v.keyOf(ground))
            return g.takeNextKey(vehicle);
        v.takeNextKey(ground);
        ++totals_.keys;
    }

    Random random_;
    RfChannel air_;
    Totals totals_;
    const bool attacked_;
    Attacker attacker_;
    std::map<std::pair<int, int>, Mail> mail_;
    std::vector<std::unique_ptr<End>> ends_; // the vehicles, then the grounds
    size_t vehicles_;
    std::unique_ptr<End> twin_; // has a vehicle's address, and no key of it
    uint64_t now_ = 0, nextWork_ = 0, babblesUntil_ = 0;
    double rate_ = 0.1;
};

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

void report(const Soak& soak, Clock::time_point start) {
    const Totals& t = soak.totals();
    const RfChannel::Counters& air = soak.air();
    fmt::print(
        "soak: {:7.0f} s simulated in {:4.0f} s: {} messages sent, {} received, {} delivered, {} "
        "reported unknown; {} reboots, {} modem resets, {} away, {} keys changed, {} twins, {} "
        "babbles; {} packets, {} lost, {} spoilt, {} doubled, {} hostile\n",
        soak.seconds(), secondsSince(start), t.sent, t.received, t.delivered, t.unknown, t.reboots,
        t.modemResets, t.absences, t.keys, t.twins, t.babbles, air.packets, air.lost, air.corrupted,
        air.duplicated, soak.hostile());
    std::fflush(stdout);
}

// Goes on until `isDone`.
void endure(Soak& soak, const std::function<bool()>& isDone, Clock::time_point start) {
    double said = 0;
    for (int second = 1; !isDone(); ++second) {
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
    CLI::App app{"Endurance of the radio link: link layers, modems and a bad radio, faster than "
                 "the clock.\n"
                 "Ends with status 1, the seed and the second at the first message that is wrong, "
                 "doubled, out of\n"
                 "order, at another, or neither delivered nor reported."};
    double minutes = 3, seconds = 0;
    uint64_t seed = testSeed(), messages = 0;
    int vehicles = 1, grounds = 1;
    bool attacked = false;
    app.add_option("--minutes", minutes, "of the wall clock to go on for")
        ->check(CLI::PositiveNumber);
    app.add_option("--messages", messages,
                   "number of messages after which it stops instead, however long that takes");
    app.add_option("--seconds", seconds, "of simulated time after which it stops instead");
    app.add_option("--seed", seed, "of everything that happens (default: $SEED, or 1)");
    app.add_option("--vehicles", vehicles, "how many")->check(CLI::Range(1, 32));
    app.add_option("--grounds", grounds, "how many, each of which calls all vehicles")
        ->check(CLI::Range(1, 8));
    app.add_flag("--attacked", attacked,
                 "by a modem that has no key, as several vehicles always are; the others have");
    CLI11_PARSE(app, argc, argv);
    const auto start = Clock::now();
    Soak soak(seed, attacked, vehicles, grounds);
    try {
        endure(
            soak,
            [&] {
                return messages  ? soak.totals().sent >= messages
                       : seconds ? soak.seconds() >= seconds
                                 : secondsSince(start) >= minutes * 60;
            },
            start);
    } catch (const Fault& fault) {
        report(soak, start);
        fmt::print(stderr, "soak: error: {} (seed {}, second {:.3f})\n", fault.what(), seed,
                   soak.seconds());
        return 1;
    }
    report(soak, start);
    fmt::print("soak: none wrong, none doubled, none out of order, none at another, each delivered "
               "or reported\n");
    return 0;
}
