// SPDX-License-Identifier: MIT
//
// clock_test: tests the clock of the engine, which reads the time from a simulator's counters or
// from the machine. Also tests a program that keeps step with simulated time on a machine that
// rarely runs this program: no simulated time may pass while the program works, and no byte may be
// late.

#include "clock.h"
#include "clock_file.h"
#include "ground_step.h"
#include "random.h"
#include "serial_port.h"
#include "simulated_clock.h"
#include <atomic>
#include <csignal>
#include <cstring>
#include <fstream>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <system_error>
#include <thread>
#include <unistd.h>

using namespace XBeeAT;

namespace {

class ClockOfASimulator : public testing::Test {
protected:
    ClockOfASimulator() {
        (void)!pipe(pipe_);
        show(0);
    }
    ~ClockOfASimulator() override {
        close(pipe_[0]);
        close(pipe_[1]);
    }
    void show(uint64_t us) { status_.set(us * 1000); }

    ClockFile status_;
    const std::string file_ = status_.path();
    int pipe_[2];
};

TEST_F(ClockOfASimulator, ShowsTheTimeOfTheSimulator) {
    SimulatedClock clock(file_);
    EXPECT_EQ(clock.nowUs(), 0u);
    show(1'234'567);
    EXPECT_EQ(clock.nowUs(), 1'234'567u);
    show((1ull << 32) + 5);
    EXPECT_EQ(clock.nowUs(), 5u); // wraps around
}

TEST_F(ClockOfASimulator, WaitLastsUntilSimulatedTimeHasPassed) {
    SimulatedClock clock(file_);
    pollfd fds[] = {{pipe_[0], POLLIN, 0}};
    std::atomic<bool> isOver{false};
    std::thread simulator([&] {
        // simulated time passes ten times more slowly than real time
        for (uint64_t us = 100; !isOver; us += 100) {
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            show(us);
        }
    });
    const uint32_t begin = clock.nowUs();
    EXPECT_EQ(clock.wait(fds, 1, 2000), 0);
    EXPECT_GE(clock.nowUs() - begin, 2000u);
    isOver = true;
    simulator.join();
}

TEST_F(ClockOfASimulator, WaitEndsForAReadyDescriptorAlthoughTimeStandsStill) {
    SimulatedClock clock(file_);
    pollfd fds[] = {{pipe_[0], POLLIN, 0}};
    (void)!write(pipe_[1], "x", 1);
    EXPECT_EQ(clock.wait(fds, 1, 1'000'000), 1);
    EXPECT_EQ(clock.nowUs(), 0u);
}

TEST_F(ClockOfASimulator, AnotherKindOfFileIsRefused) {
    std::ofstream(file_) << "not a simulator's file of counters, although long enough.";
    EXPECT_THROW(SimulatedClock{file_}, std::system_error);
    std::ofstream(file_) << "short";
    EXPECT_THROW(SimulatedClock{file_}, std::system_error);
    EXPECT_THROW(SimulatedClock{"/no/such/file"}, std::system_error);
}

TEST_F(ClockOfASimulator, TheEnvironmentSelectsTheFile) {
    show(77);
    EXPECT_EQ(makeClock()->nowUs(), 77u);
}

TEST_F(ClockOfASimulator, AMissingFileIsReported) {
    const auto complaint = [](const char* name) -> std::string {
        setenv("XBEEAT_CLOCK", name, 1);
        try {
            makeClock();
        } catch (const std::system_error& e) {
            return e.what();
        }
        return "none";
    };
    EXPECT_EQ(complaint("/tmp/status"), "XBEEAT_CLOCK: expected LIBRARY:ARGUMENT, got "
                                        "'/tmp/status': Invalid argument");
    EXPECT_NE(complaint("/no/such.so:x").find("/no/such.so"), std::string::npos);
    EXPECT_NE(complaint("libc.so.6:x").find("createXBeeATClock"), std::string::npos);
    EXPECT_NE(complaint((SIM_CLOCK ":/no/such/file")).find("/no/such/file"), std::string::npos);
}

TEST_F(ClockOfASimulator, WithoutAFileItIsTheClockOfTheMachine) {
    unsetenv("XBEEAT_CLOCK");
    SystemClock machine;
    EXPECT_TRUE(dynamic_cast<SystemClock*>(makeClock().get()));
    uint32_t begin = machine.nowUs();
    pollfd fds[] = {{pipe_[0], POLLIN, 0}};
    EXPECT_EQ(machine.wait(fds, 1, 1000), 0);
    EXPECT_GE(machine.nowUs() - begin, 1000u);
}

// A simulation with only a pty, and a modem that answers each byte with the next higher byte.
class Step : public testing::Test, public SerialClient {
protected:
    Step() {
        std::strncpy(status_->device, pty_.path().c_str(), sizeof status_->device - 1);
        pty_.attach(this);
        pty_.setBitTime(1e9 / 111'111);
    }
    void fromHost(uint8_t byte, uint64_t now) override {
        answer_.push_back(static_cast<uint8_t>(byte + 1));
        pty_.wake(now);
    }
    void framingError(uint64_t) override { ADD_FAILURE() << "a framing error occurred"; }
    bool nextToHost(uint8_t& byte) override {
        if (answer_.empty())
            return false;
        byte = answer_.front();
        answer_.erase(answer_.begin());
        return true;
    }
    // Simulates as fast as possible until `done` returns true.
    void simulate(const std::function<bool()>& done, double patience = 60) {
        GroundStep step(*status_, pty_, [&] { return !done(); }, patience);
        while (!done()) {
            status_.set(status_->ns + 10'000);
            pty_.advance(status_->ns);
            step.wait(status_->ns);
        }
    }
    // Runs `program`, which keeps step with simulated time, in a parallel thread until it returns.
    void alongside(const std::function<void(Clock&, SerialPort&)>& program) {
        std::atomic<bool> over{false};
        std::thread thread([&] {
            struct AtEnd {
                ~AtEnd() { over = true; }
                std::atomic<bool>& over;
            } atEnd{over};
            SimulatedClock clock(status_.path());
            SerialPort port(clock);
            port.open(pty_.path());
            port.setSpeed(115200);
            clock.keepStep(port.fd(), pty_.path());
            // after this time the simulation has polled the pty
            ASSERT_EQ(clock.wait(&none_, 1, 1000), 0);
            program(clock, port);
        });
        simulate([&] { return over.load(); });
        thread.join();
    }
    ClockFile status_;
    PtyLine pty_;
    std::vector<uint8_t> answer_;
    pollfd none_ = {-1, 0, 0};
};

// If the program's count includes bytes that never arrive, the line waits for them once. It then
// assumes that they were read in the session of an earlier program.
TEST(Pty, MissingBytesAreAwaitedOnlyOnce) {
    struct Modem : SerialClient {
        void fromHost(uint8_t, uint64_t) override {}
        void framingError(uint64_t) override {}
        bool nextToHost(uint8_t&) override { return false; }
    } modem;
    PtyLine line;
    line.attach(&modem);
    unsigned looks = 0;
    line.keepCount({[] { return 1; }, [](uint64_t, size_t) {}, [&] { return ++looks, 3; }});
    for (uint64_t now = 0; now < 10'000'000; now += 100'000)
        line.advance(now);
    EXPECT_LT(looks, 30'000u);
}

TEST_F(Step, TimeStopsWhileTheProgramWorks) {
    alongside([&](Clock& clock, SerialPort& port) {
        Random random(testSeed());
        for (uint8_t i = 0; i < 60; ++i) {
            const uint32_t begin = clock.nowUs();
            if (i % 4 == 0) // the machine is busy with other programs
                std::this_thread::sleep_for(std::chrono::milliseconds(random.below(20)));
            ASSERT_EQ(clock.nowUs(), begin) << "time passed while the program worked";
            ASSERT_EQ(port.write(&i, 1), 1);
            pollfd fds[] = {{port.fd(), POLLIN, 0}};
            // A byte takes 90 us in each direction, and the pty is polled every 100 us.
            ASSERT_EQ(clock.wait(fds, 1, 1'000'000), 1);
            ASSERT_LE(clock.nowUs() - begin, 500u);
            uint8_t byte = 0;
            ASSERT_EQ(port.read(&byte, 1), 1);
            ASSERT_EQ(byte, i + 1);
            const uint32_t from = clock.nowUs();
            ASSERT_EQ(clock.wait(&none_, 1, 1000), 0);
            ASSERT_LE(clock.nowUs() - from, 1010u) << "the wait took too long";
        }
    });
}

// An engine that fails starts again, possibly between two polls of the pty. The simulation must
// receive even the first byte of the new engine.
TEST_F(Step, TheNextProgramIsReceivedFromItsFirstByte) {
    alongside([&](Clock& clock, SerialPort& port) {
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
}

TEST_F(Step, AKilledProgramDoesNotStopTime) {
    pid_t child = fork();
    if (child == 0) {
        SimulatedClock clock(status_.path());
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

TEST_F(Step, AProgramOfAnotherPortIsNotAwaited) {
    SimulatedClock clock(status_.path());
    clock.keepStep(-1, "/dev/null");
    EXPECT_EQ(status_->keeper, 0u);
    const uint64_t end = status_->ns + 5'000'000;
    simulate([&] { return status_->ns >= end; });
}

// If the program is alive but does nothing, time soon continues without waiting for it, and a
// message on stderr reports this.
TEST_F(Step, AProgramThatStopsTimeTooLongIsNotAwaited) {
    SimulatedClock clock(status_.path());
    SerialPort port(clock);
    port.open(pty_.path());
    clock.keepStep(port.fd(), pty_.path());
    testing::internal::CaptureStderr();
    simulate([&] { return status_->ns > 1'000'000; }, 0.3);
    EXPECT_NE(testing::internal::GetCapturedStderr().find("process " + std::to_string(getpid())),
              std::string::npos);
}

// A debugger, or SIGSTOP, may stop the program for any time.
TEST_F(Step, AProgramInADebuggerIsAwaited) {
    int ready[2];
    ASSERT_EQ(pipe(ready), 0);
    const pid_t program = fork();
    if (program == 0) {
        SimulatedClock clock(status_.path());
        clock.keepStep(0, pty_.path());
        (void)!write(ready[1], "", 1);
        raise(SIGSTOP);
        _exit(0);
    }
    char byte;
    ASSERT_EQ(read(ready[0], &byte, 1), 1);
    ASSERT_EQ(waitpid(program, nullptr, WUNTRACED), program);
    const auto end = std::chrono::steady_clock::now() + std::chrono::milliseconds(500);
    simulate([&] { return std::chrono::steady_clock::now() > end; }, 0.1);
    EXPECT_LT(status_->ns, 1'000'000u) << "simulated time continued";
    kill(program, SIGKILL);
    waitpid(program, nullptr, 0);
    close(ready[0]);
    close(ready[1]);
}

// GroundStep gets a function that decides whether to continue. Once this function has returned
// false, it is not called again, and the simulation waits for no program any more.
TEST_F(Step, NoProgramIsAwaitedAfterTheStop) {
    SimulatedClock clock(status_.path());
    SerialPort port(clock);
    port.open(pty_.path());
    clock.keepStep(port.fd(), pty_.path());
    int asked = 0;
    GroundStep step(*status_, pty_, [&] { return ++asked < 1; });
    for (int i = 1; i <= 1000; ++i)
        step.wait(static_cast<uint64_t>(i) * 1000);
    EXPECT_EQ(asked, 1);
}

} // namespace
