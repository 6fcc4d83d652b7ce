// SPDX-License-Identifier: MIT
//
// mac: implements carrier sense, tries and rounds of Mac as events on the air.

#include "mac.h"
#include <algorithm>
#include <utility>

namespace {

constexpr uint64_t backoffUnitNs = 320'000;
constexpr uint64_t ackWaitNs = 864'000; // macAckWaitDuration: 54 symbols after the frame, ns
constexpr unsigned longestBackoff = 5, mostBackoffs = 4; // macMaxBE, macMaxCSMABackoffs
// wait for an acknowledgement before the next round (RR), ns
constexpr uint64_t roundNs = 200'000'000;
constexpr uint32_t roundSpreadUs = 48'000; // longest random time added to roundNs, us

} // namespace

void Mac::send(RfPacket packet, uint64_t now) {
    packet_ = std::move(packet);
    roundsLeft_ = packet_.rounds;
    copiesLeft_ = packet_.copies - 1;
    drawn_ = air_.announce(modem_, packet_, now);
    startRound(now, std::max(now, modem_.busyUntil()));
}

void Mac::abort() {
    state_ = State::Idle;
    air_.forget(this);
}

void Mac::startRound(uint64_t now, uint64_t ready) {
    triesLeft_ = packet_.tries;
    startTry(now, ready);
}

// Starts a try. If RN is not 0, a random wait precedes the first carrier sense.
void Mac::startTry(uint64_t now, uint64_t ready) {
    --triesLeft_;
    busySenses_ = 0;
    waitUntil(ready + randomWaitNs(packet_.backoff), now);
}

void Mac::waitUntil(uint64_t at, uint64_t now) {
    state_ = State::Waiting;
    if (at <= now)
        sense(now);
    else
        air_.wakeAt(at, this);
}

uint64_t Mac::randomWaitNs(unsigned exponent) {
    if (exponent == 0 || air_.weather.perfect)
        return 0;
    return air_.below(1u << std::min(exponent, longestBackoff)) * backoffUnitNs;
}

void Mac::sense(uint64_t now) {
    if (modem_.busyUntil() > now)
        return waitUntil(modem_.busyUntil(), now);
    if (air_.isClear(packet_.channel, now, now + RfTimes::ccaNs)) {
        state_ = State::OnAir;
        air_.put(*this, modem_, packet_, drawn_, now);
    } else if (busySenses_++ < mostBackoffs) {
        waitUntil(now + RfTimes::ccaNs + randomWaitNs(packet_.backoff + busySenses_), now);
    } else {
        failed(now, now + RfTimes::ccaNs, Fate::NoClearChannel);
    }
}

void Mac::wake(uint64_t now) {
    if (state_ == State::Waiting)
        sense(now);
    else
        finish(now, fate_);
}

// Handles a try that failed: starts the next try of the round, or with RR the first try of the next
// round.
void Mac::failed(uint64_t now, uint64_t ready, Fate fate) {
    if (triesLeft_) {
        air_.countRetry();
        startTry(now, ready);
    } else if (roundsLeft_) {
        --roundsLeft_;
        air_.countRetry();
        startRound(now, ready + roundNs + air_.below(roundSpreadUs) * 1000ull);
    } else {
        air_.report(now, packet_,
                    fate == Fate::NoClearChannel ? RfOutcome::NoClearChannel : RfOutcome::Lost);
        finish(now, fate);
    }
}

void Mac::ended(uint64_t now, const RfPacket& arrived, RfOutcome outcome, bool isAnswered) {
    const bool isLost = outcome == RfOutcome::Lost || outcome == RfOutcome::Nobody;
    // if Lost was drawn for the whole packet, all of its tries have failed
    const bool isDrawnLost = drawn_ == RfOutcome::Lost;
    if (packet_.acknowledged && !isAnswered && !isDrawnLost && (triesLeft_ || roundsLeft_)) {
        if (!isLost)
            // only one try of the packet is damaged; the next tries are undamaged
            drawn_ = RfOutcome::Delivered;
        return failed(now, now + ackWaitNs, Fate::NoAck);
    }
    const uint64_t done = now + (packet_.acknowledged ? RfTimes::ackNs : 0) + RfTimes::gapNs;
    if (copiesLeft_ && !isDrawnLost) {
        --copiesLeft_;
        return startRound(now, done);
    }
    air_.report(now, arrived, outcome);
    fate_ = packet_.acknowledged && !isAnswered ? Fate::NoAck : Fate::Sent;
    state_ = State::Gap;
    air_.wakeAt(done, this);
}

void Mac::finish(uint64_t now, Fate fate) {
    state_ = State::Idle;
    modem_.transmitted(now, fate);
}
