// SPDX-License-Identifier: MIT
//
// packet_line: a modem, as links hand packets to it: paced by its answers (ApiModem), or by the
// line's silences (FramePacer). Set-up chooses one.

#pragma once

#include <cstdint>
#include <functional>
#include <vector>

namespace XBeeAT {

// Times in microseconds, 32 bits that may wrap.
class PacketLine {
public:
    using Bytes = std::vector<uint8_t>;
    using Data = std::function<void(int source, const uint8_t* bytes, size_t count)>;
    using Answer = std::function<void(int target, bool isThere)>;

    virtual ~PacketLine() = default;
    virtual bool answers() const = 0; // for each packet
    // Takes a packet. `onLine`: bytes that have not left yet. Returns false: there is no room now.
    virtual bool offer(int target, const uint8_t* packet, uint32_t size, uint32_t rn, size_t onLine,
                       uint32_t now) = 0;
    // Returns the bytes to be written now.
    virtual Bytes due(uint32_t now) = 0;
    // Microseconds until bytes are due; 0xFFFFFFFF: none wait.
    virtual uint32_t deadline(uint32_t now) const = 0;
    // Takes bytes from the modem. Calls `data` with those of packets, and `answer` for each packet
    // that was sent, in their order: the target's modem has it, or it is lost.
    virtual void feed(const uint8_t* bytes, size_t count, const Data& data,
                      const Answer& answer) = 0;
    // Calls `answer` for each packet that the modem will not answer for any more.
    virtual void expire(uint32_t now, const Answer& answer) = 0;
};

} // namespace XBeeAT
