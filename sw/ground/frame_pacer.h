// SPDX-License-Identifier: MIT
//
// frame_pacer: hands frames to the modem's serial port, with the silence that a short one needs.
//
// The modem sends a packet off at its longest, or after a silence of three characters (RO). So a
// silence of four follows a shorter frame. Without it packets would cut all later frames in two,
// and each loss would cost two. One frame may wait for the silence to end, so that the line does
// not rest longer.

#pragma once

#include "packet_line.h"

namespace XBeeAT {

class FramePacer : public PacketLine {
public:
    // `target`: the modem's; `longest`: bytes of a frame that it sends off without a silence.
    FramePacer(int target, double characterUs, uint32_t longest, uint32_t now)
        : target_(target), characterUs_(characterUs), longest_(longest), lineFree_(now),
          quietUntil_(now) {}

    bool answers() const override { return false; }
    bool offer(int, const uint8_t* frame, uint32_t size, uint32_t, size_t onLine,
               uint32_t now) override {
        if (onLine || !waiting_.empty() || before(now + characters(longest_), lineFree_))
            return false;
        waiting_.assign(frame, frame + size);
        return true;
    }
    Bytes due(uint32_t now) override {
        Bytes frame;
        if (waiting_.empty() || before(now, quietUntil_))
            return frame;
        frame.swap(waiting_);
        uint32_t size = static_cast<uint32_t>(frame.size());
        lineFree_ = (before(lineFree_, now) ? now : lineFree_) + characters(size);
        quietUntil_ = size < longest_ ? lineFree_ + characters(rest) : now;
        return frame;
    }
    uint32_t deadline(uint32_t now) const override {
        if (waiting_.empty())
            return 0xFFFFFFFFu;
        return before(now, quietUntil_) ? quietUntil_ - now : 0;
    }
    void feed(const uint8_t* bytes, size_t count, const Data& data, const Answer&) override {
        data(target_, bytes, count);
    }
    void expire(uint32_t, const Answer&) override {}

private:
    static constexpr uint32_t rest = 4; // characters, more than the modem's RO
    static bool before(uint32_t a, uint32_t b) { return static_cast<int32_t>(a - b) < 0; }
    uint32_t characters(uint32_t count) const {
        return static_cast<uint32_t>(count * characterUs_ + 0.5);
    }

    const int target_;
    const double characterUs_;
    const uint32_t longest_;
    Bytes waiting_;
    uint32_t lineFree_, quietUntil_; // when the line has sent all; when it may send again
};

} // namespace XBeeAT
