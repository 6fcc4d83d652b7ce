// SPDX-License-Identifier: MIT
//
// flight: runs one flight of the simulated UAV: the vehicle with its modem, the air, the ground's
// modem on a pty, and a child process with the program that uses the pty.

#pragma once

#include "camera.h"
#include "child.h"
#include "ground_step.h"
#include "m3_machine.h"
#include "recording.h"
#include "soc_model.h"
#include "vehicles.h"
#include <chrono>
#include <csignal>
#include <memory>
#include <thread>

// Slows simulated time down so that it does not run ahead of the wall clock, and measures the time
// for which the simulator works.
class Pace {
public:
    // `rate` is the number of simulated seconds per second of the wall clock; 0 means no limit.
    explicit Pace(double rate) : rate_(rate), anchor_(Clock::now()), begin_(anchor_) {}
    void keep(uint64_t simulatedNs) {
        if (rate_ == 0)
            return;
        auto due = anchor_ + std::chrono::nanoseconds(static_cast<int64_t>(
                                 static_cast<double>(simulatedNs - anchorNs_) / rate_));
        auto now = Clock::now();
        if (due > now) {
            std::this_thread::sleep_until(due);
            slept_ += Clock::now() - now;
        } else if (now - due > std::chrono::milliseconds(50)) {
            // The simulation was too slow. It does not catch up: the current time becomes the new
            // starting point.
            anchor_ = now;
            anchorNs_ = simulatedNs;
        }
    }
    // Limits the rate from this simulated time on.
    void limit(double rate, uint64_t simulatedNs) {
        if (rate != rate_) {
            anchor_ = Clock::now();
            anchorNs_ = simulatedNs;
        }
        rate_ = rate;
    }
    uint64_t workedNs() const {
        return static_cast<uint64_t>((Clock::now() - begin_ - slept_).count());
    }

private:
    using Clock = std::chrono::steady_clock;

    double rate_;
    Clock::time_point anchor_, begin_;
    uint64_t anchorNs_ = 0;
    Clock::duration slept_{};
};

// Returns the path of a file that belongs to the simulator. `installed` is the path below the
// folder into which the simulator was installed, `built` the path relative to the folder in which
// it was built.
std::string fileOfSimulator(const std::string& installed, const std::string& built);

std::string defaultFirmware();

class Flight {
public:
    struct Options {
        // Fields of the flight description, with the names used there
        // (tools/icesoc/cli/flight.schema.json).
        std::string image, size = "320x240", out = ".", speed = "real", cpu = "host",
                           firmware = defaultFirmware(), key, observer, trouble, modem_key, pins,
                           trace, flash, fpga_flash, modem = "s1", board;
        std::vector<std::string> fault;
        uint16_t guard = 1000;
        unsigned vehicles = 1;
        int gdb = -1;
        double loss = 0, interference = 0, distance = 0, duration = 0, from = 0, to = 0;
        uint64_t seed = 1;
        bool camera = false, wire = false, every_clock = false, quiet = false;
        NLOHMANN_DEFINE_TYPE_INTRUSIVE_WITH_DEFAULT(Options, image, size, out, speed, cpu, firmware,
                                                    key, observer, trouble, modem_key, pins, trace,
                                                    flash, fpga_flash, modem, board, fault, guard,
                                                    vehicles, gdb, loss, interference, distance,
                                                    duration, from, to, seed, camera, wire,
                                                    every_clock, quiet)
        nlohmann::json flight; // flight description, which is stored in the recording
        std::vector<std::string> command;
        // recording to replay; null if this flight is not a replay
        std::shared_ptr<ReplayedLine> replayed;
    };

    // Creates the output folder with the files of the ground station: the counters, before.png, and
    // the recording (except in a replay). If the options or the picture are wrong, throws
    // std::runtime_error before it creates anything.
    explicit Flight(const Options& options);
    Flight(const Flight&) = delete;
    Flight& operator=(const Flight&) = delete;

    // Flies until the program has ended, the time is over, or `stopSignal` is set. Returns the
    // program's exit status, or the status that a shell would report for the signal. A replay
    // throws std::runtime_error if it differs from the recording.
    int run();

    static volatile sig_atomic_t stopSignal;

private:
    void connectModels();
    void watchRegisters();
    void placePicture(SocModel& soc, const Frame& frame);
    void callFollowers();
    void callFollower(unsigned address, const std::vector<uint8_t>& otherKey = {});
    void bringTrouble();
    void countStarts(SocModel& soc, uint32_t address, uint32_t value, bool isWrite);
    void startProgram();
    void runOnHost();
    void runOnCortexM3();
    bool isWanted();
    double millionsPerSecond() const; // clocks
    void adviseOnClock();
    void mark(const char* what, const nlohmann::json& value);
    void watch();
    bool poll();
    void report();

    const Options o_;
    const Frame frame_;
    const std::vector<uint8_t> key_; // key of the link
    const RfWeather weather_;
    RfChannel air_;
    Station ground_;
    SocModel soc_;
    // additional vehicles; their addresses begin with 2
    std::vector<std::unique_ptr<Follower>> followers_;
    // second ground station; null unless there are several vehicles
    std::unique_ptr<Station> second_;
    // fault that is injected; null unless there are several vehicles
    std::unique_ptr<Trouble> trouble_;
    // number of times that the vision core of each vehicle was started
    std::map<const SocModel*, unsigned> starts_;
    // cable that replaces the modems and the air; null in a flight with radio
    std::unique_ptr<Cable> cable_;
    Child child_;
    Events events_;
    Pace pace_;
    bool advised_ = false, looks_ = false;
    AccessDigest accesses_;
    uint64_t nextDigest_ = 0;
};
