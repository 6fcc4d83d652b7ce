// SPDX-License-Identifier: MIT
//
// rf_weather: the conditions on the air, as numbers, or row by row from a recorded trace.

#ifndef RF_WEATHER_H
#define RF_WEATHER_H

#include "random.h"
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

// A link's record: CSV with the heading `time_s,loss,rssi_dbm,delay_ms`. A row holds from its time
// to that of the next one; the last row stays.
class RfTrace {
public:
    struct Row {
        uint64_t ns;
        double loss;      // share of packets that are lost after the MAC's tries
        double rssi;      // dBm
        uint64_t delayNs; // beyond the time on the air
    };
    // Reads a file; throws std::runtime_error that names file, line and fault.
    explicit RfTrace(const std::string& path);
    const Row& at(uint64_t ns) const;

private:
    std::vector<Row> rows_;
};

// The weather of the air; each is a probability unless it says otherwise.
struct RfWeather {
    // Residual loss of a packet in one direction, after the MAC's tries; costs no more air time.
    double loss = 0;
    double burstBegin = 0, burstEnd = 0.2, burstLoss = 0.9; // Gilbert-Elliott, per packet or 10 ms
    double duplication = 0, corruption = 0;
    uint64_t delayNs = 0; // beyond the time on the air
    // The MAC itself: one try is lost, or its acknowledgement, and it tries again.
    double tryLoss = 0, ackLoss = 0;
    // Free space and Rayleigh fading over this many metres, each try by itself; 0: none.
    double distance = 0;
    // An interferer is on for this share of each of its periods: the channel is busy then, and a
    // try that meets it is lost. A microwave oven: about half of 20 ms (50 Hz).
    double interference = 0;
    uint64_t interferencePeriodNs = 20'000'000;
    // A link's record, instead of loss and delay above.
    std::shared_ptr<const RfTrace> trace;
    // Perfect air, for unit tests: both directions at once, no carrier sense, no collisions, and
    // modems that need no time of their own. No radio has this air.
    bool perfect = false;

    // Losses in bursts as on flights, and tries lost as in the field; distance in the clear; an
    // interferer. Sources: docs/models.md.
    static const std::vector<std::pair<std::string, RfWeather>>& published();
    // Draws one of these, independent losses below `mostLoss` percent, or none; now and then with
    // doubled and damaged packets.
    static RfWeather drawn(Random& random, unsigned mostLoss);

    bool interferes(uint64_t from, uint64_t to) const;
    double meanRssi() const; // dBm, of a modem of 0 dBm at `distance`
};

#endif
