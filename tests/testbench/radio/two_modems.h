// SPDX-License-Identifier: MIT
//
// two_modems: a test fixture with two modems, `a` with address 1 and `b` with address 2, the air
// between them, and their hosts.

#pragma once

#include "rf_channel.h"
#include "xbee.h"
#include <algorithm>
#include <gtest/gtest.h>
#include <memory>
#include <utility>

class TwoModems : public ::testing::Test {
protected:
    using Settings = std::map<std::string, uint32_t>;
    using Bytes = std::vector<uint8_t>;
    static constexpr uint64_t ms = 1'000'000;
    static constexpr uint64_t afterFrame = 544'000 + 640'000; // acknowledgement, gap

    // Switches both modems on. They have the factory settings except for short guard times and the
    // addresses 1 and 2.
    void power(Settings forA = {}, Settings forB = {}) {
        XBee::Options optionsA, optionsB;
        optionsA.profile = optionsB.profile = profile;
        optionsA.set = {{"MY", 1}, {"DL", 2}, {"GT", 10}, {"SL", 0xA}};
        optionsB.set = {{"MY", 2}, {"DL", 1}, {"GT", 10}, {"SL", 0xB}};
        for (auto& [letters, value] : forA)
            optionsA.set[letters] = value;
        for (auto& [letters, value] : forB)
            optionsB.set[letters] = value;
        a = std::make_unique<XBee>(lineA, air, optionsA);
        b = std::make_unique<XBee>(lineB, air, optionsB);
        air.onPacket([this](uint64_t time, const RfPacket& packet, RfChannel::Outcome outcome) {
            packets.push_back({time, packet.bytes, outcome});
        });
        air.weather.perfect = perfect;
        run(20 * ms);
        lineA.received.clear();
        lineB.received.clear();
    }
    void run(uint64_t ns) {
        for (uint64_t end = now + ns; now < end;) {
            uint64_t next = std::min({air.nextEvent(), a->nextEvent(), b->nextEvent(), end});
            now = std::max(next, now + 1);
            air.advance(now);
            a->advance(now);
            b->advance(now);
        }
    }
    static Bytes bytes(const std::string& text) { return {text.begin(), text.end()}; }
    static std::string text(const Bytes& data) { return {data.begin(), data.end()}; }
    void send(const std::string& data, uint64_t ns = 0) {
        lineA.send(bytes(data), now);
        run(ns);
    }
    // Returns the bytes that modem `a` has sent to its host since the last call.
    std::string heard() { return text(std::exchange(lineA.received, {})); }
    std::string heardB() { return text(std::exchange(lineB.received, {})); }
    // Sends `data` to modem `a`. Returns the bytes that modem `b` sends to its host within the next
    // `ns`.
    std::string across(const std::string& data, uint64_t ns) {
        send(data, ns);
        return heardB();
    }
    std::string enter() {
        run(11 * ms);
        send("+++", 11 * ms);
        return heard();
    }
    std::string command(const std::string& line) {
        send(line + "\r", ms);
        return heard();
    }
    uint64_t charNs(double baud = 9600) const { return static_cast<uint64_t>(10e9 / baud); }

    struct Seen {
        uint64_t time;
        Bytes bytes;
        RfChannel::Outcome outcome;
    };
    std::string profile = "s1"; // profile of both modems; takes effect at the next power()
    bool perfect = true;        // value for RfWeather::perfect; takes effect at the next power()
    uint64_t now = 0;
    RfChannel air{testSeed()};
    HostLine lineA, lineB;
    std::unique_ptr<XBee> a, b;
    std::vector<Seen> packets; // packets on the air, in the order of arrival
};
