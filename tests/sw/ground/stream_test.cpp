// SPDX-License-Identifier: MIT
//
// stream_test: signs of life for a program that cuts silent connections, in simulated time.

#include "stream.h"
#include "wire.h"
#include <gtest/gtest.h>

namespace {

using XBeeAT::Stream;

// By Ice 3.8's manual a connection without incoming bytes for 60 s (Ice.Connection.IdleTimeout) is
// cut; a program that has written nothing for half of it sends a heartbeat. Ice 3.7 sends none by
// itself.
class Program {
public:
    Program() {
        int pair[2];
        if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, pair) != 0)
            throw std::runtime_error("no sockets");
        fd_ = pair[0];
        stream.want(pair[1], "program");
        stream.open(0);
    }
    ~Program() { close(fd_); }
    void endWriting() { shutdown(fd_, SHUT_WR); }

    void send(uint8_t type, U32 seconds) {
        Bytes m = message(0, 14);
        m[8] = type;
        writeAll(fd_, m);
        wroteAt_ = seconds;
        stream.read(seconds * 1000000);
        while (stream.next(8192) == Stream::Next::Message) {
            ++onTheAir;
            stream.taken(seconds * 1000000);
        }
    }
    // The second passes. `isNew`: the program is of Ice 3.8.
    void pass(U32 seconds, bool isNew) {
        if (isNew && seconds - wroteAt_ >= 30)
            send(3, seconds);
        (void)stream.beat(seconds * 1000000);
        uint8_t bytes[100];
        ssize_t count = recv(fd_, bytes, sizeof bytes, 0);
        heard += count > 0;
        heardAt_ = count > 0 ? seconds : heardAt_;
        silence = std::max(silence, seconds - heardAt_);
    }

    Stream stream;
    unsigned onTheAir = 0, heard = 0;
    U32 silence = 0; // the longest, in seconds

private:
    int fd_ = -1;
    U32 wroteAt_ = 0, heardAt_ = 0;
};

TEST(Stream, AProgramThatCutsSilentConnectionsHearsSignsOfLifeWhileIdle) {
    Program program;
    for (U32 second = 1; second < 1200; ++second)
        program.pass(second, true);
    EXPECT_LT(program.silence, 45u);
    EXPECT_EQ(program.onTheAir, 0u);
}

TEST(Stream, AndWhileItSendsAndNothingComesBack) {
    Program program;
    for (U32 second = 1; second < 1200; ++second) {
        if (second % 7 == 0)
            program.send(1, second); // a batch: nobody answers it
        program.pass(second, true);
    }
    EXPECT_LT(program.silence, 45u);
    EXPECT_EQ(program.onTheAir, 1199u / 7);
}

TEST(Stream, SignsOfLifeAreNoActivity) {
    Program program;
    program.send(1, 1);
    for (U32 second = 2; second < 100; ++second)
        program.pass(second, true);
    EXPECT_EQ(program.stream.silentUs(100000000), 99000000u);
    EXPECT_GT(program.heard, 1u);
}

// They would keep its own time-out (Ice.ACM) from closing the connection.
TEST(Stream, AProgramOfTheOldKindIsLeftAloneWhileIdle) {
    Program program;
    program.send(1, 1);
    for (U32 second = 2; second < 1200; ++second)
        program.pass(second, false);
    EXPECT_LE(program.heard, 1u);
}

TEST(Stream, AProgramThatHasEndedItsWritingHearsNoSigns) {
    Program program;
    program.send(1, 1);
    program.endWriting();
    for (U32 second = 2; second < 100; ++second)
        program.pass(second, false);
    EXPECT_EQ(program.heard, 0u);
}

// It cannot be told, so what the kernel still holds of it is counted, too, although the connection
// is reset: a sign of life was left unread.
TEST(Stream, CallsThatAProgramLeftUnreadAreCountedWhenTheLinkIsLost) {
    constexpr unsigned count = 3000;
    int pair[2];
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, pair), 0);
    Stream stream;
    stream.want(pair[1], "program");
    stream.open(0);
    Bytes call = message(0, 14), calls;
    call[8] = 1; // a batch
    for (unsigned i = 0; i < count; ++i)
        calls.insert(calls.end(), call.begin(), call.end());
    writeAll(pair[0], calls);
    stream.read(0);
    (void)stream.beat(20000000);
    close(pair[0]);
    unsigned sent = 0;
    for (; stream.next(8192) == Stream::Next::Message; ++sent)
        stream.taken(0);
    EXPECT_GT(sent, 100u);
    EXPECT_EQ(sent + stream.leave(0), count);
}

} // namespace
