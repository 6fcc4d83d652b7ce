// SPDX-License-Identifier: MIT
//
// rf_channel: carries packets between modems, and loses, damages or duplicates some of them.

#include "rf_channel.h"
#include <algorithm>
#include <cmath>

namespace {

constexpr uint64_t burstStepNs = 10'000'000; // duration of a full packet, ns
// sensitivity of the receiver, dBm; -100 for an XBee-PRO
constexpr double sensitivity = -92;
// largest relative deviation of a modem's processing time; not verified on hardware
constexpr double jitter = 0.05;

} // namespace

uint64_t RfChannel::airTimeNs(size_t bytes) {
    RfPacket packet;
    packet.bytes.resize(bytes);
    return RfTimes::tryNs(packet) + RfTimes::gapNs;
}

void RfChannel::leave(RfReceiver* modem) {
    modems_.erase(std::remove(modems_.begin(), modems_.end(), modem), modems_.end());
    for (auto& [time, event] : events_)
        if (event.frame && event.frame->from == modem)
            event.frame->from = nullptr;
    away_.erase(modem);
}

void RfChannel::forget(const RfSender* sender) {
    for (auto at = events_.begin(); at != events_.end();) {
        const bool isMine = at->second.sender == sender;
        if (isMine)
            at->second.sender = nullptr;
        at = isMine && !at->second.frame ? events_.erase(at) : std::next(at);
    }
}

void RfChannel::carryAway(const RfReceiver* modem, bool isAway) {
    if (isAway)
        away_.insert(modem);
    else
        away_.erase(modem);
}

RfChannel::Outcome RfChannel::fate(uint64_t now) {
    // The model of bursts makes one step per packet. After a longer pause it makes one step per
    // burstStepNs of the pause, so that a burst of losses also ends while no modem sends.
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

// Draws the signal strength of one transmission. Returns true if the signal is below the
// sensitivity of the receiver.
bool RfChannel::faded(RfPacket& packet) {
    if (weather.distance <= 0)
        return false;
    double share = (random_.next() + 1.0) / 4294967296.0;
    packet.rssi = weather.meanRssi() + 10 * std::log10(-std::log(share) + 1e-9);
    return packet.rssi < sensitivity;
}

RfChannel::Outcome RfChannel::announce(const RfReceiver& from, RfPacket& packet, uint64_t now) {
    ++counters_.packets;
    counters_.bytes += packet.bytes.size();
    if (weather.trace)
        packet.rssi = weather.trace->at(now).rssi;
    else if (weather.distance > 0)
        packet.rssi = weather.meanRssi();
    const Outcome drawn = fate(now);
    const bool isDoubled = weather.duplication > 0 && random_.chance(weather.duplication);
    if (isDoubled && drawn != Outcome::Lost) {
        ++counters_.duplicated;
        auto copy = std::make_shared<Frame>(Frame{packet, drawn, &from, 0, 0, 0});
        const uint64_t later = 2 * (RfTimes::tryNs(packet) + RfTimes::gapNs) + delayNs(now);
        events_.emplace(now + later, Event{nullptr, std::move(copy)});
    }
    return drawn;
}

uint64_t RfChannel::jittered(uint64_t ns) {
    double share = 1 + jitter * (2.0 * random_.next() / 4294967296.0 - 1);
    return weather.perfect ? 0 : static_cast<uint64_t>(static_cast<double>(ns) * share);
}

bool RfChannel::isClear(uint8_t channel, uint64_t from, uint64_t to) const {
    if (weather.perfect)
        return true;
    if (weather.interferes(from, to))
        return false;
    return std::none_of(onAir_.begin(), onAir_.end(), [&](const auto& other) {
        return other->packet.channel == channel && other->begin < to && other->over() > from;
    });
}

// Starts a transmission. Two modems do not hear each other if both start within the time from
// carrier sense to the first symbol. A modem cannot receive while it sends.
void RfChannel::put(RfSender& sender, const RfReceiver& from, RfPacket packet, Outcome drawn,
                    uint64_t now) {
    const uint64_t end = now + RfTimes::tryNs(packet);
    const uint64_t frameEnd = packet.acknowledged ? end - RfTimes::ackNs : end;
    const uint64_t begin = now + RfTimes::ccaNs + RfTimes::turnaroundNs;
    auto mine =
        std::make_shared<Frame>(Frame{std::move(packet), drawn, &from, begin, frameEnd, end});
    if (!weather.perfect) {
        onAir_.remove_if([&](auto& other) { return other->over() <= now; });
        for (auto& other : onAir_)
            if (other->packet.channel == mine->packet.channel) {
                if (!mine->collided)
                    ++counters_.collisions;
                other->collided = mine->collided = true;
            }
        mine->collided = mine->collided || weather.interferes(mine->begin, mine->end);
        onAir_.push_back(mine);
    }
    counters_.airNs += mine->end + RfTimes::gapNs - now;
    events_.emplace(mine->frameEnd + delayNs(now), Event{&sender, mine});
}

void RfChannel::report(uint64_t now, const RfPacket& packet, Outcome outcome) {
    counters_.lost += outcome == Outcome::Lost;
    counters_.noClearChannel += outcome == Outcome::NoClearChannel;
    if (listener_)
        listener_(now, packet, outcome);
}

RfChannel::Outcome RfChannel::deliver(const Frame& frame, uint64_t now) {
    Outcome outcome = Outcome::Nobody;
    for (RfReceiver* modem : modems_) {
        if (modem == frame.from || !modem->hears(frame.packet) || away_.count(modem) ||
            away_.count(frame.from))
            continue;
        RfReceiver::Reception reception = modem->receive(frame.packet, now);
        if (reception == RfReceiver::Reception::Taken)
            outcome = frame.drawn;
        else if (reception == RfReceiver::Reception::NoRoom && outcome == Outcome::Nobody)
            outcome = Outcome::NoRoom;
    }
    return outcome;
}

bool RfChannel::isMissed(Frame& frame) {
    return frame.drawn == Outcome::Lost || faded(frame.packet) || frame.collided ||
           (weather.tryLoss > 0 && random_.chance(weather.tryLoss));
}

// Ends a transmission: delivers the packet to the receiver.
void RfChannel::land(RfSender* sender, Frame& frame, uint64_t now) {
    const bool missed = isMissed(frame);
    if (frame.drawn == Outcome::Corrupted && !missed) {
        ++counters_.corrupted;
        auto& bytes = frame.packet.bytes;
        bytes[random_.below(static_cast<uint32_t>(bytes.size()))] ^=
            static_cast<uint8_t>(1 + random_.below(255));
    }
    const Outcome outcome = missed ? Outcome::Lost : deliver(frame, now);
    // A modem acknowledges a packet even if it then drops the packet because its buffer is full.
    const bool isHeard = outcome != Outcome::Lost && outcome != Outcome::Nobody;
    const bool isAnswered = isHeard && !(weather.ackLoss > 0 && random_.chance(weather.ackLoss));
    if (sender)
        sender->ended(now, frame.packet, outcome, isAnswered);
    else
        report(now, frame.packet, outcome);
}

void RfChannel::advance(uint64_t now) {
    while (!events_.empty() && events_.begin()->first <= now) {
        const auto [at, event] = *events_.begin();
        events_.erase(events_.begin());
        if (event.frame)
            land(event.sender, *event.frame, at);
        else
            event.sender->wake(at);
    }
}
