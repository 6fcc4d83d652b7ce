// SPDX-License-Identifier: MIT
//
// engine_test: the ground's engine on a pty with a modem behind it.

#include "engine.h"
#include "rig.h"
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
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
    bool logged(const std::string& text) {
        std::lock_guard<std::mutex> lock(logMutex_);
        return log_.find(text) != std::string::npos;
    }
    // A call and its answer, byte by byte.
    void echoes(int fd, uint8_t tag, size_t size = 30) {
        writeAll(fd, message(tag, size));
        EXPECT_EQ(readAll(fd, size), message(tag, size));
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

TEST(Engine, ADeviceThatCannotBeOpenedIsAnError) {
    XBeeAT::Settings s;
    s.device = "/dev/no-such-port";
    EXPECT_THROW(XBeeAT::Engine::get(s, [](int, const std::string&) {}), std::system_error);
}

} // namespace
