// SPDX-License-Identifier: MIT
//
// engine_test: the ground's engine on a pty with a modem behind it.

#include "engine.h"
#include "rig.h"
#include <cstdlib>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <poll.h>
#include <pty.h>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>

namespace {

using Bytes = Rig::Bytes;

// A message as Ice frames it; nothing of it but the size is looked at.
Bytes message(uint8_t tag, size_t size = 30) {
    Bytes m = {'I', 'c', 'e', 'P', 1, 0, 1, 0, 7, 0, 0, 0, 0, 0};
    m.resize(size, tag);
    for (int i = 0; i < 4; ++i)
        m[10 + i] = static_cast<uint8_t>(size >> 8 * i);
    return m;
}

// Reads `size` bytes; fewer if the stream ends.
Bytes readAll(int fd, size_t size) {
    Bytes bytes(size);
    size_t got = 0;
    while (got < size) {
        pollfd p{fd, POLLIN, 0};
        if (poll(&p, 1, 60000) <= 0)
            break;
        ssize_t count = recv(fd, bytes.data() + got, size - got, 0);
        if (count == 0 || (count < 0 && errno != EAGAIN))
            break;
        got += count > 0 ? static_cast<size_t>(count) : 0;
    }
    bytes.resize(got);
    return bytes;
}

void writeAll(int fd, const Bytes& bytes) {
    for (size_t done = 0; done < bytes.size();) {
        pollfd p{fd, POLLOUT, 0};
        if (poll(&p, 1, 60000) <= 0)
            break;
        ssize_t count = send(fd, bytes.data() + done, bytes.size() - done, MSG_NOSIGNAL);
        if (count < 0 && errno != EAGAIN)
            break;
        done += count > 0 ? static_cast<size_t>(count) : 0;
    }
}

class EngineTest : public ::testing::Test {
protected:
    XBeeAT::Settings settings() {
        XBeeAT::Settings s;
        s.device = rig_.pty.path();
        s.guardMs = Rig::guardMs;
        s.downMs = 300;
        return s;
    }
    std::shared_ptr<XBeeAT::Engine> start() {
        return XBeeAT::Engine::get(settings(), [this](int level, const std::string& text) {
            std::lock_guard<std::mutex> lock(logMutex_);
            log_ += std::to_string(level) + " " + text + "\n";
        });
    }
    std::string log() {
        std::lock_guard<std::mutex> lock(logMutex_);
        return log_;
    }
    bool logged(const std::string& text) {
        std::lock_guard<std::mutex> lock(logMutex_);
        return log_.find(text) != std::string::npos;
    }
    // A call and its answer, byte by byte.
    void echoes(int fd, uint8_t tag, size_t size = 30) {
        writeAll(fd, message(tag, size));
        Bytes got = readAll(fd, size);
        EXPECT_TRUE(got == message(tag, size))
            << got.size() << " of " << size << " bytes; the engine's log:\n"
            << log();
    }

    std::mutex logMutex_;
    std::string log_;
    Rig rig_{testSeed()};
};

TEST_F(EngineTest, MessagesGoBothWaysOnSeveralConnections) {
    rig_.with([&] { rig_.echo = true; });
    auto engine = start();
    int fds[3];
    for (int& fd : fds) {
        fd = engine->connect(-1);
        ASSERT_GE(fd, 0);
    }
    EXPECT_EQ(engine->connect(-1), -1) << "a fourth connection";
    for (uint8_t tag = 1; tag < 4; ++tag)
        for (int fd : fds)
            echoes(fd, tag, 20u * tag);
    echoes(fds[1], 9, 8192);
    for (int fd : fds)
        close(fd);
}

TEST_F(EngineTest, AModemThatIsResetInFlightIsSetUpAgain) {
    rig_.with([&] { rig_.echo = true; });
    auto engine = start();
    int fd = engine->connect(0);
    echoes(fd, 1);
    rig_.with([&] {
        rig_.ground->resetPin(true, rig_.ns());
        rig_.ground->resetPin(false, rig_.ns() + 1000);
        EXPECT_EQ(rig_.ground->parameter("BD"), 3u);
    });
    EXPECT_TRUE(readAll(fd, 1).empty()); // the connection is reported lost ...
    close(fd);
    fd = engine->connect(0); // ... and the next one waits until the link is back
    echoes(fd, 2);
    close(fd);
    EXPECT_EQ(rig_.with([&] { return rig_.ground->parameter("BD"); }), 7u);
    EXPECT_TRUE(logged("setting the modem up again"));
}

TEST_F(EngineTest, AMessageThatIsTooLongEndsItsConnectionOnly) {
    rig_.with([&] { rig_.echo = true; });
    auto engine = start();
    int good = engine->connect(0), bad = engine->connect(1);
    echoes(good, 1);
    writeAll(bad, message(2, 9000));
    EXPECT_TRUE(readAll(bad, 1).empty());
    EXPECT_TRUE(logged("does not fit the radio link"));
    echoes(good, 3);
    close(good);
    close(bad);
}

TEST_F(EngineTest, WhoGivesUpBeforeTheLinkIsUpFreesItsChannel) {
    rig_.with([&] { rig_.echo = true; });
    auto engine = start();
    int fd = engine->connect(1);
    ASSERT_GE(fd, 0);
    EXPECT_EQ(engine->connect(1), -1);
    close(fd);
    fd = engine->connect(1);
    ASSERT_GE(fd, 0);
    echoes(fd, 1);
    close(fd);
}

TEST_F(EngineTest, HeartbeatsTakeNoAir) {
    auto engine = start();
    int fd = engine->connect(0);
    ASSERT_TRUE(rig_.until([&] { return rig_.isUp() && !rig_.opened.empty(); }));
    // As Ice does: a two-way request, then heartbeats while the answer takes its time.
    Bytes request = message(1, 40), heartbeat = message(0, 14);
    request[8] = 0;
    heartbeat[8] = 3;
    writeAll(fd, request);
    ASSERT_TRUE(rig_.until([&] { return rig_.received.size() == 1; }));
    for (int i = 0; i < 10; ++i)
        writeAll(fd, heartbeat);
    EXPECT_EQ(readAll(fd, 14), heartbeat); // after 5 s, from the engine, for the UAV says nothing
    rig_.with([&] {
        EXPECT_EQ(rig_.received.size(), 1u) << "a heartbeat crossed the air";
        Bytes reply = message(1, 30);
        reply[8] = 2;
        Link_send(rig_.link(), 0, reply.data(), 30, 0, rig_.us());
    });
    EXPECT_EQ(readAll(fd, 30)[8], 2);
    close(fd);
}

TEST_F(EngineTest, TheKeyIsSetAndNeverLogged) {
    XBeeAT::Settings s = settings();
    s.key = "0123456789ABCDEF";
    auto engine = XBeeAT::Engine::get(s, [this](int, const std::string& text) {
        std::lock_guard<std::mutex> lock(logMutex_);
        log_ += text + "\n";
    });
    ASSERT_TRUE(rig_.until([&] { return rig_.ground->parameter("EE") == 1; }));
    ASSERT_TRUE(rig_.until([&] { return !rig_.ground->inCommandMode(); }));
    EXPECT_TRUE(logged("ATKY: OK"));
    EXPECT_FALSE(logged("0123456789ABCDEF"));
}

TEST_F(EngineTest, TheUavMayCallWhenSomebodyListens) {
    auto engine = start();
    int ready = engine->listen();
    ASSERT_GE(ready, 0);
    EXPECT_EQ(engine->listen(), -1) << "a second listener";
    ASSERT_TRUE(rig_.until([&] { return rig_.isUp(); }));
    rig_.with([&] {
        Link_openChannel(rig_.link(), 3, rig_.us());
        Bytes m = message(5);
        Link_send(rig_.link(), 3, m.data(), static_cast<U32>(m.size()), 0, rig_.us());
    });
    pollfd p{ready, POLLIN, 0};
    ASSERT_EQ(poll(&p, 1, 60000), 1);
    int fd = engine->accept();
    ASSERT_GE(fd, 0);
    EXPECT_EQ(readAll(fd, 30), message(5));
    close(fd);
}

// A modem that was given up once is no end: the same listener is called when it is back.
TEST_F(EngineTest, AModemThatWasGivenUpIsTriedAgainAndTheListenerIsCalled) {
    rig_.with([&] {
        rig_.echo = true;
        rig_.ground->power(false, rig_.ns());
    });
    auto engine = start();
    int ready = engine->listen();
    int fd = engine->connect(0);
    EXPECT_TRUE(readAll(fd, 1).empty()); // nobody answers: who waits is told
    close(fd);
    EXPECT_TRUE(logged("0 no modem answers"));
    rig_.with([&] { rig_.ground->power(true, rig_.ns()); });
    fd = engine->connect(0);
    ASSERT_GE(fd, 0);
    echoes(fd, 1);
    rig_.with([&] {
        Link_openChannel(rig_.link(), 3, rig_.us());
        Bytes m = message(5);
        Link_send(rig_.link(), 3, m.data(), static_cast<U32>(m.size()), 0, rig_.us());
    });
    pollfd p{ready, POLLIN, 0};
    ASSERT_EQ(poll(&p, 1, 60000), 1);
    int called = engine->accept();
    ASSERT_GE(called, 0);
    EXPECT_EQ(readAll(called, 30), message(5));
    close(called);
    close(fd);
}

// Nobody connects: a listener alone has the modem tried again.
TEST_F(EngineTest, AListenerAloneHasTheModemTriedAgain) {
    rig_.with([&] { rig_.ground->power(false, rig_.ns()); });
    auto engine = start();
    ASSERT_GE(engine->listen(), 0);
    while (!logged("given up"))
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    rig_.with([&] { rig_.ground->power(true, rig_.ns()); });
    EXPECT_TRUE(rig_.until([&] { return rig_.isUp(); }));
}

// A serial port with this test behind it, and no modem: bytes as fast as they are taken.
class Wire {
public:
    Wire() {
        static const Link_Port port = {
            [](void* c, const U8* f, U32 n) { return self(c).put(f, n); },
            [](void* c) { return self(c).random_.next(); },
            [](void* c, int channel, const U8* d, U32 n) {
                return Link_send(self(c).link_.get(), channel, d, n, 0, us()) == LINK_FULL ? 1 : 0;
            },
            [](void*, int, int) {},
            [](void*, Link_State) {},
            nullptr,
            nullptr};
        Link_init(link_.get(), &port, this, 16); // a fast way: nothing to pace
        Link_start(link_.get(), us());
        if (openpty(&master_, &slave_, name_, nullptr, nullptr) != 0)
            throw std::runtime_error("no pty");
        termios raw;
        tcgetattr(slave_, &raw);
        cfmakeraw(&raw);
        tcsetattr(slave_, TCSANOW, &raw);
        fcntl(master_, F_SETFL, O_NONBLOCK);
    }
    ~Wire() {
        close(slave_);
        close(master_);
    }
    std::string path() const { return name_; }
    // Puts bytes on the wire, throws away what comes.
    void flood(const Bytes& bytes) {
        for (size_t done = 0; done < bytes.size();) {
            pollfd p{master_, POLLIN | POLLOUT, 0};
            poll(&p, 1, 60000);
            U8 sink[512];
            (void)!read(master_, sink, sizeof sink);
            ssize_t count = write(master_, bytes.data() + done, bytes.size() - done);
            done += count > 0 ? static_cast<size_t>(count) : 0;
        }
    }
    // The peer's link runs until `done`.
    template <class F> bool until(F done) {
        for (auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60); !done();) {
            if (std::chrono::steady_clock::now() > end)
                return false;
            pollfd p{master_, POLLIN, 0};
            poll(&p, 1, 2);
            U8 bytes[512];
            ssize_t count = read(master_, bytes, sizeof bytes);
            if (count > 0)
                Link_receive(link_.get(), bytes, static_cast<U32>(count), 0, us());
            Link_poll(link_.get(), us());
        }
        return true;
    }

private:
    static Wire& self(void* c) { return *static_cast<Wire*>(c); }
    static U32 us() {
        return static_cast<U32>(std::chrono::duration_cast<std::chrono::microseconds>(
                                    std::chrono::steady_clock::now().time_since_epoch())
                                    .count());
    }
    int put(const U8* f, U32 n) { return write(master_, f, n) == static_cast<ssize_t>(n) ? 0 : 1; }
    int master_ = -1, slave_ = -1;
    char name_[128];
    Random random_{testSeed()};
    std::unique_ptr<Link> link_{new Link};
};

// BYTES=10000000 from the line, and noise from a program for each 64 KiB of them: nothing hangs or falls
// over, and afterwards the link works.
TEST(Engine, RandomBytesFromTheLineAndFromProgramsAreSurvived) {
    const char* more = std::getenv("BYTES");
    const size_t total = more ? std::strtoul(more, nullptr, 0) : 10'000'000;
    Wire wire;
    Random random(testSeed());
    XBeeAT::Settings s;
    s.device = wire.path();
    s.setUp = false;
    auto engine = XBeeAT::Engine::get(s, [](int, const std::string&) {});
    Bytes noise(65536);
    for (size_t done = 0; done < total; done += noise.size()) {
        for (auto& byte : noise)
            byte = static_cast<uint8_t>(random.next());
        wire.flood(noise);
        int fd = engine->connect(0);
        if (fd >= 0) { // nonsense instead of a message ends the connection
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
    std::printf(
        "engine of the plugin: %zu bytes of noise from the line, more from programs that talk no Ice: the "
        "link works\n",
        total);
    close(fd);
}

TEST(Engine, ADeviceThatCannotBeOpenedIsAnError) {
    XBeeAT::Settings s;
    s.device = "/dev/no-such-port";
    EXPECT_THROW(XBeeAT::Engine::get(s, [](int, const std::string&) {}), std::system_error);
}

} // namespace
