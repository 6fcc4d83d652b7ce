// SPDX-License-Identifier: MIT
//
// program_connection: one connection of a program: its socket, the Ice messages on it, and its
// state between program and link. Of the Ice protocol, this file uses only the message header and
// the id of a request (ice_header.h).

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
        Called, // the peer has opened the connection; no program has taken it yet
        Open,   // messages pass between program and link
        Leaving // the link's channel is closed; the program has not read everything yet
    };

    ProgramConnection() = default;
    ~ProgramConnection() { close(); }
    ProgramConnection(const ProgramConnection&) = delete;
    ProgramConnection& operator=(const ProgramConnection&) = delete;

    bool is(State state) const { return state_ == state; }
    // Takes the program's socket, which must be non-blocking; the destructor closes it. `name` is
    // used in log lines. A called program is a server, and its first ValidateConnection is its
    // greeting. A message is late if the peer has not taken it after `lateUs`.
    static constexpr U32 never = 2000000000;
    void want(int fd, const std::string& name, U32 lateUs = never);
    void call(); // reports that the peer opened this connection
    void accept(int fd, const std::string& name);
    void open(U32 nowUs);
    // Records that the link's channel is closed; the program may read the remaining messages for
    // ten seconds. Returns the number of calls that were not sent, if the program has disconnected
    // and cannot be informed.
    unsigned leave(U32 nowUs);
    void close(State to = State::Closed);
    const std::string& name() const { return name_; }
    int fd() const { return fd_; }

    // Returns the events for poll, or fd -1 for no events. `reads` is true if the link has room for
    // messages.
    pollfd interest(bool reads) const;
    void read(U32 nowUs);                 // reads from the program, at most one buffer
    bool ended() const { return ended_; } // true if the program will send nothing more
    enum class Next { None, Message, Senseless };
    // Finds the next complete message of at most `longest` bytes. Heartbeats are skipped, because
    // the link itself detects whether the peer is there.
    Next next(U32 longest);
    bool isCall() const;                                // true if the next message is a call
    enum class Kind { Twoway, Oneway, Goodbye, Other }; // Oneway: a call that has no reply
    Kind kind() const;
    const U8* data() const { return out_.data(); }
    // Returns the size of the next message, also of a malformed one.
    U32 size() const { return messageSize(); }
    U32 lateAt() const { return since_ + lateUs_; } // time at which the next message will be late
    // records that the link has accepted the message
    void taken(U32 nowUs);

    // Passes a message to the program. Returns false if the program has not read 64 KiB of earlier
    // messages.
    bool give(const U8* message, U32 size, U32 nowUs);
    void write(U32 nowUs);
    // Sends a heartbeat if the program waits for a reply and has received nothing for a while, as a
    // busy server would, but without using the air. Other messages of the program, including
    // heartbeats, are also answered by a heartbeat, because Ice 3.8 closes silent connections. Ice
    // 3.7 sends no heartbeats while it is idle, and gets none, so that it can close its idle
    // connections. This function also ends a closing that takes too long. Returns the time of the
    // next call, in microseconds.
    U32 beat(U32 nowUs);
    // Returns the time since the program last sent a complete message or read a byte; 0 while the
    // program waits for a reply.
    U32 silentUs(U32 nowUs) const;
    // Sends Ice's CloseConnection to the program, which may then open another connection.
    void sayGoodbye(U32 nowUs);
    void greet(U32 nowUs); // sends the first message of a server
    // Removes the next message, a two-way call, and replies to it with an error that contains
    // `text`.
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
    bool owesSign_ =
        false;          // true if the program has sent something since it last received something
    U32 owesSince_ = 0; // since then
    unsigned pending_ = 0; // two-way requests of the program without a reply so far
    U32 heardAt_ = 0;      // time of the last message to the program
    // time at which the current message is late; time of the last read; time since which the next
    // message waits
    U32 lateUs_ = never, readAt_ = 0, since_ = 0;
    // time of the last byte sent or received; time at which closing began
    U32 activeAt_ = 0, leftAt_ = 0;
};

} // namespace XBeeAT
