// SPDX-License-Identifier: MIT
//
// rf_packet: a packet between modems, its air times and its possible outcomes.

#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

enum class RfOutcome { Delivered, Lost, Corrupted, Nobody, NoRoom, NoClearChannel };

struct RfPacket {
    static constexpr uint16_t allPans = 0xFFFF;

    uint16_t from = 0, to = 0, pan = 0;
    uint64_t to64 = 0; // destination by serial number, if `wide`
    bool wide = false;
    uint8_t channel = 0;
    std::vector<uint8_t> bytes; // as on the air: encrypted if the sender encrypts
    // The sender's settings
    bool header = true;       // MM 0 or 3: the maker's header of two bytes
    bool acknowledged = true; // MM 0 or 2, and no broadcast
    bool sequenced = false;   // has the header of RR, by which the receiver drops duplicates
    uint16_t sequence = 0;
    uint64_t serial = 0;    // the sender's, for decryption
    bool encrypted = false; // EE
    bool from64 = false;    // the sender has no 16-bit address
    unsigned tries = 4;     // tries of the MAC in a round: the first one and the retries
    unsigned rounds = 0;    // further rounds of tries (RR)
    unsigned copies = 1;    // frames of a broadcast: RR + 2, or 1 if RR is 0
    unsigned backoff = 0;   // RN
    double rssi = -40;      // dBm at the receiver

    bool isBroadcast() const { return to == 0xFFFF && !wide; }
};

// Times of a try by IEEE 802.15.4, ns (docs/simulation.md).
namespace RfTimes {

constexpr uint64_t byteNs = 32'000, ccaNs = 128'000, turnaroundNs = 192'000;
constexpr uint64_t ackNs = turnaroundNs + 11 * byteNs, gapNs = 640'000; // LIFS

// Returns the bytes on the air: PHY header, MAC header with 16-bit addresses and checksum have 17;
// a 64-bit address adds 6.
inline size_t frameBytes(const RfPacket& packet) {
    bool longSource = packet.encrypted || packet.from64;
    return 17 + 2u * packet.header + 6u * packet.wide + 6u * longSource + packet.bytes.size();
}

// Returns the duration from carrier sense to the end of the acknowledgement.
inline uint64_t tryNs(const RfPacket& packet) {
    return ccaNs + turnaroundNs + frameBytes(packet) * byteNs + (packet.acknowledged ? ackNs : 0);
}

} // namespace RfTimes
