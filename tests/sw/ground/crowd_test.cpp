// SPDX-License-Identifier: MIT
//
// crowd_test: tests several programs at one engine that do not read, that send more than the link
// can carry, or that disconnect. Also tests heartbeats, in simulated time, for a program that
// closes silent connections.

#include "../../support/delivery_check.h"
#include "program_connection.h"
#include "wire.h"
#include <gtest/gtest.h>
#include <thread>

namespace {

// The program's side of a connection; reading and writing do not block.
class Program {
public:
    explicit Program(int fd) : fd_(fd) {}
    ~Program() { leave(); }
    Program(const Program&) = delete;
    Program& operator=(const Program&) = delete;
    void leave() {
        if (fd_ >= 0)
            close(fd_);
        fd_ = -1;
    }
    void send(const Bytes& bytes) { out_.insert(out_.end(), bytes.begin(), bytes.end()); }
    void write() {
        ssize_t count = ::send(fd_, out_.data(), out_.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
        if (count > 0) {
            out_.erase(out_.begin(), out_.begin() + count);
            written += static_cast<size_t>(count);
        }
        cutOff = cutOff || (count < 0 && errno != EAGAIN);
    }
    void read() {
        uint8_t bytes[4096];
        ssize_t count = recv(fd_, bytes, sizeof bytes, MSG_DONTWAIT);
        got += static_cast<size_t>(std::max<ssize_t>(count, 0));
        cutOff = cutOff || count == 0;
    }
    size_t unwritten() const { return out_.size(); }
    size_t written = 0, got = 0;
    bool cutOff = false;

private:
    int fd_;
    Bytes out_;
};

class Crowd : public ::testing::Test {
protected:
    // Makes a call and checks the reply.
    void echoes(Program& program, size_t size = 30) {
        const size_t want = program.got + size;
        program.send(message(1, size));
        EXPECT_TRUE(wire_.until([&] {
            program.write();
            program.read();
            return program.got >= want || program.cutOff;
        })) << "no answer; the engine's log:\n"
            << wire_.log();
        EXPECT_FALSE(program.cutOff) << wire_.log();
    }
    Wire wire_;
    std::shared_ptr<XBeeAT::Peer> engine_ = wire_.engine();
};

TEST_F(Crowd, AProgramThatNeverReadsIsDisconnectedAndDelaysNoOther) {
    Program deaf(engine_->connect(0)), other(engine_->connect(1));
    echoes(deaf);
    for (int i = 0; i < 40 && !HasFailure(); ++i) {
        deaf.send(message(2, 4000));
        wire_.until(
            [&] {
                deaf.write();
                return deaf.unwritten() == 0 || deaf.cutOff;
            },
            500);
        echoes(other);
    }
    EXPECT_TRUE(wire_.until([&] {
        deaf.write();
        deaf.send({0});
        return deaf.cutOff;
    }));
    EXPECT_NE(wire_.log().find("does not read"), std::string::npos) << wire_.log();
    echoes(other, 8000);
}

TEST_F(Crowd, DataOfAClosedProgramIsDelivered) {
    wire_.echo = false;
    Program program(engine_->connect(0));
    constexpr unsigned count = 3000;
    DeliveryCheck delivery;
    for (unsigned i = 0; i < count; ++i) {
        const Bytes oneway = message(static_cast<uint8_t>(i));
        program.send(oneway);
        delivery.sent(0, i, oneway);
    }
    wire_.onMessage = [&](int channel, const Bytes& oneway) {
        EXPECT_EQ(delivery.arrived(channel, oneway), "");
    };
    // largest number of bytes in transit: written by the program and not yet received by the peer
    size_t most = 0;
    ASSERT_TRUE(wire_.until([&] {
        program.write();
        most = std::max(most, program.written - wire_.received[0] * message(1).size());
        return program.unwritten() == 0;
    }));
    program.leave();
    EXPECT_TRUE(wire_.until([&] { return wire_.received[0] > 0 && !wire_.open[0]; }));
    EXPECT_EQ(wire_.received[0], count) << wire_.log();
    EXPECT_LT(most, 64u * 1024) << "the engine reads more than it can send";
}

TEST_F(Crowd, UndeliveredCallsOfAClosedProgramAreReported) {
    Program program(engine_->connect(0));
    echoes(program);
    Bytes call = message(1);
    call[8] = 0; // a request
    for (int i = 0; i < 20; ++i)
        program.send(call);
    program.write();
    program.leave();
    // the UAV receives nothing, so the engine must end the connection
    while (wire_.log().find("has ended") == std::string::npos)
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    engine_.reset();
    EXPECT_NE(wire_.log().find("may not have reached the UAV: 20"), std::string::npos)
        << wire_.log();
}

TEST_F(Crowd, EveryNewProgramIsServedAfterAFlood) {
    for (unsigned round = 0; round < 3; ++round) {
        std::vector<std::unique_ptr<Program>> flood;
        for (int i = 0; i < 3; ++i) {
            flood.push_back(std::make_unique<Program>(engine_->connect(-1)));
            echoes(*flood.back());
            for (int k = 0; k < 200; ++k)
                flood.back()->send(message(1));
        }
        const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(200);
        wire_.until([&] {
            for (auto& program : flood)
                program->write();
            return std::chrono::steady_clock::now() > end;
        });
        flood.clear(); // ends the programs in the middle of a message
        for (int i = 0; i < 3; ++i) {
            unsigned openings = 2 * round + 1;
            Program next(engine_->connect(i));
            echoes(next);
            EXPECT_EQ(wire_.openings[i], ++openings) << "the UAV must greet each new program";
        }
        wire_.until([] {
            static int n;
            return ++n % 50 == 0;
        });
    }
}

// Three programs occupy their channels without using them: they leave replies unread, or never
// complete a message. After some time, a fourth program must get one of these channels.
class Keepers : public ::testing::Test {
protected:
    // Checks that the fourth program gets a reply while the other three programs repeat
    // `meanwhile`.
    template <class F> void theFourthIsServed(F meanwhile) {
        Program fourth(engine_->connect(-1));
        fourth.send(message(1));
        EXPECT_TRUE(wire_.until([&] {
            for (auto& keeper : keepers_)
                meanwhile(*keeper);
            fourth.write();
            fourth.read();
            return fourth.got > 0;
        })) << wire_.log();
    }
    void SetUp() override {
        for (int i = 0; i < 3; ++i)
            keepers_.push_back(std::make_unique<Program>(engine_->connect(i)));
    }
    Wire wire_;
    std::shared_ptr<XBeeAT::Peer> engine_ = wire_.engine(300);
    std::vector<std::unique_ptr<Program>> keepers_;
};

TEST_F(Keepers, ProgramsThatNeverReadGiveUpTheirChannel) {
    for (auto& keeper : keepers_)
        for (int i = 0; i < 10; ++i)
            // more bytes than the socket accepts, but not a complete message
            keeper->send(message(1, 4000));
    theFourthIsServed([](Program& keeper) { keeper.write(); });
}

TEST_F(Keepers, ProgramsThatNeverCompleteAMessageGiveUpTheirChannel) {
    for (auto& keeper : keepers_) {
        const Bytes whole = message(1, 8000);
        keeper->send({whole.begin(), whole.begin() + 14});
    }
    unsigned calls = 0;
    theFourthIsServed([&](Program& keeper) {
        if (++calls % 20 == 0)
            keeper.send({1});
        keeper.write();
    });
}

TEST_F(Crowd, AFloodLeavesRoomForOtherClients) {
    Program flood(engine_->connect(0)), other(engine_->connect(1));
    wire_.until([&] {
        if (flood.unwritten() < 100'000)
            flood.send(message(1, 1000));
        flood.write();
        flood.read();
        return flood.got > 20'000;
    });
    for (int i = 0; i < 3; ++i) {
        const size_t want = other.got + 30, before = flood.got;
        other.send(message(1));
        ASSERT_TRUE(wire_.until([&] {
            if (flood.unwritten() < 100'000)
                flood.send(message(1, 1000));
            flood.write();
            flood.read();
            other.write();
            other.read();
            return other.got >= want;
        }));
        // Only the part of the flood that is already in the link's queue is sent first.
        EXPECT_LT(flood.got - before, 60'000u);
    }
}

using XBeeAT::ProgramConnection;

// According to Ice 3.8's manual, a connection on which no bytes arrive for 60 s
// (Ice.Connection.IdleTimeout) is closed, and a program that has written nothing for half of this
// time sends a heartbeat. Ice 3.7 sends no heartbeats by itself.
class Timed {
public:
    Timed() {
        int pair[2];
        if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, pair) != 0)
            throw std::runtime_error("no sockets");
        fd_ = pair[0];
        stream.want(pair[1], "program");
        stream.open(0);
    }
    ~Timed() { close(fd_); }
    void endWriting() { shutdown(fd_, SHUT_WR); }

    void send(uint8_t type, U32 seconds) {
        Bytes m = message(0, 14);
        m[8] = type;
        writeAll(fd_, m);
        wroteAt_ = seconds;
        stream.read(seconds * 1000000);
        while (stream.next(8192) == ProgramConnection::Next::Message) {
            ++onTheAir;
            stream.taken(seconds * 1000000);
        }
    }
    // Lets the engine and the program work at the time `seconds` after the start of the test.
    // `isNew` is true if the program uses Ice 3.8.
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

    ProgramConnection stream;
    unsigned onTheAir = 0, heard = 0;
    U32 silence = 0; // longest time without a byte, s

private:
    int fd_ = -1;
    U32 wroteAt_ = 0, heardAt_ = 0;
};

TEST(ProgramConnection, AProgramThatClosesSilentConnectionsGetsHeartbeatsWhileIdle) {
    Timed program;
    for (U32 second = 1; second < 1200; ++second)
        program.pass(second, true);
    EXPECT_LT(program.silence, 45u);
    EXPECT_EQ(program.onTheAir, 0u);
}

TEST(ProgramConnection, AProgramGetsHeartbeatsWhileItOnlySends) {
    Timed program;
    for (U32 second = 1; second < 1200; ++second) {
        if (second % 7 == 0)
            program.send(1, second); // a batch request, which has no reply
        program.pass(second, true);
    }
    EXPECT_LT(program.silence, 45u);
    EXPECT_EQ(program.onTheAir, 1199u / 7);
}

TEST(ProgramConnection, HeartbeatsAreNoActivity) {
    Timed program;
    program.send(1, 1);
    for (U32 second = 2; second < 100; ++second)
        program.pass(second, true);
    EXPECT_EQ(program.stream.silentUs(100000000), 99000000u);
    EXPECT_GT(program.heard, 1u);
}

// The engine sends no heartbeats to a program with Ice 3.7, because they would prevent the
// program's own time-out (Ice.ACM) from closing the connection.
TEST(ProgramConnection, AnOldProgramGetsNoHeartbeatsWhileIdle) {
    Timed program;
    program.send(1, 1);
    for (U32 second = 2; second < 1200; ++second)
        program.pass(second, false);
    EXPECT_LE(program.heard, 1u);
}

TEST(ProgramConnection, AProgramThatHasEndedItsWritingGetsNoHeartbeats) {
    Timed program;
    program.send(1, 1);
    program.endWriting();
    for (U32 second = 2; second < 100; ++second)
        program.pass(second, false);
    EXPECT_EQ(program.heard, 0u);
}

// A program has written calls and disconnected. If the link is then lost, the program cannot be
// notified, so its calls are counted as not received. This includes the calls that the kernel still
// holds, although the kernel resets the connection because of an unread heartbeat.
TEST(ProgramConnection, UnreadCallsAreCountedWhenTheLinkIsLost) {
    constexpr unsigned count = 3000;
    int pair[2];
    ASSERT_EQ(socketpair(AF_UNIX, SOCK_STREAM | SOCK_NONBLOCK, 0, pair), 0);
    ProgramConnection stream;
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
    for (; stream.next(8192) == ProgramConnection::Next::Message; ++sent)
        stream.taken(0);
    EXPECT_GT(sent, 100u);
    EXPECT_EQ(sent + stream.leave(0), count);
}

} // namespace
