// SPDX-License-Identifier: MIT
//
// rf_channel: packets in flight.

#include "rf_channel.h"
#include <algorithm>

namespace {

constexpr uint64_t ccaNs = 128'000, turnaroundNs = 192'000, backoffUnitNs = 320'000;
constexpr unsigned longestBackoff = 5, mostBackoffs = 4; // 802.15.4: macMaxBE, macMaxCSMABackoffs

} // namespace

uint64_t RfChannel::airTimeNs(size_t bytes) {
    // CCA, turnaround, 19 bytes of PHY and MAC header at 250 kbit/s, acknowledgement, LIFS.
    return ccaNs + turnaroundNs + (19 + bytes) * 32'000 + 544'000 + 640'000;
}

void RfChannel::leave(XBee* modem) {
    modems_.erase(std::remove(modems_.begin(), modems_.end(), modem), modems_.end());
    for (auto& [time, flight] : events_)
        if (flight.sender == modem)
            flight.sender = nullptr;
}

RfChannel::Outcome RfChannel::fate() {
    inBurst_ = weather.burstBegin > 0 &&
               (inBurst_ ? !random_.chance(weather.burstEnd) : random_.chance(weather.burstBegin));
    if (random_.chance(inBurst_ ? weather.burstLoss : weather.loss))
        return Outcome::Lost;
    return random_.chance(weather.corruption) ? Outcome::Corrupted : Outcome::Delivered;
}

void RfChannel::transmit(XBee* sender, RfPacket packet, uint64_t now) {
    ++counters_.packets;
    counters_.bytes += packet.bytes.size();
    uint64_t air = airTimeNs(packet.bytes.size());
    Outcome outcome = fate();
    bool doubled = weather.duplication > 0 && random_.chance(weather.duplication);
    unsigned tries = packet.tries;
    Flight flight{sender, std::move(packet), tries - 1, outcome, false, false, 0, 0, nullptr};
    if (doubled && outcome != Outcome::Lost) {
        ++counters_.duplicated;
        Flight copy = flight;
        copy.again = true;
        events_.emplace(now + 2 * air + weather.delayNs, std::move(copy));
    }
    start(std::move(flight), now);
}

// With RN there is a random wait before the first carrier sense already.
void RfChannel::start(Flight flight, uint64_t now) {
    flight.backoffs = 0;
    if (!weather.contention || !flight.packet.backoff)
        return begin(std::move(flight), now);
    flight.begins = true;
    uint64_t wait = random_.below(1u << flight.packet.backoff) * backoffUnitNs;
    events_.emplace(now + wait, std::move(flight));
}

// One try: at once, or, where modems share the channel, when it is clear. Two that begin within the
// time from carrier sense to the first symbol do not hear each other.
void RfChannel::begin(Flight flight, uint64_t now) {
    uint64_t air = airTimeNs(flight.packet.bytes.size()), extra = weather.delayNs;
    flight.begins = false;
    if (weather.contention) {
        onAir_.remove_if([&](auto& other) { return other->end <= now; });
        auto mine = std::make_shared<OnAir>();
        mine->channel = flight.packet.channel;
        mine->begin = now + ccaNs + turnaroundNs;
        mine->end = now + air;
        bool busy = false;
        for (auto& other : onAir_)
            busy = busy || (other->channel == mine->channel && other->begin < now + ccaNs);
        if (busy && flight.backoffs++ == mostBackoffs)
            return finish(flight, Outcome::NoClearChannel, now);
        if (busy) {
            unsigned exponent = std::min(flight.packet.backoff + flight.backoffs, longestBackoff);
            uint64_t wait = (1 + random_.below(1u << exponent)) * backoffUnitNs;
            flight.begins = true;
            events_.emplace(now + wait, std::move(flight));
            return;
        }
        for (auto& other : onAir_)
            if (other->channel == mine->channel) {
                if (!mine->collided)
                    ++counters_.collisions;
                other->collided = mine->collided = true;
            }
        onAir_.push_back(mine);
        flight.onAir = mine;
    }
    counters_.airNs += air;
    events_.emplace(now + air + extra, std::move(flight));
}

void RfChannel::retry(Flight flight, uint64_t now) {
    --flight.triesLeft;
    ++flight.unanswered;
    ++counters_.retries;
    start(std::move(flight), now - weather.delayNs);
}

void RfChannel::finish(Flight& flight, Outcome outcome, uint64_t now) {
    counters_.lost += outcome == Outcome::Lost;
    counters_.noClearChannel += outcome == Outcome::NoClearChannel;
    if (listener_)
        listener_(now, flight.packet, outcome);
    if (!flight.sender || flight.again)
        return;
    bool arrived = outcome == Outcome::Delivered || outcome == Outcome::Corrupted;
    XBee::Fate fate = outcome == Outcome::NoClearChannel       ? XBee::Fate::NoClearChannel
                      : arrived || !flight.packet.acknowledged ? XBee::Fate::Sent
                                                               : XBee::Fate::NoAck;
    // Residual loss stands for tries that all failed.
    unsigned unanswered = outcome == Outcome::Lost && flight.packet.acknowledged
                              ? flight.packet.tries
                              : flight.unanswered;
    flight.sender->transmitted(now, fate, unanswered);
}

RfChannel::Outcome RfChannel::deliver(Flight& flight, uint64_t now) {
    bool found = false, taken = false;
    for (XBee* modem : modems_) {
        if (modem == flight.sender || !modem->hears(flight.packet))
            continue;
        found = true;
        taken = modem->receive(flight.packet, now) || taken;
    }
    return !found ? Outcome::Nobody : !taken ? Outcome::NoRoom : flight.outcome;
}

void RfChannel::land(Flight flight, uint64_t now) {
    bool mayRetry = flight.triesLeft > 0 && !flight.again;
    bool missed = flight.onAir && flight.onAir->collided;
    flight.onAir.reset();
    if (flight.outcome == Outcome::Lost)
        return finish(flight, Outcome::Lost, now);
    if (missed || (weather.tryLoss > 0 && random_.chance(weather.tryLoss))) {
        if (mayRetry)
            return retry(std::move(flight), now);
        return finish(flight, Outcome::Lost, now);
    }
    if (flight.outcome == Outcome::Corrupted) {
        ++counters_.corrupted;
        auto& bytes = flight.packet.bytes;
        bytes[random_.below(static_cast<uint32_t>(bytes.size()))] ^=
            static_cast<uint8_t>(1 + random_.below(255));
    }
    Outcome outcome = deliver(flight, now);
    bool unheard = flight.packet.acknowledged && outcome == flight.outcome && weather.ackLoss > 0 &&
                   random_.chance(weather.ackLoss);
    if ((outcome == Outcome::NoRoom || unheard) && mayRetry) {
        flight.outcome = Outcome::Delivered;
        return retry(std::move(flight), now);
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
