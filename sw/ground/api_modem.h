// SPDX-License-Identifier: MIT
//
// api_modem: a modem in API mode: packets go to it with a target, and it answers for each.

#pragma once

#include "api_frames.h"
#include "key_file.h"

#include <deque>

extern "C" {
#include "link_config.h"
}

namespace XBeeAT {

// Times in microseconds, 32 bits that may wrap.
class ApiModem {
public:
    using Bytes = ApiFrames::Bytes;

    explicit ApiModem(bool escapes) : frames_(escapes) {}

    // Returns the bytes for the line that send a packet, and first set RN if it changes.
    Bytes packet(int target, const uint8_t* data, size_t size, uint32_t rn, uint32_t now) {
        Bytes bytes;
        if (rn != rn_)
            bytes = frames_.command(0, "RN", {static_cast<uint8_t>(rn)});
        rn_ = rn;
        const bool isAnswered = target != everybody; // else ID is 0
        if (isAnswered) {
            id_ = id_ == 0xFF ? 1 : id_ + 1;
            waiting_.push_back({id_, now});
        }
        const auto frame =
            frames_.packet(isAnswered ? id_ : 0, static_cast<uint16_t>(target), data, size);
        bytes.insert(bytes.end(), frame.begin(), frame.end());
        return bytes;
    }
    // Takes bytes from the modem. Calls `data(source, bytes, count)` with those of packets, and
    // `answer(isThere)` for each packet that was sent, in their order.
    template <class Data, class Answer>
    void feed(const uint8_t* bytes, size_t count, const Data& data, const Answer& answer) {
        frames_.feed(bytes, count, data, [&](const Bytes& frame) {
            if (frame[0] != ApiFrames::Status || frame.size() != 3 ||
                std::none_of(waiting_.begin(), waiting_.end(),
                             [&](const Packet& p) { return p.id == frame[1]; }))
                return;
            for (bool isLast = false; !isLast;) {
                isLast = waiting_.front().id == frame[1]; // the line lost the others' answers
                waiting_.pop_front();
                answer(isLast && frame[2] == 0);
            }
        });
    }
    // Calls `lost()` for each packet that the modem will not answer for any more.
    template <class Lost> void expire(uint32_t now, const Lost& lost) {
        for (; !waiting_.empty() && now - waiting_.front().at >= LINK_ANSWER_LAST; lost())
            waiting_.pop_front();
    }

private:
    struct Packet {
        uint8_t id;
        uint32_t at; // when it was handed over
    };
    ApiFrames frames_;
    uint32_t rn_ = LINK_WAIT_SHARED; // as set-up leaves it
    uint8_t id_ = 0;
    std::deque<Packet> waiting_; // without an answer
};

} // namespace XBeeAT
