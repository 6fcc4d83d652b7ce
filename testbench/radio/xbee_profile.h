// SPDX-License-Identifier: MIT
//
// xbee_profile: lists the properties of the modems that the model can imitate: the XBee 802.15.4 of
// series 1, the S2C, and the XBee 3 with 802.15.4 firmware. docs/modem.md contains the sources of
// the figures.

#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

struct XBeeProfile {
    const char* name;     // name of the modem, as in the option --modem
    uint32_t highestCode; // highest value of BD that is a code for a rate
    uint32_t lowestRate;  // lowest value of BD that is itself a rate, baud
    uint32_t highestRate; // highest value of BD that is itself a rate, baud
    // true if rates are 1 MHz divided by an integer, so that 115,200 baud becomes 111,111
    bool dividesMegahertz;
    uint32_t highestRn;  // highest value of RN
    uint32_t inputBytes; // size of the serial receive buffer, bytes
    uint32_t threshold;  // factory setting of the buffer level at which CTS is deasserted, bytes
    // number of bytes by which the buffer must fall below that level before CTS is asserted again
    uint32_t release;
    // true if C8 can limit packets to the size of series 1, and if the command FT exists
    bool hasLegacyMode;
    // largest payload of a packet with Digi's header and 16-bit addresses, bytes
    size_t packetBytes;
    size_t encryptedBytes; // largest payload of an encrypted packet, bytes
    // status that the modem returns for a transmit request with a longer payload; 0 means that it
    // returns no status
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
