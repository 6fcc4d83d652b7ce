// SPDX-License-Identifier: MIT
//
// modem_floor: the floor of a round trip on a half-duplex air, measured: two modems with their
// serial ports at 111,111 baud and the air, nothing else. docs/link.md has it as a formula.

#ifndef MODEM_FLOOR_H
#define MODEM_FLOOR_H

#include "modem_pair.h"

// Returns the median in ms of `out` bytes there and, from the moment of the last one on, `back`
// bytes here; each at most a packet. RN is 2.
inline double floorMs(size_t out, size_t back, bool isEncrypted = false) {
    RfChannel air(1);
    struct End {
        End(RfChannel& channel, unsigned address, bool encrypts)
            : modem(line, channel, modemOptions(address, encrypts)) {}
        TimedLine line;
        XBee modem;
    } a(air, 0, isEncrypted), b(air, 1, isEncrypted);
    const std::vector<uint8_t> bytes(std::max(out, back), 1);
    std::vector<double> times;
    uint64_t now = 1'000'000;
    for (int i = 0; i < 201; ++i) {
        const uint64_t start = now;
        bool isBack = false;
        a.line.received.clear();
        b.line.received.clear();
        a.line.send(bytes.data(), out, now);
        for (;;) {
            air.advance(now);
            a.modem.advance(now);
            b.modem.advance(now);
            if (a.line.received.size() == back)
                break;
            if (!isBack && b.line.received.size() == out) {
                isBack = true;
                b.line.send(bytes.data(), back, now);
            }
            now = std::max(now + 1,
                           std::min({air.nextEvent(), a.modem.nextEvent(), b.modem.nextEvent()}));
        }
        times.push_back(static_cast<double>(now - start) / 1e6);
        now += 160'000'000;
    }
    std::sort(times.begin(), times.end());
    return times[times.size() / 2];
}

#endif
