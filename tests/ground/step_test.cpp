// SPDX-License-Identifier: MIT
//
// step_test: a program that keeps step with simulated time, on a machine that lets it run seldom:
// no simulated time passes while it works, and no byte is late.

#include "clock.h"
#include "ground_step.h"
#include "random.h"
#include "serial_port.h"
#include "status.h"
#include <atomic>
#include <cstring>
#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

using namespace XBeeAT;

namespace {

// A simulation of nothing but the pty, whose modem answers each byte by the next higher one.
class Step : public testing::Test, public SerialClient {
protected:
    Step() {
        int fd = open(file_.c_str(), O_RDWR | O_CREAT | O_TRUNC, 0600);
        (void)!ftruncate(fd, sizeof(SimStatus));
        status_ = static_cast<SimStatus*>(
            mmap(nullptr, sizeof(SimStatus), PROT_READ | PROT_WRITE, MAP_SHARED, fd, 0));
        close(fd);
        std::memcpy(status_->magic, "ICESOC1", 8);
        pty_.attach(this);
        pty_.setBitTime(1e9 / 111'111);
    }
    ~Step() override {
        munmap(status_, sizeof(SimStatus));
        unlink(file_.c_str());
    }
    void fromHost(uint8_t byte, uint64_t now) override {
        answer_.push_back(static_cast<uint8_t>(byte + 1));
        pty_.wake(now);
    }
    void framingError(uint64_t) override { ADD_FAILURE() << "a framing error"; }
    bool nextToHost(uint8_t& byte) override {
        if (answer_.empty())
            return false;
        byte = answer_.front();
        answer_.erase(answer_.begin());
        return true;
    }
    // Simulated time as fast as it goes, until `done`.
    void simulate(const std::function<bool()>& done) {
        GroundStep step(*status_, pty_, [&] { return !done(); });
        while (!done()) {
            __atomic_store_n(&status_->ns, status_->ns + 10'000, __ATOMIC_RELEASE);
            pty_.advance(status_->ns);
            step.wait(status_->ns);
        }
    }
    SimStatus* status_;
    PtyLine pty_;
    std::vector<uint8_t> answer_;
    std::string file_ = testing::TempDir() + "step." + std::to_string(getpid());
};

TEST_F(Step, NoTimePassesWhileTheProgramWorksAndNoByteIsLate) {
    std::atomic<bool> over{false};
    std::strncpy(status_->device, pty_.path().c_str(), sizeof status_->device - 1);
    std::thread program([&] {
        struct AtEnd {
            ~AtEnd() { over = true; }
            std::atomic<bool>& over;
        } atEnd{over};
        Random random(testSeed());
        Clock clock(file_);
        SerialPort port(clock);
        ASSERT_TRUE(port.open(pty_.path()));
        port.setSpeed(115200);
        clock.keepStep(port.fd(), pty_.path());
        pollfd none = {-1, 0, 0};
        ASSERT_EQ(clock.wait(&none, 1, 1000), 0); // the pty knows by then
        for (uint8_t i = 0; i < 60; ++i) {
            const uint32_t begin = clock.nowUs();
            if (i % 4 == 0) // the machine does other things
                std::this_thread::sleep_for(std::chrono::milliseconds(random.below(20)));
            ASSERT_EQ(clock.nowUs(), begin) << "time passed while the program worked";
            ASSERT_EQ(port.write(&i, 1), 1);
            pollfd fds[] = {{port.fd(), POLLIN, 0}};
            // 90 us a byte and way, and the pty is looked at every 100 us.
            ASSERT_EQ(clock.wait(fds, 1, 1'000'000), 1);
            ASSERT_LE(clock.nowUs() - begin, 500u);
            uint8_t byte = 0;
            ASSERT_EQ(port.read(&byte, 1), 1);
            ASSERT_EQ(byte, i + 1);
            const uint32_t from = clock.nowUs();
            ASSERT_EQ(clock.wait(&none, 1, 1000), 0);
            ASSERT_LE(clock.nowUs() - from, 1010u) << "it overslept";
        }
    });
    simulate([&] { return over.load(); });
    program.join();
}

// One follows the other between two looks at the pty: an engine that gave up and tries again.
TEST_F(Step, WhoKeepsStepNextIsHeardFromTheFirstByte) {
    std::atomic<bool> over{false};
    std::strncpy(status_->device, pty_.path().c_str(), sizeof status_->device - 1);
    std::thread program([&] {
        struct AtEnd {
            ~AtEnd() { over = true; }
            std::atomic<bool>& over;
        } atEnd{over};
        Clock clock(file_);
        SerialPort port(clock);
        ASSERT_TRUE(port.open(pty_.path()));
        port.setSpeed(115200);
        clock.keepStep(port.fd(), pty_.path());
        pollfd none = {-1, 0, 0};
        ASSERT_EQ(clock.wait(&none, 1, 1000), 0);
        for (uint8_t i = 0; i < 240; ++i) {
            if (i % 4 == 3)
                clock.keepStep(port.fd(), pty_.path());
            ASSERT_EQ(port.write(&i, 1), 1);
            pollfd fds[] = {{port.fd(), POLLIN, 0}};
            ASSERT_EQ(clock.wait(fds, 1, 1'000'000), 1) << "byte " << int(i);
            uint8_t byte = 0;
            ASSERT_EQ(port.read(&byte, 1), 1);
            ASSERT_EQ(byte, i + 1);
        }
    });
    simulate([&] { return over.load(); });
    program.join();
}

TEST_F(Step, AProgramThatWasKilledHoldsNothing) {
    std::strncpy(status_->device, pty_.path().c_str(), sizeof status_->device - 1);
    pid_t child = fork();
    if (child == 0) {
        Clock clock(file_);
        clock.keepStep(-1, pty_.path());
        _exit(0); // without good-bye
    }
    int status;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_NE(status_->keeper, 0u);
    const uint64_t end = status_->ns + 5'000'000;
    simulate([&] { return status_->ns >= end; });
    EXPECT_EQ(status_->keeper, 0u);
}

TEST_F(Step, AnotherPortsProgramIsNotWaitedFor) {
    std::strncpy(status_->device, pty_.path().c_str(), sizeof status_->device - 1);
    Clock clock(file_);
    clock.keepStep(-1, "/dev/null");
    EXPECT_EQ(status_->keeper, 0u);
    const uint64_t end = status_->ns + 5'000'000;
    simulate([&] { return status_->ns >= end; });
}

} // namespace
