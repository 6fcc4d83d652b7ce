// SPDX-License-Identifier: MIT
//
// clock_test: the engine's clock, from a simulator's counters and from the machine.

#include "clock.h"
#include "clock_file.h"
#include <chrono>
#include <fstream>
#include <gtest/gtest.h>
#include <system_error>
#include <thread>
#include <unistd.h>

using XBeeAT::Clock;

namespace {

class SimulatedClock : public testing::Test {
protected:
    SimulatedClock() {
        (void)!pipe(pipe_);
        show(0);
    }
    ~SimulatedClock() override {
        close(pipe_[0]);
        close(pipe_[1]);
    }
    void show(uint64_t us) { status_.set(us * 1000); }

    ClockFile status_;
    const std::string file_ = status_.path();
    int pipe_[2];
};

TEST_F(SimulatedClock, ShowsWhatTheSimulatorSays) {
    Clock clock(file_);
    EXPECT_EQ(clock.nowUs(), 0u);
    show(1'234'567);
    EXPECT_EQ(clock.nowUs(), 1'234'567u);
    show((1ull << 32) + 5);
    EXPECT_EQ(clock.nowUs(), 5u); // wraps around
}

TEST_F(SimulatedClock, WaitLastsUntilSimulatedTimeHasPassed) {
    Clock clock(file_);
    pollfd fds[] = {{pipe_[0], POLLIN, 0}};
    std::thread simulator([&] {
        for (uint64_t us = 0; us <= 3000; us += 100) { // ten times too slow
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
            show(us);
        }
    });
    EXPECT_EQ(clock.wait(fds, 1, 2000), 0);
    EXPECT_GE(clock.nowUs(), 2000u);
    simulator.join();
}

TEST_F(SimulatedClock, WaitEndsWhenSomethingIsReadyThoughTimeStandsStill) {
    Clock clock(file_);
    pollfd fds[] = {{pipe_[0], POLLIN, 0}};
    (void)!write(pipe_[1], "x", 1);
    EXPECT_EQ(clock.wait(fds, 1, 1'000'000), 1);
    EXPECT_EQ(clock.nowUs(), 0u);
}

TEST_F(SimulatedClock, FileOfSomethingElseIsRefused) {
    std::ofstream(file_)
        << "this is no simulator's file of counters, though it is long enough for one.";
    EXPECT_THROW(Clock{file_}, std::system_error);
    std::ofstream(file_) << "short";
    EXPECT_THROW(Clock{file_}, std::system_error);
    EXPECT_THROW(Clock{"/no/such/file"}, std::system_error);
}

TEST_F(SimulatedClock, EnvironmentNamesIt) {
    show(77);
    EXPECT_EQ(Clock().nowUs(), 77u);
    unsetenv("XBEEAT_CLOCK");
    Clock machine;
    uint32_t begin = machine.nowUs();
    pollfd fds[] = {{pipe_[0], POLLIN, 0}};
    EXPECT_EQ(machine.wait(fds, 1, 1000), 0);
    EXPECT_GE(machine.nowUs() - begin, 1000u);
}

} // namespace
