// SPDX-License-Identifier: MIT
//
// rig: simulates the other end of the ground's serial port: a modem on a pty, the air, and a UAV
// that consists of a modem and a link layer. Simulated time follows the machine clock, but it
// waits for an engine that keeps step. On a busy machine, time therefore passes slowly, and no
// time-out expires too early. If a test waits for the rig, and all that it uses keeps step, time
// passes as fast as the models can be computed (setHurried).

#pragma once

#include "../../support/link_end.h"
#include "clock_file.h"
#include "ground_step.h"
#include "rf_channel.h"
#include "xbee.h"
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <poll.h>
#include <sys/socket.h>
#include <thread>

// The UAV: a modem, and the link layer that uses it.
class Uav : public LinkEnd {
public:
    using Bytes = std::vector<uint8_t>;

    Uav(RfChannel& air, int address, uint64_t seed) : address_(address), random_(seed) {
        move(air);
        begin();
    }
    // Moves the UAV to another air, so that it reaches the modems there.
    void move(RfChannel& to) {
        XBee::Options options;
        options.name = "uav " + std::to_string(address_);
        options.set = {{"BD", 7}, {"MY", static_cast<uint32_t>(address_)}, {"DL", 0}};
        modem.reset();
        modem = std::make_unique<XBee>(line_, to, options);
    }
    void advance(uint64_t now) {
        now_ = now;
        modem->advance(now);
        Bytes heard;
        heard.swap(line_.received);
        if (!runs)
            return;
        const U32 us = static_cast<U32>(now / 1000);
        Link_receive(link(), heard.data(), static_cast<U32>(heard.size()), us);
        Link_poll(link(), us);
    }
    unsigned sessions() { return statistics().sessions; }

    std::unique_ptr<XBee> modem;
    std::vector<std::pair<int, Bytes>> received;
    // number of each channel that was opened or closed, and 1 (opened) or 0 (closed)
    std::vector<std::pair<int, int>> opened;
    bool echo = false, refuse = false, runs = true;
    // If this function is set, it takes the messages instead of `received`. It is called in the
    // rig's thread, with the mutex locked.
    std::function<int(int channel, const U8* data, U32 size)> taking;
    std::function<void(int channel, bool isOpen)> opening;

private:
    bool transmit(const U8* frame, U32 size) override {
        line_.send({frame, frame + size}, now_);
        return true;
    }
    U32 random() override { return random_.next(); }
    bool take(int channel, const U8* data, U32 size) override {
        if (taking)
            return taking(channel, data, size) == 0;
        if (refuse || (echo && Link_send(link(), channel, data, size, 0) == LINK_FULL))
            return false;
        received.emplace_back(channel, Bytes(data, data + size));
        return true;
    }
    void onChannel(int channel, bool isOpen) override {
        if (opening)
            opening(channel, isOpen);
        else
            opened.emplace_back(channel, isOpen);
    }

    const int address_;
    HostLine line_;
    Random random_;
    uint64_t now_ = 0;
};

class Rig {
public:
    using Bytes = Uav::Bytes;

    explicit Rig(uint64_t seed) : air(seed), elsewhere(seed), uav(air, 1, seed) {
        replaceGround({});
        Link_start(uav.link(), us());
        thread_ = std::thread([this] { run(); });
    }
    ~Rig() {
        stop_ = true;
        thread_.join();
    }
    // Replaces the ground's modem by another one.
    void replaceGround(std::map<std::string, uint32_t> set) {
        place(ground, pty, air, std::move(set));
    }
    // Puts the modem of a second ground station into an air.
    void placeOther(RfChannel& where) {
        setHurried(false); // only an engine at `pty` keeps step
        place(other, otherPty, where, {});
    }
    // Runs `f` between two steps of the models, with the mutex locked.
    template <class F> auto with(F f) {
        std::lock_guard<std::mutex> lock(mutex_);
        return f();
    }
    // Sets whether time passes quickly while the test waits in until(), pass() or read(). This is
    // only right if no other program or thread has to do something meanwhile, apart from the
    // engine at `pty`.
    void setHurried(bool isHurried) { isHurried_ = isHurried; }
    // Waits until `done` returns true, for at most `seconds` of simulated time; a busy machine
    // takes longer in real time.
    template <class F> bool until(F done, uint64_t seconds = 60) {
        const uint64_t end = with([&] { return now_ + seconds * 1'000'000'000; });
        bool isLate = false;
        while (!with([&] { return isLate = now_ > end, done(); })) {
            if (isLate)
                return false;
            waitForStep();
        }
        return true;
    }
    double seconds() { // simulated
        return with([this] { return static_cast<double>(now_) / 1e9; });
    }
    void pass(double time) {
        const double end = seconds() + time;
        while (seconds() < end)
            waitForStep();
    }
    bool isReadable(int fd) {
        return until([fd] {
            pollfd p{fd, POLLIN, 0};
            return poll(&p, 1, 0) == 1;
        });
    }
    // Reads `size` bytes; returns fewer bytes if the stream ends or nothing arrives for a simulated
    // minute.
    Bytes read(int fd, size_t size) {
        Bytes bytes(size);
        size_t got = 0;
        while (got < size && isReadable(fd)) {
            ssize_t count = recv(fd, bytes.data() + got, size - got, 0);
            if (count == 0 || (count < 0 && errno != EAGAIN))
                break;
            got += count > 0 ? static_cast<size_t>(count) : 0;
        }
        bytes.resize(got);
        return bytes;
    }
    U32 us() const { return static_cast<U32>(now_ / 1000); }
    uint64_t ns() const { return now_; }

    static constexpr uint32_t guardMs = 20;
    // pause between two checks of a condition
    static constexpr std::chrono::microseconds pause{300};
    // two separate airs: a modem in one of them cannot reach a modem in the other
    RfChannel air, elsewhere;
    PtyLine pty, otherPty;
    std::unique_ptr<XBee> ground, other; // `other` is null until placeOther() is called
    Uav uav;
    std::function<void()> step; // called in the rig's thread at each step, with the mutex locked

private:
    void place(std::unique_ptr<XBee>& modem, PtyLine& line, RfChannel& where,
               std::map<std::string, uint32_t> set) {
        std::lock_guard<std::mutex> lock(mutex_);
        XBee::Options options;
        options.name = "ground";
        options.set = std::move(set);
        options.set.insert({{"GT", guardMs}, {"D6", 1}});
        modem.reset();
        modem = std::make_unique<XBee>(line, where, options);
    }
    using Steady = std::chrono::steady_clock;

    // Follows the machine clock, unless the test's thread is advancing time.
    void run() {
        while (!stop_) {
            {
                std::lock_guard<std::mutex> lock(stepping_);
                const auto now = Steady::now();
                // longest time between two steps of the models, ns
                constexpr uint64_t longestNs = 1'000'000;
                if (!hurries())
                    advance(std::min(static_cast<uint64_t>((now - last_).count()), longestNs));
                last_ = now;
            }
            std::this_thread::sleep_for(std::chrono::microseconds(50));
        }
    }
    // Lets time pass while the test's thread waits.
    void waitForStep() {
        ++waiters_;
        if (hurries()) {
            std::lock_guard<std::mutex> lock(stepping_);
            advance(hurriedNs);
        } else {
            std::this_thread::sleep_for(pause);
        }
        --waiters_;
    }
    // An engine that has not opened its modem does not keep step yet.
    bool hurries() const { return isHurried_ && waiters_ > 0 && step_.keeps(); }
    void advance(uint64_t ns) {
        waiting_ = Steady::now();
        step_.wait(now_);
        std::lock_guard<std::mutex> lock(mutex_);
        now_ += ns;
        clock_.set(now_);
        air.advance(now_);
        elsewhere.advance(now_);
        ground->advance(now_);
        if (other)
            other->advance(now_);
        if (step)
            step();
        uav.advance(now_);
    }

    // Returns whether simulated time must still wait for the engine. The wait ends after 5 s of
    // real time, because the engine's thread may itself be waiting for the test.
    bool goesOn() const {
        return !stop_ && std::chrono::steady_clock::now() - waiting_ < std::chrono::seconds(5);
    }

    std::atomic<bool> stop_{false};
    uint64_t now_ = 0;
    ClockFile clock_;
    std::chrono::steady_clock::time_point waiting_;
    GroundStep step_{*clock_, pty, [this] { return goesOn(); }};
    static constexpr uint64_t hurriedNs = 100'000; // step of a hurried wait
    std::atomic<bool> isHurried_{false};
    std::atomic<unsigned> waiters_{0};
    Steady::time_point last_ = Steady::now();
    std::mutex stepping_; // held during a step, before mutex_
    std::mutex mutex_;
    std::thread thread_;
};
