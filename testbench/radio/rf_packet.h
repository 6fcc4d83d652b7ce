// SPDX-License-Identifier: MIT
//
// rf_packet: a packet between modems, the time it takes on the air, and its possible outcomes.

#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

enum class RfOutcome { Delivered, Lost, Corrupted, Nobody, NoRoom, NoClearChannel };

struct RfPacket {
    static constexpr uint16_t allPans = 0xFFFF;

    uint16_t from = 0, to = 0, pan = 0;
    uint64_t to64 = 0; // serial number of the destination, if `wide`
    bool wide = false;
    uint8_t channel = 0;
    // payload as sent on the air, which is encrypted if the sender encrypts
    std::vector<uint8_t> bytes;
    // The sender's settings
    bool header = true;       // MM is 0 or 3: the packet has the manufacturer's header of two bytes
    bool acknowledged = true; // MM is 0 or 2, and the packet is not a broadcast
    // RR is set, so that the packet has a sequence number; the receiver uses it to drop duplicates
    bool sequenced = false;
    uint16_t sequence = 0;
    // serial number of the sender, with which the receiver decrypts the packet
    uint64_t serial = 0;
    bool encrypted = false; // EE
    // the sender has no 16-bit address, so the packet contains its serial number
    bool from64 = false;
    // maximum number of transmissions by the MAC in one round, including the first one
    unsigned tries = 4;
    unsigned rounds = 0;  // maximum number of further rounds (RR)
    unsigned copies = 1;  // number of copies of a broadcast: RR + 2, or 1 if RR is 0
    unsigned backoff = 0; // RN
    double rssi = -40;    // signal strength at the receiver, dBm

    bool isBroadcast() const { return to == 0xFFFF && !wide; }
};

// Durations of the parts of one transmission by IEEE 802.15.4, ns (docs/simulation.md).
namespace RfTimes {

constexpr uint64_t byteNs = 32'000, ccaNs = 128'000, turnaroundNs = 192'000;
constexpr uint64_t ackNs = turnaroundNs + 11 * byteNs, gapNs = 640'000; // LIFS

// Returns the number of bytes on the air. PHY header, checksum, and a MAC header with 16-bit
// addresses take 17 bytes; each 64-bit address takes 6 more.
inline size_t frameBytes(const RfPacket& packet) {
    bool longSource = packet.encrypted || packet.from64;
    return 17 + 2u * packet.header + 6u * packet.wide + 6u * longSource + packet.bytes.size();
}

// Returns the time from carrier sense to the end of the acknowledgement, ns.
inline uint64_t tryNs(const RfPacket& packet) {
    return ccaNs + turnaroundNs + frameBytes(packet) * byteNs + (packet.acknowledged ? ackNs : 0);
}

} // namespace RfTimes
