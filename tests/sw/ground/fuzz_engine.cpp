// SPDX-License-Identifier: MIT
//
// fuzz_engine: fuzzes the ground's engine with libFuzzer: its serial input, and the bytes that
// programs write. An input is a sequence of steps. Between the steps the engine runs with a link
// layer at the other end of the wire, so that sessions are opened. Nothing may crash, hang or leak,
// and each message that is passed to a program must be complete.
//
// If the lowest bit of the first byte is 1, the modem is set up first. Each step then has two
// bytes, its kind (mod 8) and its argument n, and may be followed by data:
//   0     n bytes of noise arrive on the serial line
//   1     a frame of the peer is damaged
//   2     n frames are lost
//   3, 4  program n mod 3 writes a message with the data that follows
//   5     this program writes n raw bytes
//   6     this program disconnects; if n > 127, it connects again
//   7     8 n ms pass
//
// This file implements clock and serial port itself, so that only the thread of the engine runs,
// and time depends only on the input.

#include "../../support/link_end.h"
#include "engine.h"
#include "ice_header.h"
#include <algorithm>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <deque>
#include <sys/eventfd.h>
#include <sys/socket.h>
#include <unistd.h>

namespace {

using Bytes = std::vector<uint8_t>;

void expect(bool condition) {
    if (!condition)
        std::abort();
}

// The program's side of a connection. The program reads the engine's output in pieces of any size.
class Program {
public:
    ~Program() { leave(); }
    void come(XBeeAT::Peer& engine) {
        if (fd_ < 0)
            fd_ = engine.connect(-1);
    }
    void leave() {
        if (fd_ >= 0)
            close(fd_);
        fd_ = -1;
        in_.clear();
    }
    void write(const Bytes& bytes) const {
        if (fd_ >= 0)
            (void)!send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
    }
    void read() {
        uint8_t bytes[4096];
        ssize_t count = fd_ < 0 ? 0 : recv(fd_, bytes, sizeof bytes, MSG_DONTWAIT);
        if (count > 0)
            in_.insert(in_.end(), bytes, bytes + count);
        while (in_.size() >= IceHeader::bytes) {
            const uint32_t size = IceHeader::sizeOf(in_.data());
            expect(IceHeader::isValid(in_.data()) && size <= LINK_MAX_MESSAGE);
            if (in_.size() < size)
                break;
            in_.erase(in_.begin(), in_.begin() + size);
        }
    }

private:
    int fd_ = -1;
    Bytes in_;
};

// Simulates everything around the engine for one input: the wire, the peer's link, programs, time.
class Surroundings : private LinkEnd {
public:
    Surroundings(const uint8_t* data, size_t size) : at_(data), end_(data + size) {
        begin();
        Link_start(link(), now);
    }
    ~Surroundings() override { close(serial); }
    void run() {
        XBeeAT::Settings settings;
        settings.device = "fuzz";
        settings.setUp = at_ < end_ && (*at_++ & 1);
        settings.guardMs = 2;
        settings.idleMs = 2000;
        settings.random = [this] { return random(); };
        std::unique_lock<std::mutex> lock(mutex_);
        engine_ = XBeeAT::Engine::get(settings, [this](int, const std::string& text) {
            // the engine has reported a failure
            if (text.find("will try again") != std::string::npos)
                end();
        });
        engine_->listen();
        for (Program& program : programs_)
            program.come(*engine_);
        stage_ = Stage::Goes;
        changed_.notify_all();
        changed_.wait(lock, [this] { return stage_ == Stage::Over; });
        lock.unlock();
        engine_.reset();
    }

    // ---- clock and serial port of the engine ----
    U32 now = 0xFFFFF000u;
    std::deque<uint8_t> toEngine;
    const int serial = eventfd(0, EFD_CLOEXEC);

    void fromEngine(const uint8_t* bytes, size_t size) {
        Link_receive(link(), bytes, static_cast<U32>(size), now);
        if (bytes[0] == 'A' || bytes[0] == '+') // a modem would interpret these bytes as a command
            for (char c : {'O', 'K', '\r'})
                toEngine.push_back(static_cast<uint8_t>(c));
    }
    // Waits like the engine clock: returns when a descriptor is ready or `us` have passed.
    int wait(pollfd* fds, nfds_t count, uint32_t us) {
        std::unique_lock<std::mutex> lock(mutex_);
        changed_.wait(lock, [this] { return stage_ != Stage::Begins; });
        lock.unlock();
        for (;;) {
            if (stage_ == Stage::Over)
                return poll(fds, count, -1);
            int ready = poll(fds, count, 0);
            for (nfds_t i = 0; i < count; ++i)
                if (fds[i].fd == serial && (fds[i].events & POLLIN) && !toEngine.empty()) {
                    ready += !fds[i].revents;
                    fds[i].revents |= POLLIN;
                }
            now += 10; // time also passes for an engine that never waits, so that the input ends
            if (ready && ++busy_ % 64)
                return ready;
            const uint32_t step = std::min(us, at_ < end_ ? 10'000u : 200'000u);
            pass(step);
            us -= us == XBeeAT::Clock::forever ? 0 : step;
            if (us == 0)
                return ready;
        }
    }

private:
    enum class Stage { Begins, Goes, Over };

    bool transmit(const U8* frame, U32 size) override {
        frames_.emplace_back(frame, frame + size);
        return true;
    }
    bool take(int channel, const U8* data, U32 size) override { // an echo
        return Link_send(link(), channel, data, size, 0) != LINK_FULL;
    }
    U32 random() override { return nonce_ = nonce_ * 1664525u + 1013904223u; }
    void end() {
        std::lock_guard<std::mutex> lock(mutex_);
        stage_ = Stage::Over;
        changed_.notify_all();
    }
    void pass(uint32_t us) {
        now += us;
        Link_poll(link(), now);
        deliver();
        for (Program& program : programs_)
            program.read();
        pause_ -= std::min(pause_, us + 1);
        if (pause_ == 0)
            next();
    }
    void deliver() {
        for (Bytes& frame : frames_) {
            if (lose_ > 0) {
                --lose_;
                continue;
            }
            frame[harm_ % frame.size()] ^= harm_;
            harm_ = 0;
            toEngine.insert(toEngine.end(), frame.begin(), frame.end());
        }
        frames_.clear();
    }
    Bytes take(size_t count) {
        count = std::min(count, static_cast<size_t>(end_ - at_));
        at_ += count;
        return Bytes(at_ - count, at_);
    }
    // Executes the next step of the input. After the last step, time passes until all time-outs
    // have expired.
    void next() {
        if (end_ - at_ < 2) {
            pause_ = 1'000'000;
            if (rest_-- == 0)
                end();
            return;
        }
        const uint8_t step = *at_++ & 7, n = *at_++;
        Program& program = programs_[n % 3];
        if (step == 0) {
            const Bytes noise = take(n);
            toEngine.insert(toEngine.end(), noise.begin(), noise.end());
        } else if (step == 1) {
            harm_ = n;
        } else if (step == 2) {
            lose_ = n;
        } else if (step < 5) {
            program.write(IceHeader::pack(n % 5, take(n)));
        } else if (step == 5) {
            program.write(take(n));
        } else if (step == 6) {
            program.leave();
            if (n & 0x80)
                program.come(*engine_);
        } else {
            pause_ = n * 8000u;
        }
    }

    const uint8_t *at_, *end_;
    uint32_t nonce_ = 1, pause_ = 0;
    unsigned lose_ = 0, rest_ = 20, busy_ = 0;
    uint8_t harm_ = 0;
    std::vector<Bytes> frames_;
    std::shared_ptr<XBeeAT::Peer> engine_;
    Program programs_[3];
    std::mutex mutex_;
    std::condition_variable changed_;
    std::atomic<Stage> stage_{Stage::Begins};
};

Surroundings* world;

} // namespace

namespace XBeeAT {

class FuzzedClock : public Clock {
public:
    uint32_t nowUs() const override { return world->now; }
    int wait(pollfd* fds, nfds_t count, uint32_t us) override {
        return world->wait(fds, count, us);
    }
};
std::unique_ptr<Clock> makeClock() {
    return std::make_unique<FuzzedClock>();
}

void SerialPort::open(const std::string&) {
    fd_ = world->serial;
}
void SerialPort::close() {}
bool SerialPort::isGone() const {
    return false;
}
void SerialPort::setSpeed(int) {}
ssize_t SerialPort::read(void* bytes, size_t room) {
    std::deque<uint8_t>& from = world->toEngine;
    const size_t count = std::min(room, from.size());
    if (count == 0) {
        errno = EAGAIN;
        return -1;
    }
    std::copy_n(from.begin(), count, static_cast<uint8_t*>(bytes));
    from.erase(from.begin(), from.begin() + static_cast<ptrdiff_t>(count));
    return static_cast<ssize_t>(count);
}
ssize_t SerialPort::write(const void* bytes, size_t size) {
    world->fromEngine(static_cast<const uint8_t*>(bytes), size);
    return static_cast<ssize_t>(size);
}
size_t SerialPort::waiting() const {
    return 0;
}
void SerialPort::drop() {
    world->toEngine.clear();
}

} // namespace XBeeAT

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    Surroundings here(data, size);
    world = &here;
    here.run();
    return 0;
}
