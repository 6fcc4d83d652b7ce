// SPDX-License-Identifier: MIT
//
// program_connection: one connection of a program: the socket, the Ice messages on it, and its
// state between program and link. This file uses only two parts of the Ice protocol: the message
// header and the id of a request (ice_header.h).

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
        Wanted, // the program has requested the connection; the link has not opened the channel yet
        Called, // the vehicle has opened the connection; no program has accepted it yet
        Open,   // messages pass between program and link
        Leaving // the link's channel is closed; the program has not read all messages yet
    };

    ProgramConnection() = default;
    ~ProgramConnection() { close(); }
    ProgramConnection(const ProgramConnection&) = delete;
    ProgramConnection& operator=(const ProgramConnection&) = delete;

    bool is(State state) const { return state_ == state; }
    // want and accept take over the program's socket, which must be non-blocking; the destructor
    // closes the socket. `name` is used in log lines. A message is late if the link has not
    // accepted it within `lateUs`. A program that accepts a connection is a server. Its first
    // ValidateConnection is part of the connection's set-up; later ones are heartbeats.
    static constexpr U32 never = 2000000000;
    void want(int fd, const std::string& name, U32 lateUs = never);
    void call(); // records that the vehicle has opened this connection
    void accept(int fd, const std::string& name);
    void open(U32 nowUs);
    // Records that the link's channel is closed; the program may read the remaining messages for
    // ten seconds. If the program has disconnected, returns the number of its calls that were not
    // sent, because it cannot be informed; otherwise 0.
    unsigned leave(U32 nowUs);
    void close(State to = State::Closed);
    const std::string& name() const { return name_; }
    int fd() const { return fd_; }

    // Returns the descriptor and its events for poll; fd is -1 without events. `reads`
    // decides whether to wait for bytes of the program; pass true if the link has room for
    // messages.
    pollfd interest(bool reads) const;
    void read(U32 nowUs);                 // reads from the program, at most one buffer
    bool ended() const { return ended_; } // true if the program will send nothing more
    enum class Next { None, Message, Senseless };
    // Finds the next complete message of the program, of at most `longest` bytes. Skips heartbeats,
    // because the link itself detects whether the vehicle is there.
    Next next(U32 longest);
    bool isCall() const;                                // true if the next message is a call
    enum class Kind { Twoway, Oneway, Goodbye, Other }; // Oneway: a call that has no reply
    Kind kind() const;
    const U8* data() const { return out_.data(); }
    // Returns the size of the next message, even if the message is malformed.
    U32 size() const { return messageSize(); }
    U32 lateAt() const { return since_ + lateUs_; } // time at which the next message will be late
    // records that the link has accepted the message
    void taken(U32 nowUs);

    // Passes a message to the program. Returns false if the program still has 64 KiB of earlier
    // messages to read.
    bool give(const U8* message, U32 size, U32 nowUs);
    void write(U32 nowUs);
    // Sends the heartbeats that are due; closes a connection that has been closing for too long.
    // Returns the time until the next call, in microseconds. A program that waits for a reply gets
    // a heartbeat after some time without a message. A busy server would also send this heartbeat,
    // but over the air. Any other message of the program, including a heartbeat, is also answered
    // by a heartbeat, because Ice 3.8 closes silent connections. An idle Ice 3.7 program sends no
    // heartbeats and gets none, so it can close its idle connection.
    U32 beat(U32 nowUs);
    // Returns the time since the program last sent a complete message or read a byte. Returns 0
    // while the program waits for a reply.
    U32 silentUs(U32 nowUs) const;
    // Sends Ice's CloseConnection to the program. The program may then open another connection.
    void sayGoodbye(U32 nowUs);
    void greet(U32 nowUs); // sends ValidateConnection, the first message of a server
    // Removes the next message of the program, a two-way call, and replies with an error that
    // contains `why`.
    void refuse(const std::string& why, U32 nowUs);

    static constexpr size_t mostUnread = 64 * 1024; // bytes

private:
    U32 messageSize() const;
    bool giveHead(U8 type, U32 nowUs); // sends the program a message that consists of a header only

    State state_ = State::Closed;
    std::string name_;
    int fd_ = -1;
    std::vector<U8> out_; // bytes read from the program: less than one message plus one buffer
    std::vector<U8> in_;  // bytes not written to the program yet
    bool ended_ = false, isServer_ = false, greeted_ = false;
    // true if the program has received nothing since it last sent something
    bool owesSign_ = false;
    U32 owesSince_ = 0;    // time at which owesSign_ became true
    unsigned pending_ = 0; // number of two-way requests of the program that have no reply yet
    U32 heardAt_ = 0;      // time of the last message to the program
    // lateUs_: time after which a message is late. readAt_: time of the last read. since_: time
    // since which the next message waits.
    U32 lateUs_ = never, readAt_ = 0, since_ = 0;
    // time of the last byte sent or received; time at which closing began
    U32 activeAt_ = 0, leftAt_ = 0;
};

} // namespace XBeeAT
