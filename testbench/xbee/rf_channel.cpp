// SPDX-License-Identifier: MIT
//
// rf_channel: packets in flight.

#include "rf_channel.h"
#include <algorithm>

namespace {
constexpr unsigned macTries = 4; // the first and three retries
}

uint64_t RfChannel::airTimeNs(size_t bytes) {
    // CCA, turnaround, 19 bytes of PHY and MAC header at 250 kbit/s, acknowledgement, LIFS.
    return 128'000 + 192'000 + (19 + bytes) * 32'000 + 544'000 + 640'000;
}

void RfChannel::leave(XBee* modem) {
    modems_.erase(std::remove(modems_.begin(), modems_.end(), modem), modems_.end());
    for (auto& [time, flight] : events_)
        if (flight.sender == modem)
            flight.sender = nullptr;
}

RfChannel::Outcome RfChannel::fate() {
    inBurst_ = weather.burstBegin > 0 && (inBurst_ ? !random_.chance(weather.burstEnd)
                                                   : random_.chance(weather.burstBegin));
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
    Flight flight{sender, std::move(packet), macTries - 1, outcome, false};
    if (doubled && outcome != Outcome::Lost) {
        ++counters_.duplicated;
        Flight copy = flight;
        copy.again = true;
        events_.emplace(now + 2 * air + weather.delayNs, std::move(copy));
    }
    events_.emplace(now + air + weather.delayNs, std::move(flight));
}

void RfChannel::land(Flight flight, uint64_t now) {
    RfPacket& packet = flight.packet;
    Outcome outcome = flight.outcome;
    if (outcome == Outcome::Corrupted) {
        ++counters_.corrupted;
        packet.bytes[random_.below(static_cast<uint32_t>(packet.bytes.size()))] ^=
            static_cast<uint8_t>(1 + random_.below(255));
    }
    if (outcome == Outcome::Lost) {
        ++counters_.lost;
    } else {
        bool found = false, taken = false;
        for (XBee* modem : modems_) {
            if (modem == flight.sender || modem->parameter("CH") != packet.channel ||
                modem->parameter("ID") != packet.pan ||
                (packet.to != 0xFFFF && modem->parameter("MY") != packet.to))
                continue;
            found = true;
            taken = modem->receive(packet, now) || taken;
        }
        if (!found)
            outcome = Outcome::Nobody;
        else if (!taken && flight.triesLeft) {
            --flight.triesLeft;
            flight.outcome = Outcome::Delivered;
            events_.emplace(now + airTimeNs(packet.bytes.size()), std::move(flight));
            return;
        } else if (!taken) {
            outcome = Outcome::NoRoom;
        }
    }
    if (listener_)
        listener_(now, packet, outcome);
    if (flight.sender && !flight.again)
        flight.sender->transmitted(now);
}

void RfChannel::advance(uint64_t now) {
    while (!events_.empty() && events_.begin()->first <= now) {
        Flight flight = std::move(events_.begin()->second);
        uint64_t at = events_.begin()->first;
        events_.erase(events_.begin());
        land(std::move(flight), at);
    }
}
