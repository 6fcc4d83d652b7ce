// SPDX-License-Identifier: MIT
//
// chip_world: simulates the real system for stock Ice: RTL, DDR3, firmware with IceC, two modems,
// the air, and a pty for the plugin. The simulation runs in a separate thread, and simulated time
// waits for the plugin.

#pragma once

#include "../clock_file.h"
#include "Echo.h"
#include "ground_step.h"
#include "soc_model.h"
#include "uav_machine.h"
#include <Ice/Ice.h>
#include <atomic>
#include <chrono>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>

struct EchoUav_Port; // echo_uav.h

class ChipWorld {
public:
    // `port` contains functions that the firmware calls in the thread of the simulation. `hasKey`:
    // ground and UAV share a key; otherwise the link is not encrypted.
    ChipWorld(uint64_t seed, const EchoUav_Port& port, void* context, bool hasKey = false);
    ~ChipWorld();
    ChipWorld(const ChipWorld&) = delete;
    ChipWorld& operator=(const ChipWorld&) = delete;

    // Runs `f` in the thread of the simulation, the only thread that may use the models.
    void with(std::function<void()> f);
    uint64_t ns() const { return clock_.ns(); }
    void sleep(double seconds) const; // simulated
    // Limits the speed of simulated time to that of real time, or lifts this limit. Programs on the
    // ground then take as much of the simulated time as on a real ground station.
    void follow(bool isRealTime) { isRealTime_ = isRealTime; }
    // Restarts processor and chip, but not memory and modem.
    void reboot() { reboot_ = true; }

    // Returns the communicator of a program on the ground. The time-out of its calls is in
    // wall-clock ms.
    Ice::CommunicatorPtr client(std::map<std::string, std::string> more = {}) const;
    std::string endpoint() const { return "xbee-at -t 120000 -d " + pty_.path(); }
    std::shared_ptr<RadioTest::EchoPrx> echo(const Ice::CommunicatorPtr& ic,
                                             const std::string& connection = "") const;

private:
    uint64_t advance(uint64_t now);
    void waitForRealTime(uint64_t now);
    void run();
    static XBee::Options modem(const char* name, std::map<std::string, uint32_t> set);

    static constexpr uint32_t guardMs_ = 20;
    const uint64_t seed_;
    std::unique_ptr<UnnamedFile> key_; // null: unencrypted
    ClockFile clock_;

public: // to be used only in the thread of the simulation
    RfChannel air;

private:
    PtyLine pty_;

public:
    XBee groundModem;
    SocModel soc;

private:
    GroundStep step_;
    std::atomic<bool> stop_{false}, reboot_{false}, isRealTime_{false};
    // real time that corresponds to the simulated time 0; null while the speed is not limited
    std::optional<std::chrono::steady_clock::time_point> origin_;
    std::mutex mutex_;
    std::vector<std::function<void()>> wanted_;
    std::thread thread_;
};
