// SPDX-License-Identifier: MIT
//
// rival_station: decides when this ground station yields a vehicle to another ground station with
// the same address, and when it calls the vehicle again.
//
// The other ground station has the vehicle if this station's session ended while the vehicle was
// still sending to another station. If both ground stations continued to call, they would take the
// vehicle from each other forever.

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
    // must not get the bytes. While this station has yielded, only a packet that begins with a
    // HELLO of the vehicle is accepted; a HELLO means that the vehicle has no session. The HELLO is
    // then in hello(), and `bytes` and `size` describe the bytes after it.
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
    // Records that a frame was heard. isOwn is true if the frame belongs to this station's session.
    void heard(bool isOwn) { hearsOther_ = !isOwn; }
    // Records that the session has begun or ended.
    void sessionIs(bool isUp, U32 now) {
        isLost_ = !isUp && hearsOther_ && now - heardAt_ < speaksWithinUs;
    }

    // Returns the step that is due. `connects` is true while this station tries to begin a session.
    // `callsAgain` is true if the vehicle never calls this station; this station then calls the
    // vehicle again after a minute.
    enum class Step { None, Yield, Resume };
    Step poll(bool connects, bool callsAgain, U32 now) {
        const bool yields = isLost_ && connects;
        isLost_ = false;
        if (yields) {
            isYielded_ = true;
            heardAt_ = yieldedAt_ = now;
            // the rest of the packet that is arriving is not taken for a HELLO
            headSize_ = LINK_HEADER;
            head_[0] = 0;
            return Step::Yield;
        }
        const bool isOver = isYielded_ && (now - heardAt_ >= quietUs ||
                                           (callsAgain && now - yieldedAt_ >= longestUs));
        return isOver ? Step::Resume : Step::None;
    }
    void resume() { isYielded_ = hearsOther_ = false; }

private:
    // silence after which this station assumes that the other station has lost the vehicle
    static constexpr U32 quietUs = LINK_AGE_LAST;
    static constexpr U32 longestUs = 60'000'000;
    // Longest time for which a vehicle in a session sends nothing: its station pings a silent
    // vehicle, and the vehicle answers. After a longer silence, the vehicle has no session with
    // another station, and the bytes that arrived last belong to a frame that a reset of the
    // vehicle has cut off.
    static constexpr U32 speaksWithinUs = LINK_PING_AFTER + 4 * LINK_PING_EVERY;

    bool isYielded_ = false;
    bool isLost_ = false;     // the session ended while the vehicle was sending to another station
    bool hearsOther_ = false; // the last frame that was heard belonged to another station's session
    U32 heardAt_ = 0, yieldedAt_ = 0;
    // header of the packet that is arriving; used only while this station has yielded
    U8 head_[LINK_HEADER];
    U32 headSize_ = 0;
};

} // namespace XBeeAT
