// SPDX-License-Identifier: MIT
//
// soak: tests link layers over XBee models in API mode and a bad radio link, for any duration.
// There are one vehicle and one ground station, or several (--vehicles, --grounds); each ground
// station communicates with all vehicles. Random messages are sent in both directions. The radio
// loses, corrupts and duplicates packets, also in bursts. Vehicles, ground stations and modems
// restart, and some are out of reach for a while.
//
// With --attacked, or with several vehicles, each pair of ground station and vehicle has a separate
// key. A hostile modem listens, forges packets and sends noise, a second vehicle uses the address
// of another one, and keys are changed. With several vehicles, there is also a second program with
// the address and the keys of the first ground station, and both programs believe that they control
// the vehicles.
//
// No message may be wrong, duplicated, out of order or received by the wrong end, and each message
// must be delivered or reported as lost. The first error ends the program.

#include "attacker.h"
#include "ends.h"
#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>

namespace {

// Simulates the air with all ends, and injects faults.
class Soak {
public:
    Soak(uint64_t seed, bool attacked, int vehicles, int grounds)
        : random_(seed), air_(seed + 1), attacked_(attacked || vehicles * grounds > 1),
          attacker_(air_, seed + 2) {
        std::vector<int> all[2]; // addresses of the vehicles, and of the ground stations
        for (int i = 0; i < vehicles; ++i)
            all[0].push_back(1 + i);
        for (int i = 0; i < grounds; ++i)
            all[1].push_back(i ? 0x00F0 + i : 0);
        const auto addMail = [this](int from, int to) {
            mail_.emplace(std::pair(from, to), Mail(from, to, totals_));
        };
        for (int vehicle : all[0])
            for (int ground : all[1]) {
                addMail(vehicle, ground);
                addMail(ground, vehicle);
            }
        isFleet_ = mail_.size() > 2;
        for (int vehicle : all[0])
            addMail(End::rival, vehicle);
        const auto mailOf = [this](int from, int to) {
            const auto mail = mail_.find({from, to});
            return mail == mail_.end() ? nullptr : &mail->second;
        };
        for (bool isGround : {false, true})
            for (int address : all[isGround])
                ends_.push_back(std::make_unique<End>(air_, random_, address, isGround,
                                                      all[!isGround], mailOf));
        vehicles_ = all[0].size();
        grounds_ = all[1].size();
        ends_.push_back(std::make_unique<End>(air_, random_, all[0].back(), false, all[1],
                                              [](int, int) { return nullptr; }));
        if (isFleet_)
            ends_.push_back(std::make_unique<End>(air_, random_, End::rival, true, all[0], mailOf));
        for (auto& end : ends_)
            end->boot(now_, attacked_);
        sendGuestsAway();
    }
    // Simulates one second with random events.
    void second() {
        weather();
        misfortune();
        pass(rate_ / static_cast<double>(2 * vehicles_ * grounds_));
    }
    // Simulates good conditions without new messages, until all pending messages have been
    // reported.
    void settle() {
        air_.weather = {};
        attacker_.hinder(false);
        sendGuestsAway();
        babblesUntil_ = 0;
        for (int s = 0; s < 120 && !isWell(); ++s) {
            for (size_t host = 0; host < vehicles_ + grounds_; ++host) {
                ends_[host]->awayUntil = 0;
                ends_[host]->wakeUp();
                ends_[host]->modem.power(true, now_);
            }
            pass(0);
        }
        if (!isWell())
            throw Fault("with a good channel, a link does not recover, or a message is lost "
                        "without a report");
    }
    const Totals& totals() const { return totals_; }
    uint64_t hostile() const { return attacker_.sent(); }
    double seconds() const { return static_cast<double>(now_) / 1e9; }
    const RfChannel::Counters& air() const { return air_.counters(); }

private:
    // Switches a guest on if it is off, and off if it is on. The outcome of its pending messages is
    // then unknown. Returns 1 if the guest was switched on, otherwise 0.
    unsigned visit(size_t number) {
        End& guest = *ends_[vehicles_ + grounds_ + number];
        const bool comes = guest.isGone();
        if (!comes)
            guest.boot(now_, attacked_);
        guest.awayUntil = comes ? 0 : never;
        guest.modem.power(comes, now_);
        return comes;
    }
    void sendGuestsAway() {
        for (size_t at = vehicles_ + grounds_; at < ends_.size(); ++at)
            if (!ends_[at]->isGone())
                visit(at - vehicles_ - grounds_);
    }
    bool isWell() const {
        return std::all_of(ends_.begin(), ends_.end(),
                           [](auto& end) { return end->isGone() || end->isWell(); });
    }
    // Simulates one second, in which the programs and the attacker act every millisecond.
    void pass(double rate) {
        for (const uint64_t end = now_ + secondNs; now_ < end;) {
            air_.advance(now_);
            uint64_t next = std::min(nextWork_, end);
            if (attacked_) {
                attacker_.advance(now_);
                next = std::min(next, attacker_.nextEvent());
            }
            for (auto& e : ends_)
                next = e->isGone() ? next : std::min(next, e->advance(now_));
            if (now_ >= nextWork_)
                work(rate);
            now_ = std::max(now_ + 1, std::min(next, air_.nextEvent()));
        }
    }
    void work(double rate) {
        nextWork_ = now_ + msNs;
        for (auto& end : ends_)
            if (!end->isGone())
                end->work(rate);
        if (attacked_ && rate > 0 && random_.chance(now_ < babblesUntil_ ? 0.1 : 0.02))
            attacker_.doMischief(now_);
    }
    void weather() {
        if (random_.below(8))
            return;
        air_.weather = RfWeather::drawn(random_, 40);
        attacker_.hinder(attacked_ && !isFleet_ && random_.below(2));
        air_.weather.delayNs = random_.below(2) ? 0 : random_.below(20) * msNs;
        // messages per ms: in most cases a low rate, otherwise more than the air can carry. In a
        // fleet an eighth of this, because many links share the air.
        rate_ = (random_.below(3) ? 0.08 : 0.8) / (isFleet_ ? 8 : 1);
    }
    // Ends absences that are over. Then in some seconds injects a random fault at one of the ends;
    // the more ends there are, the more often.
    void misfortune() {
        for (auto& end : ends_)
            if (end->awayUntil && end->awayUntil <= now_) {
                end->awayUntil = 0;
                end->modem.power(true, now_);
            }
        const auto hosts = static_cast<uint32_t>(vehicles_ + grounds_);
        if (random_.below(60) >= 2 * hosts)
            return;
        End& end = *ends_[random_.below(hosts)];
        switch (random_.below(isFleet_ ? 7 : attacked_ ? 6 : 3)) {
        case 0:
            ++totals_.reboots; // reboot of a vehicle, or of the program on the ground
            end.boot(now_, attacked_);
            break;
        case 1:
            ++totals_.modemResets;
            end.modem.resetPin(true, now_);
            end.modem.resetPin(false, now_ + 1000);
            break;
        case 2:
            // an end is out of reach for a second, or for up to 39 s, which may end its session
            ++totals_.absences;
            end.modem.power(false, now_);
            end.awayUntil = now_ + (random_.below(3) ? 1 : random_.below(40)) * secondNs;
            break;
        case 3:
            ++totals_.babbles;
            babblesUntil_ = now_ + random_.below(5) * secondNs;
            break;
        case 4:
            totals_.twins += visit(0);
            break;
        case 5:
            changeKey();
            break;
        // a rival of the first ground station appears, while the first one still believes that it
        // controls the vehicles
        case 6:
            totals_.rivals += visit(1);
        }
    }
    // Gives a ground station the next key of a vehicle; the vehicle gets this key some time later.
    void changeKey() {
        const size_t vehicle = random_.below(static_cast<uint32_t>(vehicles_));
        const size_t ground = random_.below(static_cast<uint32_t>(grounds_));
        End &v = *ends_[vehicle], &g = *ends_[vehicles_ + ground];
        if (g.keyOf(vehicle) == v.keyOf(ground)) {
            if (ground == 0 && isFleet_)
                ends_.back()->takeNextKey(vehicle);
            return g.takeNextKey(vehicle);
        }
        v.takeNextKey(ground);
        ++totals_.keys;
    }

    Random random_;
    RfChannel air_;
    Totals totals_;
    const bool attacked_;
    Attacker attacker_;
    std::map<std::pair<int, int>, Mail> mail_;
    // All ends: the vehicles, the ground stations, and guests. The guests are a vehicle with the
    // address of another vehicle and other keys and, in a fleet, a ground station with the address
    // and the keys of the first one.
    std::vector<std::unique_ptr<End>> ends_;
    size_t vehicles_, grounds_;
    bool isFleet_ = false;
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
        "grounds taken over, {} babbles; {} packets, {} lost, {} spoilt, {} doubled, {} hostile\n",
        soak.seconds(), secondsSince(start), t.sent, t.received, t.delivered, t.unknown, t.reboots,
        t.modemResets, t.absences, t.keys, t.twins, t.rivals, t.babbles, air.packets, air.lost,
        air.corrupted, air.duplicated, soak.hostile());
    std::fflush(stdout);
}

// Repeats the soak until `isDone` returns true.
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
    app.add_option("--minutes", minutes, "duration in wall-clock minutes")
        ->check(CLI::PositiveNumber);
    app.add_option("--messages", messages, "number of messages to send, instead of --minutes");
    app.add_option("--seconds", seconds, "duration in simulated seconds, instead of --minutes");
    app.add_option("--seed", seed, "seed of all random numbers (default: $SEED, or 1)");
    app.add_option("--vehicles", vehicles, "number of vehicles")->check(CLI::Range(1, 32));
    app.add_option("--grounds", grounds, "number of ground stations; each calls all vehicles")
        ->check(CLI::Range(1, 8));
    app.add_flag("--attacked", attacked,
                 "attack with a modem without keys; always on with several vehicles or grounds");
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
