// SPDX-License-Identifier: MIT
//
// rf_channel: carries packets through the air, loses, damages and doubles them.

#include "rf_channel.h"
#include <algorithm>
#include <cmath>

namespace {

constexpr uint64_t ccaNs = 128'000, turnaroundNs = 192'000, backoffUnitNs = 320'000;
constexpr uint64_t byteNs = 32'000, ackNs = turnaroundNs + 11 * byteNs, gapNs = 640'000; // LIFS
constexpr uint64_t ackWaitNs = 864'000; // macAckWaitDuration: 54 symbols behind the frame
constexpr unsigned longestBackoff = 5, mostBackoffs = 4; // 802.15.4: macMaxBE, macMaxCSMABackoffs
constexpr uint64_t roundNs = 200'000'000;                // RR: the wait for an acknowledgement
constexpr uint32_t roundSpreadUs = 48'000;               // and at most this much more, at random
constexpr uint64_t burstStepNs = 10'000'000;             // a full packet's time
constexpr double sensitivity = -92;                      // dBm; XBee-PRO: -100
constexpr double jitter = 0.05;                          // share of a modem's own time, unverified

// PHY header, MAC header with 16-bit addresses, checksum: 17 bytes; a 64-bit address adds 6.
size_t frameBytes(const RfPacket& packet) {
    bool longSource = packet.encrypted || packet.from64;
    return 17 + 2u * packet.header + 6u * packet.wide + 6u * longSource + packet.bytes.size();
}

// The time from carrier sense to the end of the acknowledgement.
uint64_t tryNs(const RfPacket& packet) {
    return ccaNs + turnaroundNs + frameBytes(packet) * byteNs + (packet.acknowledged ? ackNs : 0);
}

} // namespace

uint64_t RfChannel::airTimeNs(size_t bytes) {
    RfPacket packet;
    packet.bytes.resize(bytes);
    return tryNs(packet) + gapNs;
}

void RfChannel::leave(XBee* modem) {
    modems_.erase(std::remove(modems_.begin(), modems_.end(), modem), modems_.end());
    for (auto& [time, flight] : events_)
        if (flight.sender == modem)
            flight.sender = nullptr;
}

void RfChannel::carryAway(const XBee* modem, bool isAway) {
    if (isAway)
        away_.insert(modem);
    else
        away_.erase(modem);
}

RfChannel::Outcome RfChannel::fate(uint64_t now) {
    // A step for this packet, and one for each missed packet time: a burst passes while nobody
    // sends, too.
    const uint64_t quiet = std::min<uint64_t>((now - fateAt_) / burstStepNs, 1000);
    fateAt_ = now;
    for (uint64_t steps = std::max<uint64_t>(quiet, 1); weather.burstBegin > 0 && steps; --steps)
        inBurst_ =
            inBurst_ ? !random_.chance(weather.burstEnd) : random_.chance(weather.burstBegin);
    inBurst_ = inBurst_ && weather.burstBegin > 0;
    double loss = weather.trace ? weather.trace->at(now).loss : weather.loss;
    if (random_.chance(inBurst_ ? weather.burstLoss : loss))
        return Outcome::Lost;
    return random_.chance(weather.corruption) ? Outcome::Corrupted : Outcome::Delivered;
}

uint64_t RfChannel::delayNs(uint64_t now) const {
    return weather.trace ? weather.trace->at(now).delayNs : weather.delayNs;
}

// Draws the strength of one try. Returns whether it is below the receiver's sensitivity.
bool RfChannel::faded(RfPacket& packet) {
    if (weather.distance <= 0)
        return false;
    double share = (random_.next() + 1.0) / 4294967296.0;
    packet.rssi = weather.meanRssi() + 10 * std::log10(-std::log(share) + 1e-9);
    return packet.rssi < sensitivity;
}

void RfChannel::transmit(XBee* sender, RfPacket packet, uint64_t now) {
    ++counters_.packets;
    counters_.bytes += packet.bytes.size();
    if (weather.trace)
        packet.rssi = weather.trace->at(now).rssi;
    else if (weather.distance > 0)
        packet.rssi = weather.meanRssi();
    Outcome outcome = fate(now);
    bool doubled = weather.duplication > 0 && random_.chance(weather.duplication);
    Flight flight{sender, packet, packet.tries - 1, packet.rounds, packet.copies - 1, outcome,
                  false,  false};
    if (doubled && outcome != Outcome::Lost) {
        ++counters_.duplicated;
        Flight copy = flight;
        copy.again = true;
        events_.emplace(now + 2 * (tryNs(packet) + gapNs) + delayNs(now), std::move(copy));
    }
    start(std::move(flight), now, std::max(now, sender->busyUntil()));
}

uint64_t RfChannel::jittered(uint64_t ns) {
    double share = 1 + jitter * (2.0 * random_.next() / 4294967296.0 - 1);
    return weather.perfect ? 0 : static_cast<uint64_t>(static_cast<double>(ns) * share);
}

// With RN there is a random wait before the first carrier sense already.
void RfChannel::start(Flight flight, uint64_t now, uint64_t ready) {
    flight.backoffs = 0;
    if (!weather.perfect && flight.packet.backoff)
        ready += random_.below(1u << flight.packet.backoff) * backoffUnitNs;
    if (ready <= now)
        return begin(std::move(flight), now);
    flight.begins = true;
    events_.emplace(ready, std::move(flight));
}

// Makes one try, when the channel is clear. Two modems that begin within the time from carrier
// sense to the first symbol do not hear each other, and none hears while it sends.
void RfChannel::begin(Flight flight, uint64_t now) {
    uint64_t end = now + tryNs(flight.packet);
    flight.begins = false;
    if (flight.sender && flight.sender->busyUntil() > now) {
        flight.begins = true;
        uint64_t ready = flight.sender->busyUntil();
        events_.emplace(ready, std::move(flight));
        return;
    }
    if (!weather.perfect) {
        onAir_.remove_if([&](auto& other) { // nobody acknowledges what has collided
            return (other->collided ? other->frameEnd : other->end) <= now;
        });
        auto mine = std::make_shared<OnAir>();
        mine->channel = flight.packet.channel;
        mine->begin = now + ccaNs + turnaroundNs;
        mine->end = end;
        mine->frameEnd = flight.packet.acknowledged ? end - ackNs : end;
        bool busy = weather.interferes(now, now + ccaNs);
        for (auto& other : onAir_)
            busy = busy || (other->channel == mine->channel && other->begin < now + ccaNs);
        if (busy && flight.backoffs++ == mostBackoffs)
            return finish(flight, Outcome::NoClearChannel, now);
        if (busy) {
            unsigned exponent = std::min(flight.packet.backoff + flight.backoffs, longestBackoff);
            flight.begins = true;
            events_.emplace(now + ccaNs + random_.below(1u << exponent) * backoffUnitNs,
                            std::move(flight));
            return;
        }
        for (auto& other : onAir_)
            if (other->channel == mine->channel) {
                if (!mine->collided)
                    ++counters_.collisions;
                other->collided = mine->collided = true;
            }
        mine->collided = mine->collided || weather.interferes(mine->begin, mine->end);
        onAir_.push_back(mine);
        flight.onAir = mine;
    }
    counters_.airNs += end + gapNs - now;
    events_.emplace(end + gapNs + delayNs(now), std::move(flight));
}

// The MAC's next try, whose random wait begins where that for an acknowledgement has ended, or,
// with RR, the first of its next round.
void RfChannel::retry(Flight flight, uint64_t now) {
    uint64_t ready = now - delayNs(now) - (ackNs + gapNs - ackWaitNs);
    ++counters_.retries;
    if (flight.triesLeft) {
        --flight.triesLeft;
    } else {
        --flight.roundsLeft;
        flight.triesLeft = flight.packet.tries - 1;
        ready += roundNs + random_.below(roundSpreadUs) * 1000ull;
    }
    start(std::move(flight), now, ready);
}

void RfChannel::finish(Flight& flight, Outcome outcome, uint64_t now) {
    counters_.lost += outcome == Outcome::Lost;
    counters_.noClearChannel += outcome == Outcome::NoClearChannel;
    if (listener_)
        listener_(now, flight.packet, outcome);
    if (!flight.sender || flight.again)
        return;
    // A modem acknowledges a packet that its full buffer then drops.
    bool arrived = outcome != Outcome::Lost && outcome != Outcome::Nobody && flight.answered;
    XBee::Fate fate = outcome == Outcome::NoClearChannel       ? XBee::Fate::NoClearChannel
                      : arrived || !flight.packet.acknowledged ? XBee::Fate::Sent
                                                               : XBee::Fate::NoAck;
    // Residual loss stands for tries that all failed.
    unsigned unanswered = !flight.packet.acknowledged ? 0
                          : outcome == Outcome::Lost
                              ? flight.packet.tries * (1 + flight.packet.rounds)
                              : flight.unanswered;
    flight.sender->transmitted(now, fate, unanswered);
}

RfChannel::Outcome RfChannel::deliver(Flight& flight, uint64_t now) {
    Outcome outcome = Outcome::Nobody;
    for (XBee* modem : modems_) {
        if (modem == flight.sender || !modem->hears(flight.packet) || away_.count(modem) ||
            away_.count(flight.sender))
            continue;
        XBee::Reception reception = modem->receive(flight.packet, now);
        if (reception == XBee::Reception::Taken)
            outcome = flight.outcome;
        else if (reception == XBee::Reception::NoRoom && outcome == Outcome::Nobody)
            outcome = Outcome::NoRoom;
    }
    return outcome;
}

void RfChannel::land(Flight flight, uint64_t now) {
    bool mayRetry = (flight.triesLeft || flight.roundsLeft) && !flight.again;
    bool missed = flight.onAir && flight.onAir->collided;
    flight.onAir.reset();
    if (flight.outcome == Outcome::Lost)
        return finish(flight, Outcome::Lost, now);
    missed =
        faded(flight.packet) || missed || (weather.tryLoss > 0 && random_.chance(weather.tryLoss));
    if (missed && mayRetry) {
        ++flight.unanswered;
        return retry(std::move(flight), now);
    }
    if (missed && !flight.copiesLeft)
        return finish(flight, Outcome::Lost, now);
    if (flight.outcome == Outcome::Corrupted && !missed) {
        ++counters_.corrupted;
        auto& bytes = flight.packet.bytes;
        bytes[random_.below(static_cast<uint32_t>(bytes.size()))] ^=
            static_cast<uint8_t>(1 + random_.below(255));
    }
    Outcome outcome = missed ? Outcome::Lost : deliver(flight, now);
    if (flight.copiesLeft && !flight.again) {
        --flight.copiesLeft;
        return start(std::move(flight), now, now);
    }
    flight.answered =
        outcome != Outcome::Nobody && !(weather.ackLoss > 0 && random_.chance(weather.ackLoss));
    if (flight.packet.acknowledged && !flight.answered && !flight.again) {
        ++flight.unanswered;
        if (mayRetry) {
            flight.outcome = Outcome::Delivered;
            return retry(std::move(flight), now);
        }
    }
    finish(flight, outcome, now);
}

void RfChannel::advance(uint64_t now) {
    while (!events_.empty() && events_.begin()->first <= now) {
        Flight flight = std::move(events_.begin()->second);
        uint64_t at = events_.begin()->first;
        events_.erase(events_.begin());
        if (flight.begins)
            begin(std::move(flight), at);
        else
            land(std::move(flight), at);
    }
}
