// SPDX-License-Identifier: MIT
//
// engine_test: tests the engine of the ground with a modem on a pty.

#include "../../support/environment.h"
#include "engine.h"
#include "rig.h"
#include "wire.h"
#include <csignal>
#include <filesystem>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <termios.h>
#include <unistd.h>

namespace {

class EngineTest : public ::testing::Test {
protected:
    EngineTest() {
        rig_.setHurried(true);
        rig_.with([&] { rig_.uav.echo = true; });
    }
    XBeeAT::Settings settings() {
        XBeeAT::Settings s;
        s.device = rig_.pty.path();
        s.guardMs = Rig::guardMs;
        s.downMs = 300;
        return s;
    }
    std::shared_ptr<XBeeAT::Peer> start() { return start(settings()); }
    std::shared_ptr<XBeeAT::Peer> start(const XBeeAT::Settings& settings) {
        return XBeeAT::Engine::get(settings, log_.taker());
    }
    // Makes a call and compares the reply byte by byte.
    void echoes(int fd, uint8_t tag, size_t size = 30) {
        writeAll(fd, message(tag, size));
        Bytes got = rig_.read(fd, size);
        EXPECT_TRUE(got == message(tag, size))
            << got.size() << " of " << size << " bytes; the engine's log:\n"
            << log_.text();
    }
    // Checks that a call made by the UAV reaches the program that listens.
    void isCalled(XBeeAT::Peer& engine, int ready) {
        rig_.with([&] {
            Link_openChannel(rig_.uav.link(), 3);
            Bytes m = message(5);
            Link_send(rig_.uav.link(), 3, m.data(), static_cast<U32>(m.size()), 0);
        });
        ASSERT_TRUE(rig_.isReadable(ready));
        int fd = engine.accept();
        ASSERT_GE(fd, 0);
        EXPECT_EQ(rig_.read(fd, 30), message(5));
        close(fd);
    }

    EngineLog log_;
    Rig rig_{testSeed()};
};

TEST_F(EngineTest, MoreProgramsThanChannelsWaitTheirTurn) {
    auto engine = start();
    int fds[3];
    for (int& fd : fds)
        echoes(fd = engine->connect(-1), 1);
    int gone = engine->connect(-1), next = engine->connect(-1), last = engine->connect(1);
    EXPECT_EQ(engine->waiting(), 3u);
    close(gone);
    close(fds[2]);
    echoes(next, 2); // a reply for the program that has disconnected must not reach this program
    close(fds[0]);
    close(fds[1]);
    echoes(last, 3);
    rig_.with([&] { EXPECT_EQ(rig_.uav.opened.back(), std::make_pair(1, 1)); });
    EXPECT_EQ(engine->waiting(), 0u);
    close(next);
    close(last);
}

TEST_F(EngineTest, AModemResetInFlightIsSetUpAgain) {
    auto engine = start();
    int fd = engine->connect(0);
    echoes(fd, 1);
    rig_.with([&] {
        rig_.ground->resetPin(true, rig_.ns());
        rig_.ground->resetPin(false, rig_.ns() + 1000);
        EXPECT_EQ(rig_.ground->parameter("BD"), 3u);
    });
    EXPECT_TRUE(rig_.read(fd, 1).empty()); // the program is notified that the connection was lost
    close(fd);
    fd = engine->connect(0); // this call waits until the link is up again
    echoes(fd, 2);
    close(fd);
    EXPECT_EQ(rig_.with([&] { return rig_.ground->parameter("BD"); }), 7u);
    EXPECT_EQ(rig_.with([&] { return rig_.ground->parameter("AP"); }), 1u);
    EXPECT_TRUE(log_.has("Configuring the modem again"));
}

TEST_F(EngineTest, ATooLongMessageEndsOnlyItsConnection) {
    auto engine = start();
    int good = engine->connect(0), bad = engine->connect(1);
    echoes(good, 1);
    writeAll(bad, message(2, 9000));
    EXPECT_TRUE(rig_.read(bad, 1).empty());
    EXPECT_TRUE(log_.has("too long for the radio link"));
    echoes(good, 3);
    close(good);
    close(bad);
}

// If the UAV's program does not accept a message in time, this message and the next one are
// withdrawn, and not delivered later.
TEST_F(EngineTest, LateMessagesAreWithdrawnAndReported) {
    auto engine = start();
    const int other = engine->connect(0), fd = engine->connect(1, 2000);
    ASSERT_TRUE(rig_.until([&] { return rig_.uav.opened.size() == 2; }));
    rig_.with([&] { rig_.uav.refuse = true; });
    const double begun = rig_.seconds();
    writeAll(fd, message(1));
    writeAll(fd, message(2));
    EXPECT_TRUE(rig_.read(fd, 1).empty());
    EXPECT_TRUE(rig_.read(other, 1).empty())
        << "programs that share the session must be disconnected as well";
    const double seconds = rig_.seconds() - begun;
    EXPECT_GE(seconds, 2.0);
    EXPECT_LT(seconds, 2.5);
    EXPECT_TRUE(log_.has("0 the program on channel 1 has a message that was not sent in time"))
        << log_.text();
    close(fd);
    close(other);
    EXPECT_TRUE(rig_.until([&] { return rig_.uav.opened.size() == 4; })) << "the end is heard";
    rig_.with([&] { rig_.uav.refuse = false; });
    const int next = engine->connect(1, 2000);
    echoes(next, 3);
    rig_.with(
        [&] { EXPECT_EQ(rig_.uav.received, decltype(rig_.uav.received)(1, {1, message(3)})); });
    close(next);
}

TEST_F(EngineTest, AMessageThatWaitsTooLongForTheLinkEndsItsConnection) {
    auto engine = start();
    const int other = engine->connect(0), fd = engine->connect(1, 2000);
    ASSERT_TRUE(rig_.until([&] { return rig_.uav.opened.size() == 2; }));
    rig_.with([&] { rig_.uav.refuse = true; });
    writeAll(other, message(1, 8000));
    writeAll(other, message(2, 8000));
    ASSERT_TRUE(rig_.until([&] { return Link_statistics(rig_.uav.link())->framesReceived > 80; }));
    writeAll(fd, message(3, 4000));
    EXPECT_TRUE(rig_.read(fd, 1).empty());
    EXPECT_TRUE(log_.has("has waited for room longer than its time-out: connection closed"))
        << log_.text();
    rig_.with([&] { rig_.uav.refuse = false; });
    EXPECT_TRUE(rig_.until([&] { return rig_.uav.received.size() == 2; })) << "the others' arrive";
    close(fd);
    close(other);
}

TEST_F(EngineTest, AProgramThatClosesBeforeTheLinkIsUpFreesItsChannel) {
    auto engine = start();
    int fd = engine->connect(1);
    int next = engine->connect(1);
    EXPECT_EQ(engine->waiting(), 1u);
    close(fd);
    echoes(next, 1);
    close(next);
}

TEST_F(EngineTest, HeartbeatsAreNotTransmitted) {
    rig_.with([&] { rig_.uav.echo = false; });
    auto engine = start();
    int fd = engine->connect(0);
    ASSERT_TRUE(rig_.until([&] { return rig_.uav.isUp() && !rig_.uav.opened.empty(); }));
    // Ice sends a two-way request, then heartbeats until the reply arrives.
    Bytes request = message(1, 40), heartbeat = message(0, 14);
    request[8] = 0;
    heartbeat[8] = 3;
    writeAll(fd, request);
    ASSERT_TRUE(rig_.until([&] { return rig_.uav.received.size() == 1; }));
    for (int i = 0; i < 10; ++i)
        writeAll(fd, heartbeat);
    EXPECT_EQ(rig_.read(fd, 14),
              heartbeat); // the engine sends a heartbeat after 5 s without bytes from the UAV
    rig_.with([&] {
        EXPECT_EQ(rig_.uav.received.size(), 1u) << "a heartbeat was sent by radio";
        Bytes reply = message(1, 30);
        reply[8] = 2;
        Link_send(rig_.uav.link(), 0, reply.data(), 30, 0);
    });
    EXPECT_EQ(rig_.read(fd, 30)[8], 2);
    close(fd);
}

// The modem may be in any mode and at any rate when the engine finds it. AP 2 is kept, because it
// is the user's choice.
TEST_F(EngineTest, AModemInAnyModeIsSetUp) {
    const auto fly = [&](const XBeeAT::Settings& s, uint32_t mode, uint32_t rate) {
        SCOPED_TRACE("AP " + std::to_string(mode));
        auto engine = start(s);
        const int fd = engine->connect(0);
        for (unsigned tag : {0x7Du, 0x7Eu, 0x11u, 0x13u})
            echoes(fd, static_cast<uint8_t>(tag), 200);
        close(fd);
        rig_.with([&] {
            EXPECT_EQ(rig_.ground->parameter("AP"), mode);
            EXPECT_EQ(rig_.ground->parameter("BD"), rate);
        });
    };
    XBeeAT::Settings s = settings(), plain = settings(), fast = settings(), slow = settings();
    plain.isApi = false;
    fast.baud = 250000;
    slow.baud = 57600;
    fly(s, 1, 7);
    fly(s, 1, 7); // the engine finds this modem in API mode
    fly(slow, 1, 6);
    fly(fast, 1, 250000);
    fly(plain, 0, 7);
    fly(plain, 0, 7);
    rig_.replaceGround({{"AP", 2}, {"BD", 4}});
    fly(s, 2, 7);
    rig_.replaceGround({});
    rig_.with([&] { rig_.ground->refuseCommand("AP"); });
    fly(s, 0, 7);
    rig_.replaceGround({{"AP", 1}, {"BD", 7}});
    rig_.with([&] { rig_.ground->refuseCommand("AP0"); });
    fly(plain, 1, 7);
    EXPECT_TRUE(log_.has("refuses ATAP0 and stays in API mode")) << log_.text();
}

TEST_F(EngineTest, TheModemsKeyIsSetAndNeverLogged) {
    XBeeAT::Settings s = settings();
    s.modemKey = "0123456789ABCDEF";
    auto engine = start(s);
    ASSERT_TRUE(rig_.until([&] { return rig_.ground->parameter("EE") == 1; }));
    ASSERT_TRUE(rig_.until([&] { return !rig_.ground->inCommandMode(); }));
    EXPECT_TRUE(log_.has("ATKY: OK"));
    EXPECT_FALSE(log_.has("0123456789ABCDEF"));
}

TEST_F(EngineTest, ACallOfTheUavIsRefusedIfNoFileDescriptorIsFree) {
    auto engine = start();
    const int ready = engine->listen();
    ASSERT_TRUE(rig_.until([&] { return rig_.uav.isUp(); }));
    rig_.with([&] { Link_openChannel(rig_.uav.link(), 3); });
    ASSERT_TRUE(rig_.isReadable(ready));
    rlimit limit;
    ASSERT_EQ(getrlimit(RLIMIT_NOFILE, &limit), 0);
    const rlimit none = {0, limit.rlim_max};
    ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &none), 0);
    EXPECT_EQ(engine->accept(), -1);
    ASSERT_EQ(setrlimit(RLIMIT_NOFILE, &limit), 0);
    EXPECT_TRUE(
        log_.has("0 cannot accept a call of the UAV: no socket can be made: Too many open files"));
    EXPECT_TRUE(rig_.until([&] {
        return std::count(rig_.uav.opened.begin(), rig_.uav.opened.end(), std::make_pair(3, 0)) ==
               1;
    }));
}

TEST_F(EngineTest, AFailedModemIsRetriedAndTheListenerIsCalled) {
    rig_.with([&] { rig_.ground->power(false, rig_.ns()); });
    auto engine = start();
    int ready = engine->listen();
    EXPECT_EQ(engine->listen(), -1) << "a second listener must be refused";
    int fd = engine->connect(0);
    // no reply arrives; the program that waits gets an error
    EXPECT_TRUE(rig_.read(fd, 1).empty());
    close(fd);
    EXPECT_TRUE(log_.has("0 no modem answers"));
    rig_.with([&] { rig_.ground->power(true, rig_.ns()); });
    fd = engine->connect(0);
    ASSERT_GE(fd, 0);
    echoes(fd, 1);
    isCalled(*engine, ready);
    close(fd);
}

// If a program is killed during the set-up, the modem stays in command mode, in the middle of a
// line. By itself, it leaves command mode only after CT, which is 10 s.
TEST_F(EngineTest, AModemInCommandModeIsFoundAtOnce) {
    const int port = open(rig_.pty.path().c_str(), O_RDWR | O_NOCTTY);
    ASSERT_GE(port, 0);
    termios mode;
    ASSERT_EQ(tcgetattr(port, &mode), 0);
    cfmakeraw(&mode);
    cfsetspeed(&mode, B9600);
    ASSERT_EQ(tcsetattr(port, TCSANOW, &mode), 0);
    rig_.pass(2 * Rig::guardMs / 1000.0);
    ASSERT_EQ(write(port, "+++", 3), 3);
    ASSERT_TRUE(rig_.until([&] { return rig_.ground->inCommandMode(); }));
    ASSERT_EQ(write(port, "ATMY1", 5), 5);
    close(port);
    const double begin = rig_.seconds();
    auto engine = start();
    const int fd = engine->connect(0);
    echoes(fd, 1);
    close(fd);
    EXPECT_LT(rig_.seconds() - begin, 3);
}

// A failure is reported once, together with its cause.
TEST_F(EngineTest, ARefusedCommandIsReported) {
    XBeeAT::Settings s = settings();
    s.pan = 0x1FFFF;
    auto engine = start(s);
    const int fd = engine->connect(0);
    EXPECT_TRUE(rig_.read(fd, 1).empty());
    close(fd);
    EXPECT_TRUE(log_.has("refuses ATID; the next connection will try again"));
    EXPECT_FALSE(log_.has("no modem answers"));
}

// If the vehicle starts before the ground's program, the vehicle's frames arrive between the
// replies of the modem. These frames may contain carriage returns.
TEST_F(EngineTest, TheModemIsSetUpWhileTheUavSends) {
    uint64_t commands = 0;
    rig_.with([&] {
        rig_.step = [&] {
            if (!rig_.ground->inCommandMode() || rig_.ground->counters().commands == commands)
                return;
            commands = rig_.ground->counters().commands;
            RfPacket packet;
            packet.header = true;
            packet.bytes = {'U', '\r', 'O', 'K', 'U'};
            rig_.ground->receive(packet, rig_.ns());
        };
    });
    auto engine = start();
    const int fd = engine->connect(0);
    echoes(fd, 1);
    close(fd);
    EXPECT_FALSE(log_.has("refuses")) << log_.text();
    EXPECT_FALSE(log_.has("does not answer")) << log_.text();
    rig_.with([&] { rig_.step = nullptr; });
    EXPECT_GE(commands, 9u);
}

TEST_F(EngineTest, TheModemIsRetriedIfOnlyAListenerExists) {
    rig_.with([&] { rig_.ground->power(false, rig_.ns()); });
    auto engine = start();
    ASSERT_GE(engine->listen(), 0);
    ASSERT_TRUE(rig_.until([&] { return log_.has("the next connection will try again"); }));
    rig_.with([&] { rig_.ground->power(true, rig_.ns()); });
    EXPECT_TRUE(rig_.until([&] { return rig_.uav.isUp(); }));
}

// BYTES=10000000 sets the number of random bytes from the line. For every 64 KiB there is also
// noise from a program. Nothing may hang or crash, and the link must work afterwards.
TEST(Engine, RandomBytesDoNoHarm) {
    const auto total = static_cast<size_t>(numberFromEnvironment("BYTES", 10'000'000));
    Wire wire;
    Random random(testSeed());
    auto engine = wire.engine();
    Bytes noise(65536);
    for (size_t done = 0; done < total; done += noise.size()) {
        for (auto& byte : noise)
            byte = static_cast<uint8_t>(random.next());
        wire.flood(noise);
        int fd = engine->connect(0);
        if (fd >= 0) { // an invalid message ends the program's connection
            (void)!send(fd, noise.data(), noise.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
            close(fd);
        }
    }
    int fd = -1;
    ASSERT_TRUE(wire.until([&] { return fd >= 0 || (fd = engine->connect(1)) >= 0; }));
    Bytes m = message(5, 500), answer;
    writeAll(fd, m);
    ASSERT_TRUE(wire.until([&] {
        U8 bytes[512];
        ssize_t count = recv(fd, bytes, sizeof bytes, MSG_DONTWAIT);
        answer.insert(answer.end(), bytes, bytes + std::max<ssize_t>(count, 0));
        return answer.size() >= m.size();
    })) << "the link did not recover, seed "
        << testSeed();
    EXPECT_EQ(answer, m);
    std::printf("engine: %zu bytes of noise from the line, the link works\n", total);
    close(fd);
}

// Waits for a condition on the machine clock. Returns whether it was met within 30 s.
template <class F> bool becomes(F condition) {
    for (int looks = 0; looks < 3000 && !condition(); ++looks)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    return condition();
}

// Returns the number of descriptors of this process that are open on a device, even if the device
// has disappeared.
size_t usersOf(const std::string& device) {
    const std::filesystem::directory_iterator descriptors("/proc/self/fd"), end;
    return static_cast<size_t>(std::count_if(descriptors, end, [&](const auto& entry) {
        std::error_code closed;
        return read_symlink(entry.path(), closed).string().compare(0, device.size(), device) == 0;
    }));
}

// A USB adapter that is unplugged and plugged in again. A symbolic link leads to the adapter's
// device, as with udev. If the old device stayed open, the kernel would give the adapter another
// name.
TEST(Engine, AnUnpluggedAdapterIsReopenedWhenItReturns) {
    EngineLog log;
    auto adapter = std::make_unique<Wire>();
    const std::string device = adapter->path();
    const std::string link = "engine-" + std::to_string(getpid());
    std::filesystem::create_symlink(device, link);
    XBeeAT::Settings settings = Wire::settings();
    settings.device = link;
    auto engine = XBeeAT::Engine::get(settings, log.taker());
    ASSERT_GE(engine->listen(), 0);
    int fd = engine->connect(0);
    ASSERT_TRUE(adapter->until([&] { return adapter->open[0]; }));

    std::filesystem::remove(link);
    adapter.reset();
    EXPECT_TRUE(becomes([&] { return log.has("0 serial port '" + link + "' has disappeared"); }))
        << log.text();
    EXPECT_TRUE(becomes([&] { return usersOf(device) == 0; }));
    pollfd ended{fd, POLLIN, 0};
    EXPECT_EQ(poll(&ended, 1, 30'000), 1);
    EXPECT_EQ(recv(fd, &ended, sizeof ended, 0), 0) << "a program learns that the port is lost";
    close(fd);
    EXPECT_TRUE(becomes([&] { return log.has("0 cannot open serial port '" + link); }))
        << log.text();

    adapter = std::make_unique<Wire>();
    std::filesystem::create_symlink(adapter->path(), link);
    EXPECT_TRUE(becomes([&] { return log.has("-1 serial port '" + link + "' is in use again"); }))
        << log.text();
    fd = engine->connect(0);
    EXPECT_TRUE(adapter->until([&] { return adapter->open[0]; })) << log.text();
    close(fd);
    engine.reset();
    std::filesystem::remove(link);
    EXPECT_EQ(log.count(0), 2u) << "the loss, and that the device is missing, are errors once:\n"
                                << log.text();
}

std::string refusal(const std::string& device) {
    XBeeAT::Settings s;
    s.device = device;
    try {
        XBeeAT::Engine::get(s, [](int, const std::string&) {});
    } catch (const std::system_error& e) {
        return e.what();
    }
    return "none";
}

TEST(Engine, AMissingDeviceOrANonTerminalIsRefusedUnchanged) {
    UnnamedFile file;
    EXPECT_NE(refusal("/dev/no-such-port"), "none");
    EXPECT_NE(refusal(file.path()).find("not a serial port"), std::string::npos)
        << refusal(file.path());
    EXPECT_EQ(lseek(file.fd(), 0, SEEK_END), 0);
}

TEST(Engine, APortInUseIsRefusedWithTheProcessId) {
    Wire wire;
    int ready[2];
    ASSERT_EQ(pipe(ready), 0);
    const pid_t first = fork();
    if (first == 0) {
        XBeeAT::SystemClock clock;
        XBeeAT::SerialPort port(clock);
        port.open(wire.path());
        (void)!write(ready[1], "", 1);
        pause();
    }
    char byte;
    ASSERT_EQ(read(ready[0], &byte, 1), 1);
    EXPECT_NE(refusal(wire.path()).find("process " + std::to_string(first)), std::string::npos)
        << refusal(wire.path());
    kill(first, SIGKILL);
    waitpid(first, nullptr, 0);
    EXPECT_EQ(refusal(wire.path()), "none")
        << "an engine that was killed must leave nothing that blocks the next one";
    close(ready[0]);
    close(ready[1]);
}

} // namespace
