// SPDX-License-Identifier: MIT
//
// frame_pacer: hands frames to the modem's serial port, with the silence that a short one needs.
//
// The modem sends a packet off at its longest, or after a silence of three characters (RO). So a
// silence of four follows a shorter frame. Without it packets would cut all later frames in two,
// and each loss would cost two. One frame may wait for the silence to end, so that the line does
// not rest longer.

#pragma once

#include <cstdint>
#include <vector>

namespace XBeeAT {

// Times in microseconds, 32 bits that may wrap.
class FramePacer {
public:
    // `longest`: bytes of a frame that the modem sends off without a silence.
    FramePacer(double characterUs, uint32_t longest)
        : characterUs_(characterUs), longest_(longest) {}

    // Returns false where a frame waits already.
    bool offer(const uint8_t* frame, uint32_t size, uint32_t now) {
        if (!waiting_.empty() || before(now + characters(longest_), lineFree_))
            return false;
        waiting_.assign(frame, frame + size);
        return true;
    }
    // Returns the frame to be written now; empty: none.
    std::vector<uint8_t> due(uint32_t now) {
        std::vector<uint8_t> frame;
        if (waiting_.empty() || before(now, quietUntil_))
            return frame;
        frame.swap(waiting_);
        uint32_t size = static_cast<uint32_t>(frame.size());
        lineFree_ = (before(lineFree_, now) ? now : lineFree_) + characters(size);
        quietUntil_ = size < longest_ ? lineFree_ + characters(rest) : now;
        return frame;
    }
    // Microseconds until a frame is due; 0xFFFFFFFF: none waits.
    uint32_t deadline(uint32_t now) const {
        if (waiting_.empty())
            return 0xFFFFFFFFu;
        return before(now, quietUntil_) ? quietUntil_ - now : 0;
    }
    void clear(uint32_t now) {
        waiting_.clear();
        lineFree_ = quietUntil_ = now;
    }

private:
    static constexpr uint32_t rest = 4; // characters, more than the modem's RO
    static bool before(uint32_t a, uint32_t b) { return static_cast<int32_t>(a - b) < 0; }
    uint32_t characters(uint32_t count) const {
        return static_cast<uint32_t>(count * characterUs_ + 0.5);
    }

    double characterUs_;
    uint32_t longest_;
    std::vector<uint8_t> waiting_;
    uint32_t lineFree_ = 0, quietUntil_ = 0; // when the line has sent all; when it may send again
};

} // namespace XBeeAT
