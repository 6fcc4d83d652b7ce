// SPDX-License-Identifier: MIT
//
// xbee_profile: properties of the modems that the model can imitate: the XBee 802.15.4 of series 1,
// the S2C, and the XBee 3 with 802.15.4 firmware. docs/modem.md gives the sources of the figures.

#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

struct XBeeProfile {
    const char* name;     // name, as in --modem
    uint32_t highestCode; // highest value of BD that is a code for a rate
    uint32_t lowestRate;  // lowest value of BD that is itself a rate, baud
    uint32_t highestRate; // highest one
    // true if rates are 1 MHz divided by an integer, so that 115,200 becomes 111,111
    bool dividesMegahertz;
    uint32_t highestRn;  // highest value of RN
    uint32_t inputBytes; // size of the serial receive buffer, bytes
    uint32_t threshold;  // factory setting of the buffer level at which CTS is deasserted, bytes
    // difference between this level and the level at which CTS is asserted again, bytes
    uint32_t release;
    // true if C8 can limit packets to the size of series 1, and FT is a command
    bool hasLegacyMode;
    // largest payload of a packet with Digi's header and 16-bit addresses, bytes
    size_t packetBytes;
    size_t encryptedBytes; // the same with encryption, bytes
    // status of a transmit request with a longer payload; 0 means that no status is sent
    uint8_t tooLongStatus;
};

// Returns the profile with this name. Throws std::invalid_argument if the name is unknown.
inline const XBeeProfile& xbeeProfile(const std::string& name) {
    static const XBeeProfile profiles[] = {
        {"s1", 7, 0x80, 250000, true, 3, 202, 185, 17, false, 100, 95, 0},
        {"s2c", 10, 1200, 921600, false, 3, 174, 109, 17, true, 114, 101, 0x74},
        {"xb3", 10, 300, 967680, false, 5, 174, 109, 1, true, 114, 101, 0x74}};
    for (const XBeeProfile& profile : profiles)
        if (name == profile.name)
            return profile;
    throw std::invalid_argument("modem: expected s1, s2c or xb3, got '" + name + "'");
}
