// SPDX-License-Identifier: MIT
//
// stream: one connection of the program: its end of a socket pair, and the Ice messages on it. It
// knows nothing of Ice but the 14 bytes before each message and a request's number.

#ifndef GROUND_STREAM_H
#define GROUND_STREAM_H

#include <vector>

extern "C" {
#include "base.h"
}

namespace XBeeAT {

class Stream {
public:
    Stream() = default;
    ~Stream() { close(); }
    Stream(const Stream&) = delete;
    Stream& operator=(const Stream&) = delete;

    // A new socket pair; returns the program's end, -1 on failure. `isServer`: the program is one,
    // and its first ValidateConnection is its greeting.
    int open(bool isServer);
    void close();
    bool isOpen() const { return fd_ >= 0; }
    int fd() const { return fd_; }
    bool isLeft() const; // the program has closed its end, or has written already

    // From the program. False: it has closed.
    bool read();
    enum class Next { None, Message, Senseless };
    // The next whole message, at most `longest` bytes; heartbeats are left out, because the link
    // itself knows whether the peer is there.
    Next next(U32 longest);
    bool hasBytes() const { return !out_.empty(); } // whole messages or not
    const U8* data() const { return out_.data(); }
    U32 size() const { return messageSize(); } // also of one that makes no sense
    void taken(U32 nowUs);                     // the link has it

    // To the program. False: the last one is not written yet.
    bool give(const U8* message, U32 size, U32 nowUs);
    bool wantsWriting() const { return !in_.empty(); }
    void write();
    // A heartbeat, if the program waits for an answer and has heard nothing for a while: as a
    // server that runs long would send it, but without air. Returns when to come again, in
    // microseconds.
    U32 beat(U32 nowUs);

    bool wanted = false; // to be opened when the link is up
    bool stuck = false;  // the link's queue was full

private:
    U32 messageSize() const;

    int fd_ = -1;
    std::vector<U8> out_; // from the program
    std::vector<U8> in_;  // to the program, not yet written
    bool isServer_ = false, greeted_ = false;
    unsigned pending_ = 0; // two-way requests of the program that are not answered yet
    U32 heardAt_ = 0;      // when it got its last message
};

} // namespace XBeeAT

#endif
