// SPDX-License-Identifier: MIT
//
// rf_packet: a packet between modems, and what can become of it on the air.

#pragma once

#include <cstdint>
#include <vector>

enum class RfOutcome { Delivered, Lost, Corrupted, Nobody, NoRoom, NoClearChannel };

struct RfPacket {
    static constexpr uint16_t allPans = 0xFFFF;

    uint16_t from = 0, to = 0, pan = 0;
    uint64_t to64 = 0; // destination by serial number, if `wide`
    bool wide = false;
    uint8_t channel = 0;
    std::vector<uint8_t> bytes; // as on the air: encrypted, if the sender encrypts
    // The sender's settings
    bool header = true;       // MM 0 or 3: the maker's header of two bytes
    bool acknowledged = true; // MM 0 or 2, and no broadcast
    bool sequenced = false;   // with a header and RR: the receiver drops repeated ones
    uint16_t sequence = 0;
    uint64_t serial = 0;    // the sender's, for decryption
    bool encrypted = false; // EE
    bool from64 = false;    // the sender has no 16-bit address
    unsigned tries = 4;     // of the MAC: the first and the retries
    unsigned rounds = 0;    // RR: times that all tries are made again
    unsigned copies = 1;    // of a broadcast: RR + 2 with RR
    unsigned backoff = 0;   // RN
    double rssi = -40;      // dBm at the receiver
};
