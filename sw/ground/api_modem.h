// SPDX-License-Identifier: MIT
//
// api_modem: a modem in API mode: packets go to it with a target, and it answers for each.

#pragma once

#include "api_frames.h"

#include <deque>

extern "C" {
#include "link_config.h"
}

namespace XBeeAT {

class ApiModem {
public:
    static constexpr int everybody = 0xFFFF; // as a target

    explicit ApiModem(bool escapes) : frames_(escapes) {}

    // Returns the bytes for the line that send a packet, and first set RN if it changes.
    ApiFrames::Bytes packet(int target, const uint8_t* data, size_t size, uint32_t rn,
                            uint32_t now) {
        ApiFrames::Bytes bytes;
        if (rn != rn_)
            bytes = frames_.command(0, "RN", {static_cast<uint8_t>(rn)});
        rn_ = rn;
        id_ = id_ == 0xFF ? 1 : id_ + 1; // 0 would ask for no answer
        waiting_.push_back({id_, target, now});
        const auto frame = frames_.packet(id_, static_cast<uint16_t>(target), data, size);
        bytes.insert(bytes.end(), frame.begin(), frame.end());
        return bytes;
    }
    size_t unanswered() const { return waiting_.size(); } // packets
    // Takes bytes from the line. Calls `data(source, bytes, count)` with those of packets, and
    // `answer(target, isThere)` for each packet that was sent, in their order: the target's modem
    // has it, or it is lost.
    template <class Data, class Answer>
    void feed(const uint8_t* bytes, size_t count, Data data, Answer answer) {
        frames_.feed(
            bytes, count,
            [&](int source, const uint8_t* heard, size_t size) { data(source, heard, size); },
            [&](const ApiFrames::Bytes& frame) {
                if (frame[0] != ApiFrames::Status || frame.size() != 3 ||
                    std::none_of(waiting_.begin(), waiting_.end(),
                                 [&](const Packet& p) { return p.id == frame[1]; }))
                    return;
                for (bool isLast = false; !isLast;) {
                    const Packet first = waiting_.front();
                    isLast = first.id == frame[1]; // the line lost the others' answers
                    waiting_.pop_front();
                    answer(first.target, isLast && frame[2] == 0);
                }
            });
    }
    // Calls `lost(target)` for each packet that the modem will not answer for any more.
    template <class Lost> void expire(uint32_t now, Lost lost) {
        while (!waiting_.empty() && now - waiting_.front().at >= LINK_ANSWER_LAST) {
            const int target = waiting_.front().target;
            waiting_.pop_front();
            lost(target);
        }
    }

private:
    struct Packet {
        uint8_t id;
        int target;
        uint32_t at; // when it was handed over
    };
    ApiFrames frames_;
    uint32_t rn_ = LINK_WAIT_SHARED; // as set-up leaves it
    uint8_t id_ = 0;
    std::deque<Packet> waiting_; // without an answer
};

} // namespace XBeeAT
