// SPDX-License-Identifier: MIT
//
// wire: a serial port that leads to a link layer directly, without a modem. It transfers bytes as
// fast as they are read. Also contains helpers for the sockets of programs.

#pragma once

#include "../../support/link_end.h"
#include "engine.h"
#include "ice_header.h"
#include "random.h"
#include <algorithm>
#include <cerrno>
#include <chrono>
#include <fcntl.h>
#include <functional>
#include <memory>
#include <mutex>
#include <poll.h>
#include <pty.h>
#include <stdexcept>
#include <sys/socket.h>
#include <termios.h>
#include <unistd.h>
#include <vector>

using Bytes = std::vector<uint8_t>;

// Returns a message in Ice's format that has a valid size and no meaning.
inline Bytes message(uint8_t tag, size_t size = 30) {
    return IceHeader::pack(7, Bytes(size - IceHeader::bytes, tag));
}

inline void writeAll(int fd, const Bytes& bytes) {
    for (size_t done = 0; done < bytes.size();) {
        pollfd p{fd, POLLOUT, 0};
        poll(&p, 1, -1);
        ssize_t count = send(fd, bytes.data() + done, bytes.size() - done, MSG_NOSIGNAL);
        if (count < 0 && errno != EAGAIN)
            break;
        done += count > 0 ? static_cast<size_t>(count) : 0;
    }
}

// The log of the engines: one line per message, beginning with the level.
class EngineLog {
public:
    XBeeAT::Log taker() {
        return [this](int level, const std::string& text) {
            std::lock_guard<std::mutex> lock(mutex_);
            text_ += std::to_string(level) + " " + text + "\n";
        };
    }
    std::string text() {
        std::lock_guard<std::mutex> lock(mutex_);
        return text_;
    }
    bool has(const std::string& part) { return text().find(part) != std::string::npos; }
    // Returns the number of messages of a level.
    size_t count(int level) {
        const std::string all = "\n" + text(), start = "\n" + std::to_string(level) + " ";
        size_t found = 0;
        for (size_t at = 0; (at = all.find(start, at)) != std::string::npos; ++at)
            ++found;
        return found;
    }

private:
    std::mutex mutex_;
    std::string text_;
};

class Wire : private LinkEnd {
public:
    Wire() {
        begin(16); // 16 us for 16 characters, so the link need not limit its rate
        Link_start(link(), us());
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
    // Returns settings for an engine on a wire that is as fast as the machine.
    static XBeeAT::Settings settings() {
        XBeeAT::Settings s;
        s.setUp = false;
        s.baud = 10'000'000;
        return s;
    }
    // Returns an engine at the other end of this wire.
    std::shared_ptr<XBeeAT::Peer> engine(int idleMs = 0) {
        XBeeAT::Settings s = settings();
        s.device = name_;
        s.idleMs = idleMs;
        return XBeeAT::Engine::get(s, log_.taker());
    }
    std::string path() const { return name_; }
    std::string log() { return log_.text(); }
    // Puts bytes on the wire and discards the answer.
    void flood(const Bytes& bytes) {
        for (size_t done = 0; done < bytes.size();) {
            pollfd p{master_, POLLIN | POLLOUT, 0};
            poll(&p, 1, -1);
            U8 sink[512];
            (void)!read(master_, sink, sizeof sink);
            ssize_t count = write(master_, bytes.data() + done, bytes.size() - done);
            done += count > 0 ? static_cast<size_t>(count) : 0;
        }
    }
    // Runs the link of the peer until `done` returns true. Returns false if the link had nothing to
    // read in `rests` pauses of 2 ms each (longer on a busy machine).
    template <class F> bool until(F done, int rests = 30'000) {
        while (!done()) {
            pollfd p{master_, POLLIN, 0};
            if (poll(&p, 1, 2) == 0 && --rests < 0)
                return false;
            U8 bytes[512];
            ssize_t count = read(master_, bytes, sizeof bytes);
            if (count > 0)
                Link_receive(link(), bytes, static_cast<U32>(count), us());
            Link_poll(link(), us());
        }
        return true;
    }

    bool echo = true;
    bool open[LINK_CHANNELS] = {};
    unsigned openings[LINK_CHANNELS] = {}, received[LINK_CHANNELS] = {}; // messages
    std::function<void(int channel, const Bytes& message)> onMessage = [](int, const Bytes&) {};

private:
    bool transmit(const U8* frame, U32 size) override {
        return write(master_, frame, size) == static_cast<ssize_t>(size);
    }
    U32 random() override { return random_.next(); }
    bool take(int channel, const U8* data, U32 size) override {
        if (echo && Link_send(link(), channel, data, size, 0) == LINK_FULL)
            return false;
        ++received[channel];
        onMessage(channel, Bytes(data, data + size));
        return true;
    }
    void onChannel(int channel, bool isOpen) override {
        open[channel] = isOpen;
        openings[channel] += isOpen;
    }
    static U32 us() {
        return static_cast<U32>(std::chrono::duration_cast<std::chrono::microseconds>(
                                    std::chrono::steady_clock::now().time_since_epoch())
                                    .count());
    }
    EngineLog log_;
    int master_ = -1, slave_ = -1;
    char name_[128];
    Random random_{testSeed()};
};
