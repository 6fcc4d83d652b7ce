// SPDX-License-Identifier: MIT
//
// engine: one serial port with a modem, which the engine sets up by AT commands, and the peers that
// this modem reaches. An engine has one thread. All communicators of the process that use the same
// device share one engine.

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
    // Returns the peer with the address in `settings`, on the engine of the device; creates peer
    // and engine if necessary. An empty device selects the only open device. Throws
    // std::system_error if the device cannot be opened, or if it already has the maximum number of
    // peers.
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
    // failed_: the port is lost, or no modem has answered
    bool stop_ = false, failed_ = false;
    std::string complaint_; // last failure that was logged as an error; empty after a success
    // size of the largest frame, bytes; 0 until the modem is ready
    U32 longest_ = 0;
    std::map<int, std::unique_ptr<Peer>> peers_; // peers by address; a peer is never removed
    // upAt_: time at which a link was last up. downLimitUs_: time without a link, in microseconds,
    // after which the modem is set up again.
    U32 upAt_ = 0, downLimitUs_ = 0;
    std::condition_variable changed_; // signals that stop_ or the programs' requests have changed
    std::thread thread_;
};

} // namespace XBeeAT
