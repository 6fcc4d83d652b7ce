// SPDX-License-Identifier: MIT
//
// api_modem: a modem in API mode: packets go to it with a target, and it answers for each.

#pragma once

#include "api_frames.h"
#include "packet_line.h"

#include <deque>
#include <utility>

extern "C" {
#include "link_config.h"
}

namespace XBeeAT {

class ApiModem : public PacketLine {
public:
    // `most`: packets that may be without an answer, whoever they are for.
    explicit ApiModem(bool escapes, size_t most = 255) : frames_(escapes), most_(most) {}

    // Returns the bytes for the line that send a packet, and first set RN if it changes.
    Bytes packet(int target, const uint8_t* data, size_t size, uint32_t rn, uint32_t now) {
        Bytes bytes;
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
    bool answers() const override { return true; }
    bool offer(int target, const uint8_t* data, uint32_t size, uint32_t rn, size_t,
               uint32_t now) override {
        if (unanswered() >= most_)
            return false;
        const Bytes bytes = packet(target, data, size, rn, now);
        out_.insert(out_.end(), bytes.begin(), bytes.end());
        return true;
    }
    Bytes due(uint32_t) override { return std::exchange(out_, {}); }
    uint32_t deadline(uint32_t) const override { return out_.empty() ? 0xFFFFFFFFu : 0; }
    void feed(const uint8_t* bytes, size_t count, const Data& data, const Answer& answer) override {
        frames_.feed(bytes, count, data, [&](const Bytes& frame) {
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
    void expire(uint32_t now, const Answer& answer) override {
        while (!waiting_.empty() && now - waiting_.front().at >= LINK_ANSWER_LAST) {
            const int target = waiting_.front().target;
            waiting_.pop_front();
            answer(target, false);
        }
    }

private:
    struct Packet {
        uint8_t id;
        int target;
        uint32_t at; // when it was handed over
    };
    ApiFrames frames_;
    size_t most_;
    Bytes out_;                      // for the line
    uint32_t rn_ = LINK_WAIT_SHARED; // as set-up leaves it
    uint8_t id_ = 0;
    std::deque<Packet> waiting_; // without an answer
};

} // namespace XBeeAT
