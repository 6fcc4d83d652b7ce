// SPDX-License-Identifier: MIT
//
// rival_station: leaves a vehicle to another ground station with the same address, and resumes
// later.
//
// The other ground station has the vehicle if the session of this side ended while the vehicle
// continued to send to another one. Two ground stations that both call would take the vehicle from
// each other forever.

#pragma once

#include <cstddef>

extern "C" {
#include "link.h"
}

namespace XBeeAT {

class RivalStation {
public:
    void reset() { isYielded_ = isLost_ = hearsOther_ = false; }
    bool isYielded() const { return isYielded_; }

    // Examines bytes from the vehicle before the link processes them. Returns false if the link
    // must not get the bytes. While this side has yielded, only a HELLO of the vehicle at the
    // beginning of a packet is accepted, because it means that the vehicle has no session. The
    // HELLO is in hello(); `bytes` and `size` are set to the bytes after it.
    bool admits(const U8*& bytes, size_t& size, U32 now) {
        if (now - heardAt_ >= LINK_FRAME_GAP)
            headSize_ = 0;
        heardAt_ = now;
        if (!isYielded_)
            return true;
        for (; size && headSize_ < LINK_HEADER; --size)
            head_[headSize_++] = *bytes++;
        return headSize_ == LINK_HEADER && LINK_KIND_OF(head_) == LINK_KIND_HELLO &&
               head_[1] == LINK_VERSION;
    }
    const U8* hello() const { return head_; }
    // Records whether the last frame that was heard belongs to this side's session.
    void heard(bool isOwn) { hearsOther_ = !isOwn; }
    // Records that the session has begun or ended.
    void sessionIs(bool isUp, U32 now) {
        isLost_ = !isUp && hearsOther_ && now - heardAt_ < speaksWithinUs;
    }

    // Returns the next action. `connects` is true if the link calls the vehicle. `callsAgain` is
    // true if the vehicle does not call this ground station by itself; this side then calls after a
    // minute.
    enum class Step { None, Yield, Resume };
    Step poll(bool connects, bool callsAgain, U32 now) {
        const bool yields = isLost_ && connects;
        isLost_ = false;
        if (yields) {
            isYielded_ = true;
            heardAt_ = yieldedAt_ = now;
            headSize_ = LINK_HEADER; // the current packet is not a HELLO
            head_[0] = 0;
            return Step::Yield;
        }
        const bool isOver = isYielded_ && (now - heardAt_ >= quietUs ||
                                           (callsAgain && now - yieldedAt_ >= longestUs));
        return isOver ? Step::Resume : Step::None;
    }
    void resume() { isYielded_ = hearsOther_ = false; }

private:
    // silence after which this station assumes that the other one has lost the vehicle
    static constexpr U32 quietUs = LINK_AGE_LAST;
    static constexpr U32 longestUs = 60'000'000;
    // A vehicle with a session sends at least this often, because it is pinged when silent. Earlier
    // bytes belong to a frame that a reset has cut.
    static constexpr U32 speaksWithinUs = LINK_PING_AFTER + 4 * LINK_PING_EVERY;

    bool isYielded_ = false;
    bool isLost_ = false;     // the session ended while another one was heard
    bool hearsOther_ = false; // the last frame belonged to another session
    U32 heardAt_ = 0, yieldedAt_ = 0;
    U8 head_[LINK_HEADER]; // header of the current packet, while yielded
    U32 headSize_ = 0;
};

} // namespace XBeeAT
