// SPDX-License-Identifier: MIT
//
// turns: shares bytes fairly among any number of flows (self-clocked fair queueing).
//
// Each flow has a tag, which is a value of a common clock. A flow that begins to wait gets the
// current clock value as its tag. Each time the flow sends, the number of bytes sent is added to
// its tag. The flow that would have the lowest tag after its next message sends next. A flow that
// sends little therefore waits only a little longer than the bytes in flight take.

#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <map>

namespace gateway {

template <class Flow> class Turns {
public:
    // Records that a flow has something to send, so that it takes part in the turns.
    void wait(const Flow& flow) {
        Entry& entry = entries_[flow];
        if (!entry.isWaiting)
            entry = {std::max(entry.tag, clock_), true};
    }
    // Returns the tag that a waiting flow would have after sending `bytes`. The flow with the
    // lowest result is next.
    uint64_t after(const Flow& flow, size_t bytes) const { return entries_.at(flow).tag + bytes; }
    // Records that a waiting flow sends `bytes`, and advances the clock.
    void take(const Flow& flow, size_t bytes) {
        uint64_t& tag = entries_.at(flow).tag;
        tag += bytes;
        clock_ = std::max(clock_, tag);
    }
    // Records that a flow has nothing more to send.
    void rest(const Flow& flow) {
        const auto entry = entries_.find(flow);
        if (entry == entries_.end())
            return;
        entry->second.isWaiting = false;
        // removes each flow that does not wait and has a tag up to clock_. Nothing is lost: when
        // such a flow waits again, its tag becomes clock_, like the tag of a new flow.
        for (auto each = entries_.begin(); each != entries_.end();) {
            const bool isOver = !each->second.isWaiting && each->second.tag <= clock_;
            each = isOver ? entries_.erase(each) : std::next(each);
        }
    }
    void remove(const Flow& flow) { entries_.erase(flow); }

private:
    struct Entry {
        uint64_t tag = 0;
        bool isWaiting = false;
    };
    uint64_t clock_ = 0;
    std::map<Flow, Entry> entries_;
};

} // namespace gateway
