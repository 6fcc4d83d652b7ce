// SPDX-License-Identifier: MIT
//
// program_connection: one connection of a program: its socket, the Ice messages on it, and its
// state between program and link. It knows only Ice's message header and a request's number
// (ice_header.h).

#pragma once

#include <poll.h>
#include <string>
#include <vector>

extern "C" {
#include "base.h"
}

namespace XBeeAT {

class ProgramConnection {
public:
    enum class State {
        Closed,
        Wanted, // by the program; the link has yet to open the channel
        Called, // by the peer; no program has taken it yet
        Open,   // between program and link
        Leaving // the link's channel is closed; the program has yet to take what came
    };

    ProgramConnection() = default;
    ~ProgramConnection() { close(); }
    ProgramConnection(const ProgramConnection&) = delete;
    ProgramConnection& operator=(const ProgramConnection&) = delete;

    bool is(State state) const { return state_ == state; }
    // Takes the program's socket (and closes it in the end), which must not block. `name` is for
    // log lines. A program that was called is a server, and its first ValidateConnection is its
    // greeting.
    // A message is late when the peer has not taken it after `lateUs`.
    static constexpr U32 never = 2000000000;
    void want(int fd, const std::string& name, U32 lateUs = never);
    void call(); // by the peer
    void accept(int fd, const std::string& name);
    void open(U32 nowUs);
    // The link's channel is closed; the program may take the rest for ten seconds. Returns the
    // number of calls that were not sent, if the program has gone and cannot be told.
    unsigned leave(U32 nowUs);
    void close(State to = State::Closed);
    const std::string& name() const { return name_; }
    int fd() const { return fd_; }

    // Tells which events poll must wait for; fd -1 is none. `reads`: the link has room for
    // messages.
    pollfd interest(bool reads) const;
    void read(U32 nowUs);                 // from the program, at most a buffer
    bool ended() const { return ended_; } // the program sends no more
    enum class Next { None, Message, Senseless };
    // Finds the next whole message, at most `longest` bytes. Heartbeats are left out: the link
    // knows whether the peer is there.
    Next next(U32 longest);
    bool isCall() const;                                // whether the message is a call
    enum class Kind { Twoway, Oneway, Goodbye, Other }; // Oneway: one call without an answer
    Kind kind() const;
    const U8* data() const { return out_.data(); }
    U32 size() const { return messageSize(); }      // also of a message that makes no sense
    U32 lateAt() const { return since_ + lateUs_; } // when the next message will be late
    void taken(U32 nowUs);                          // the link has taken the message

    // Hands the program a message. False: the program has left 64 KiB unread.
    bool give(const U8* message, U32 size, U32 nowUs);
    void write(U32 nowUs);
    // Sends a heartbeat if the program waits for an answer and has heard nothing for a while, as a
    // busy server would, but without air. One also follows other messages of the program, its own
    // heartbeats included, since Ice 3.8 cuts silent connections. Ice 3.7 is silent itself while
    // idle, and hears none, so that it can close its idle connections. Ends a leaving that takes
    // too long.
    // Returns when to call again, in microseconds.
    U32 beat(U32 nowUs);
    // Returns how long the program has neither sent a whole message nor taken a byte; 0: it waits
    // for an answer.
    U32 silentUs(U32 nowUs) const;
    // Tells the program, in Ice's words, that the connection closes and it may open another one.
    void sayGoodbye(U32 nowUs);
    void greet(U32 nowUs); // as a server does
    // Takes the next message, a call that waits for an answer, which is an error with this text.
    void refuse(const std::string& why, U32 nowUs);

    static constexpr size_t mostUnread = 64 * 1024; // bytes

private:
    U32 messageSize() const;
    bool giveHead(U8 type, U32 nowUs); // a message that is a head only

    State state_ = State::Closed;
    std::string name_;
    int fd_ = -1;
    std::vector<U8> out_; // from the program: less than a message and a buffer
    std::vector<U8> in_;  // to the program, not yet written
    bool ended_ = false, isServer_ = false, greeted_ = false;
    bool owesSign_ = false; // the program has sent something since it last heard something,
    U32 owesSince_ = 0;     // since then
    unsigned pending_ = 0;  // two-way requests of the program that are not answered yet
    U32 heardAt_ = 0;       // when it got its last message
    U32 lateUs_ = never, readAt_ = 0, since_ = 0; // last read; since when the next message waits
    U32 activeAt_ = 0, leftAt_ = 0; // when it last sent or took something; when its leaving began
};

} // namespace XBeeAT
