// SPDX-License-Identifier: MIT
//
// xbee_profile: the modems that the model imitates: the XBee 802.15.4 of series 1, the S2C and the
// XBee 3 with 802.15.4 firmware. docs/modem.md has the sources of the figures.

#pragma once

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>

struct XBeeProfile {
    const char* name;      // as in --modem
    uint32_t highestCode;  // highest value of BD that is a code
    uint32_t lowestRate;   // lowest value of BD that is a rate, baud
    uint32_t highestRate;  // highest one
    bool dividesMegahertz; // rates are 1 MHz divided by an integer: 115,200 becomes 111,111
    uint32_t highestRn;    // greatest value of RN
    uint32_t inputBytes;   // serial receive buffer
    uint32_t threshold;    // bytes in it when CTS is deasserted, from the factory
    uint32_t release;      // bytes fewer than the threshold when CTS is asserted again
    bool hasLegacyMode;    // C8 selects packets as short as those of series 1; FT is a command
    size_t packetBytes;    // most data in a packet, with Digi's header and 16-bit addresses
    size_t encryptedBytes; // the same with encryption
    uint8_t tooLongStatus; // status of a transmit request with more data; 0: no answer
};

// Returns a modem by its name. Throws std::invalid_argument for another name.
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
