// SPDX-License-Identifier: MIT
//
// yielding: leaves a vehicle to another ground that has the same address, and takes it back later.
//
// The other ground has the vehicle if this side's session ended while the vehicle continued to
// speak, and not to this side. Two grounds that both call would take the vehicle from each other
// for ever.

#pragma once

#include <cstddef>

extern "C" {
#include "link.h"
}

namespace XBeeAT {

class Yielding {
public:
    void reset() { isYielded_ = isLost_ = hearsOther_ = false; }
    bool isYielded() const { return isYielded_; }

    // Takes bytes from the vehicle before the link does. Returns false if the link may not have
    // them: while yielded only the vehicle's HELLO at the beginning of a packet counts, which means
    // that the vehicle has no session any more. The HELLO is in hello(); `bytes` and `size` are
    // what follows it.
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
    // Notes whether the frame that was heard last belongs to this side's session.
    void heard(bool isOwn) { hearsOther_ = !isOwn; }
    // The session has changed its state.
    void sessionIs(bool isUp, U32 now) {
        isLost_ = !isUp && hearsOther_ && now - heardAt_ < speaksWithinUs;
    }

    // Returns what is to be done now. `connects`: the link calls the vehicle; `callsAgain`: the
    // vehicle does not call this ground by itself, so that this ground calls after a minute.
    enum class Step { None, Yield, Resume };
    Step poll(bool connects, bool callsAgain, U32 now) {
        const bool yields = isLost_ && connects;
        isLost_ = false;
        if (yields) {
            isYielded_ = true;
            heardAt_ = yieldedAt_ = now;
            headSize_ = LINK_HEADER; // the packet under way is not a HELLO
            head_[0] = 0;
            return Step::Yield;
        }
        const bool isOver = isYielded_ && (now - heardAt_ >= quietUs ||
                                           (callsAgain && now - yieldedAt_ >= longestUs));
        return isOver ? Step::Resume : Step::None;
    }
    void resume() { isYielded_ = hearsOther_ = false; }

private:
    static constexpr U32 quietUs = LINK_AGE_LAST; // silence of a vehicle that the other has lost
    static constexpr U32 longestUs = 60'000'000;
    // A vehicle with a session speaks at least this often, since it is asked when it is silent.
    // What was heard before is a frame that a reset has cut.
    static constexpr U32 speaksWithinUs = LINK_PING_AFTER + 4 * LINK_PING_EVERY;

    bool isYielded_ = false;
    bool isLost_ = false;     // the session ended while another one was heard
    bool hearsOther_ = false; // the last frame belonged to another session
    U32 heardAt_ = 0, yieldedAt_ = 0;
    U8 head_[LINK_HEADER]; // of the packet under way, while yielded
    U32 headSize_ = 0;
};

} // namespace XBeeAT
