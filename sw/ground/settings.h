// SPDX-License-Identifier: MIT
//
// settings: the settings of an engine for its serial port and its modem.

#pragma once

#include "key_file.h"

#include <chrono>
#include <functional>
#include <random>
#include <string>

namespace XBeeAT {

struct Settings {
    std::string device;
    // baud rate of the modem after set-up; 115200 stands for BD 7 with the real rate 111,111
    int baud = 115200;
    int source = 0x0000;  // MY
    int target = 0x0001;  // DL
    int rfChannel = 0x0C; // CH
    int pan = 0x3332;     // ID
    LinkKeys keys;        // keys for sessions of the link
    // AES key, up to 32 hexadecimal digits; an empty key leaves the modem's setting unchanged
    std::string modemKey;
    int guardMs = 1000; // current guard time of the modem, ms
    bool setUp = true;  // true: set the modem up by AT commands
    bool isApi = true;  // true: use API mode, if the modem is set up and supports it
    // true: the port is connected to the vehicle's board by wires, without modems
    bool isWire = false;
    int downMs = 15000; // time without a link after which the modem is set up again, ms
    // time of silence after which a program loses its channel to a waiting program, ms; 0 disables
    // this
    int idleMs = 60000;

    // function that returns a random number for sessions; tests may replace it
    std::function<unsigned()> random = [] { return std::random_device()(); };

    // function that returns the quarters of a second since the start of 2026 (link_broadcast.h);
    // tests may replace it
    std::function<int64_t()> quarters = [] {
        using namespace std::chrono;
        const auto now = system_clock::now().time_since_epoch();
        return duration_cast<milliseconds>(now).count() / 250 - 1767225600LL * 4;
    };

    // Returns the limit of the packets that wait for the modem's result (Link_expectAnswers).
    unsigned mostWaiting() const { return baud > 115200 ? 2 : 3; }
    double characterUs() const { return 1e7 / (baud == 115200 ? 111111 : baud); }
};

// Log function. Levels: -1 notices that are always logged, 0 errors, 1 link and connections, 2 AT
// commands.
using Log = std::function<void(int level, const std::string& text)>;

} // namespace XBeeAT
