// SPDX-License-Identifier: MIT
//
// engine: one serial port with a modem, which it sets up by AT commands, and the peers that are
// reached by it. An engine has one thread. All communicators of the process that name one device
// share its engine.

#pragma once

#include "clock.h"
#include "packet_line.h"
#include "peer.h"
#include "serial_port.h"

#include <condition_variable>
#include <map>
#include <memory>
#include <thread>

namespace XBeeAT {

constexpr size_t mostPeers = 32; // largest number of peers of a modem

class Engine : private Peer::Host {
public:
    // Returns the vehicle with the settings' address, on the engine of the device; creates both if
    // necessary. Throws std::system_error if the device cannot be opened, or already has the
    // maximum number of peers. An empty device selects the only open one.
    static std::shared_ptr<Peer> get(const Settings& settings, const Log& log);

    ~Engine() override;
    Engine(const Engine&) = delete;
    Engine& operator=(const Engine&) = delete;

private:
    Engine(const Settings& settings, const Log& log);
    Peer& peer(const Settings& settings);
    void wake() override;
    void run();
    std::string prepareModem(const Settings& wanted);
    void start(Peer& peer);
    void fly(std::unique_lock<std::mutex>& lock);
    void waitForReason(std::unique_lock<std::mutex>& lock);
    void loop(std::unique_lock<std::mutex>& lock);
    U32 pollPeers(U32 now);
    bool downTooLong(U32 now);
    void fail(const std::string& text);
    // Waits as ModemSetup::Wait defines. Returns a negative number if the engine must stop, or if
    // the port is lost.
    int waitMs(int ms, bool forBytes);
    bool any(bool (Peer::*is)() const) const;
    void readSerial(U32 now);
    void deliver(int source, const U8* bytes, size_t size, U32 now);
    void answer(bool isThere, U32 now);

    SerialPort serial_{clock};
    PacketLine packets_{serial_};
    int wakePipe_[2] = {-1, -1};
    // failed_: the port is lost, or no modem answered; complained_: that was logged as an error.
    bool stop_ = false, failed_ = false, complained_ = false;
    // size of the largest frame, bytes; 0 until the modem is ready
    U32 longest_ = 0;
    std::map<int, std::unique_ptr<Peer>> peers_; // peers by address; a peer is never removed
    // time at which a link was last up; longest time without a link before the modem is configured
    // again
    U32 upAt_ = 0, downLimitUs_ = 0;
    std::condition_variable changed_; // signals changes of stop_ and of requests
    std::thread thread_;
};

} // namespace XBeeAT
