// SPDX-License-Identifier: MIT
//
// rf_weather: traces, path loss, interference.

#include "rf_weather.h"
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <stdexcept>

namespace {

constexpr double lossOfFirstMetre = 40; // dB, free space at 2.4 GHz
const char* const heading = "time_s,loss,rssi_dbm,delay_ms";

} // namespace

RfTrace::RfTrace(const std::string& path) {
    std::ifstream file(path);
    std::string line;
    size_t number = 1;
    auto fail = [&](const std::string& what) {
        throw std::runtime_error(path + ":" + std::to_string(number) + ": " + what);
    };
    if (!file || !std::getline(file, line))
        throw std::runtime_error(path + ": no such trace, or it is empty");
    if (line != heading)
        fail(std::string("the heading is not '") + heading + "'");
    while (++number, std::getline(file, line)) {
        if (line.empty() || line[0] == '#')
            continue;
        double time, loss, rssi, delay;
        char more;
        if (std::sscanf(line.c_str(), "%lf,%lf,%lf,%lf%c", &time, &loss, &rssi, &delay, &more) != 4)
            fail("not four numbers");
        if (time < 0 || loss < 0 || loss > 1 || delay < 0)
            fail("time and delay are not negative, loss is from 0 to 1");
        uint64_t ns = static_cast<uint64_t>(time * 1e9);
        if (!rows_.empty() && ns <= rows_.back().ns)
            fail("time does not grow");
        rows_.push_back({ns, loss, rssi, static_cast<uint64_t>(delay * 1e6)});
    }
    if (rows_.empty())
        fail("there is no row");
}

const RfTrace::Row& RfTrace::at(uint64_t ns) const {
    auto next = std::upper_bound(rows_.begin(), rows_.end(), ns,
                                 [](uint64_t time, const Row& row) { return time < row.ns; });
    return next == rows_.begin() ? *next : *std::prev(next);
}

const std::vector<std::pair<std::string, RfWeather>>& RfWeather::published() {
    static const auto all = [] {
        std::vector<std::pair<std::string, RfWeather>> list;
        auto add = [&](const std::string& name) -> RfWeather& {
            return list.emplace_back(name, RfWeather()).second;
        };
        auto bursts = [&](const char* name, double begin, double end, double inside,
                          double outside) {
            RfWeather& w = add(name);
            w.burstBegin = begin, w.burstEnd = end, w.burstLoss = inside, w.loss = outside;
        };
        bursts("bursts, long", 0.01, 0.08, 1, 0.02);
        bursts("bursts, mean", 0.03, 0.4, 0.95, 0.01);
        bursts("bursts, frequent", 0.08, 0.5, 0.9, 0);
        add("a quarter of the tries lost").tryLoss = 0.25;
        for (unsigned metres : {100u, 200u, 300u, 400u})
            add(std::to_string(metres) + " m, fading").distance = metres;
        for (unsigned percent : {10u, 25u, 50u})
            add("interferer " + std::to_string(percent) + " %").interference = percent / 100.0;
        return list;
    }();
    return all;
}

RfWeather RfWeather::drawn(Random& random, unsigned mostLoss) {
    RfWeather w;
    const size_t kind = random.below(static_cast<uint32_t>(3 * published().size()));
    if (kind < published().size())
        w = published()[kind].second;
    else if (kind < 2 * published().size())
        w.loss = random.below(mostLoss) / 100.0;
    w.duplication = random.below(2) ? 0 : 0.1;
    w.corruption = random.below(2) ? 0 : 0.03;
    return w;
}

bool RfWeather::interferes(uint64_t from, uint64_t to) const {
    if (interference <= 0)
        return false;
    auto on = static_cast<uint64_t>(interference * static_cast<double>(interferencePeriodNs));
    uint64_t phase = from % interferencePeriodNs;
    return phase < on || phase + (to - from) >= interferencePeriodNs;
}

double RfWeather::meanRssi() const {
    return -lossOfFirstMetre - 20 * std::log10(std::max(distance, 1.0));
}
