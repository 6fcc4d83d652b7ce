// SPDX-License-Identifier: MIT
//
// xbee_parameters: defines the parameters of each modem, with factory values and limits from Digi's
// manuals.

#pragma once

#include "xbee_profile.h"
#include <algorithm>
#include <cstdint>
#include <map>
#include <string>

struct XBeeParameter {
    uint32_t factory, lowest, highest;
    bool writable;
};

// Parameters of the XBee series 1; xbeeParameters changes them for the other modems.
inline const std::map<std::string, XBeeParameter>& xbeeParametersOfS1() {
    static const std::map<std::string, XBeeParameter> table = {
        // 16-bit address of this modem; FFFE and FFFF mean that the modem has no 16-bit address
        {"MY", {0, 0, 0xFFFF, true}},
        // destination, high word; if it is 0 and DL is at most FFFF, DL is a 16-bit address
        {"DH", {0, 0, 0xFFFFFFFF, true}},
        {"DL", {0, 0, 0xFFFFFFFF, true}},           // destination, low word; FFFF means broadcast
        {"SH", {0x0013A200, 0, 0xFFFFFFFF, false}}, // serial number
        {"SL", {0x40000000, 0, 0xFFFFFFFF, false}},
        {"ID", {0x3332, 0, 0xFFFF, true}}, // network; FFFF means all networks
        {"CH", {0x0C, 0x0B, 0x1A, true}},  // channel
        // baud rate: values up to 7 are codes; a higher value is the rate itself
        {"BD", {3, 0, 0x3D090, true}},
        // silence of the host after which the modem sends a packet, in character times
        {"RO", {3, 0, 0xFF, true}},
        {"RN", {0, 0, 3, true}}, // smallest exponent of the random wait before a transmission
        // 0: header and acknowledgements, 1: neither of them, 2: acknowledgements only, 3: header
        // only
        {"MM", {0, 0, 3, true}},
        // number of additional rounds, each with the MAC's four tries
        {"RR", {0, 0, 6, true}},
        {"EE", {0, 0, 1, true}}, // encryption
        // guard time of silence before and after the command sequence, ms
        {"GT", {1000, 2, 3300, true}},
        // time without a command after which the modem leaves command mode, in units of 100 ms
        {"CT", {100, 2, 0xFFFF, true}},
        {"CC", {'+', 0, 0xFF, true}},   // character that forms the command sequence, three times
        {"D6", {0, 0, 5, true}},        // 1: the modem obeys RTS
        {"D7", {1, 0, 5, true}},        // 1: CTS is driven
        {"AP", {0, 0, 2, true}},        // 1: API frames; 2: API frames with escaped bytes
        {"DB", {0x28, 0, 0xFF, false}}, // signal strength of the last packet, -dBm, 0x17 to 0x5C
        // number of packets that were not sent because the channel was never clear
        {"EC", {0, 0, 0xFFFF, true}},
        // number of packets that were not acknowledged in any of their tries
        {"EA", {0, 0, 0xFFFF, true}}};
    return table;
}

inline std::map<std::string, XBeeParameter> xbeeParameters(const XBeeProfile& profile) {
    std::map<std::string, XBeeParameter> table = xbeeParametersOfS1();
    table["BD"].highest = profile.highestRate;
    table["RN"].highest = profile.highestRn;
    if (!profile.hasLegacyMode)
        return table;
    table["C8"] = {0, 0, 3, true}; // bit 0: packets are limited to the size of the series 1
    // number of bytes in the buffer at which CTS is deasserted
    table["FT"] = {profile.threshold, 17, profile.inputBytes - 12, true};
    return table;
}

// Returns the baud rate that a value of BD selects. A rate without a code is rounded to the nearest
// rate that the modem clock can generate: on the series 1, 16 MHz / 16 divided by an integer.
inline double xbeeBaud(const XBeeProfile& profile, uint32_t bd) {
    static const double rates[] = {1200,  2400,   4800,   9600,   19200, 38400,
                                   57600, 115200, 230400, 460800, 921600};
    if (bd <= profile.highestCode && !(profile.dividesMegahertz && bd == 7))
        return rates[bd];
    const double rate = bd == 7 ? rates[7] : bd;
    if (!profile.dividesMegahertz)
        return rate;
    return 1e6 / std::max(1u, static_cast<unsigned>(1e6 / rate + 0.5));
}
