// SPDX-License-Identifier: MIT
//
// broadcast: sends one call at a time to all vehicles on the channel. Broadcasts are not
// acknowledged, so several copies of each call are sent at different times.

#pragma once

#include "settings.h"

#include <algorithm>
#include <cstring>

extern "C" {
#include "link_broadcast.h"
}

namespace XBeeAT {

class Broadcast {
public:
    // `keys` are the group's keys, the current one last. Without keys, calls are sent unencrypted.
    Broadcast(const Settings& settings, const LinkKeys& keys)
        : settings_(settings), key_(keys.empty() ? LinkKey{} : keys.back()) {}
    ~Broadcast() { explicit_bzero(key_.data(), key_.size()); }

    // Records that the modem is ready. `bytes` is the size of its largest packet.
    void limitPacket(U32 bytes) { most_ = bytes - LINK_BROADCAST_OVERHEAD; }
    void stop() { most_ = copies_ = 0; } // sends no more copies
    // Returns the size of the largest message, bytes; 0 if the modem is not ready.
    U32 most() const { return most_; }
    bool isBusy() const { return copies_ != 0; }
    // Starts sending a message. Returns false if another message is still being sent, or if the
    // clock of this machine shows a date before 2026.
    bool take(const U8* message, U32 size, U32 now) {
        const int64_t number = settings_.quarters();
        if (number <= 0)
            return false;
        number_ = std::max(number_ + 1, static_cast<U32>(number));
        for (U32 at = LINK_BROADCAST_HEAD - 8; at < LINK_BROADCAST_HEAD; at += 4)
            link_put32(packet_ + at, settings_.random());
        std::memcpy(packet_ + LINK_BROADCAST_HEAD, message, size);
        size_ = Link_sealBroadcast(packet_, size, key_.data(), number_);
        copies_ = copies;
        dueAt_ = now;
        return true;
    }
    // Passes the copy that is due to `transmit`. Returns the time until the next call, in
    // microseconds.
    template <class Transmit> U32 poll(U32 now, Transmit transmit) {
        if (copies_ && !LINK_BEFORE(now, dueAt_)) {
            if (!transmit(packet_, size_))
                return LINK_POLL_EVERY;
            --copies_;
            dueAt_ = now + leastUs + settings_.random() % spreadUs;
        }
        return copies_ ? dueAt_ - now : 0xFFFFFFFFu;
    }

private:
    // Number of copies of a call. With 30 % loss, a vehicle misses all five copies of a call once
    // in 400 calls. Sending the copies takes longer than a quarter of a second. The numbers of
    // calls, which count quarters of a second, therefore never run ahead of the clock. Each copy
    // waits for a random time, so that one short disturbance does not destroy all copies.
    static constexpr unsigned copies = 5;
    static constexpr U32 leastUs = 70000, spreadUs = 80000;

    const Settings& settings_;
    LinkKey key_;
    U8 packet_[LINK_MAX_FRAME];
    U32 size_ = 0, most_ = 0, number_ = 0, dueAt_ = 0;
    unsigned copies_ = 0; // number of copies of the packet that are still to be sent
};

} // namespace XBeeAT
