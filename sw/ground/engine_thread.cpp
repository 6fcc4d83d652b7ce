// SPDX-License-Identifier: MIT
//
// engine_thread: the engine's thread: serial port, link, streams of the program.

#include "engine.h"
#include "modem_setup.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <poll.h>
#include <random>
#include <unistd.h>

namespace XBeeAT {

namespace {

constexpr int ownChannels = 3;
constexpr std::chrono::seconds retryEvery{5}; // while only a listener waits for the modem

} // namespace

// ---- link callbacks, in the engine's thread, mutex held ----

int Engine::onTransmit(void* context, const U8* frame, U32 size) {
    Engine& e = self(context);
    U32 now = e.clock_.nowUs();
    if (!e.serialOut_.empty() || !e.pacer_.offer(frame, size, now))
        return 1;
    e.writeSerial(now);
    return 0;
}

U32 Engine::onRandom(void*) {
    static std::random_device device;
    return device();
}

int Engine::onMessage(void* context, int channel, const U8* data, U32 size) {
    Engine& e = self(context);
    Stream& s = e.streams_[channel];
    if (!s.isOpen())
        return 0; // the program has closed: nobody wants it
    // A slow program: the link holds the rest back.
    return s.give(data, size, e.clock_.nowUs()) ? 0 : 1;
}

void Engine::onChannel(void* context, int channel, int isOpen) {
    Engine& e = self(context);
    Stream& s = e.streams_[channel];
    if (!isOpen) {
        if (!s.wanted)
            s.close();
        return;
    }
    if (channel < ownChannels || !e.listening_) {
        e.log_(1, "the peer opened channel " + std::to_string(channel) + ", and nobody listens");
        Link_closeChannel(e.link_.get(), channel, e.clock_.nowUs());
        return;
    }
    int programEnd = s.open(true);
    if (programEnd < 0)
        return;
    e.accepted_.push_back(programEnd);
    char byte = 0;
    (void)!write(e.acceptPipe_[1], &byte, 1);
}

void Engine::onState(void* context, Link_State state) {
    Engine& e = self(context);
    static const char* const names[] = {"idle", "connecting", "up"};
    e.log_(1, "link " + std::string(names[state]));
    if (state == LINK_STATE_UP)
        return;
    for (Stream& s : e.streams_)
        if (!s.wanted)
            s.close();
}

void Engine::onWritable(void* context) {
    for (Stream& s : self(context).streams_)
        s.stuck = false;
}

// ---- the modem's life ----

int Engine::waitMs(int ms, bool forBytes) {
    // A port that is gone ends the wait, too: where its simulator has ended, time stands still.
    pollfd fds[] = {{wakePipe_[0], POLLIN, 0},
                    {serial_.fd(), static_cast<short>(forBytes ? POLLIN : 0), 0}};
    const U32 begin = clock_.nowUs(), us = static_cast<U32>(ms) * 1000;
    for (;;) {
        {
            std::lock_guard<std::mutex> lock(mutex_);
            if (stop_)
                return -1;
        }
        U32 passed = clock_.nowUs() - begin;
        if (passed >= us || (fds[1].revents & POLLIN))
            return static_cast<int>(passed);
        char bytes[64];
        if (clock_.wait(fds, 2, us - passed) > 0 && fds[0].revents)
            (void)!read(wakePipe_[0], bytes, sizeof bytes);
        if (fds[1].revents & ~POLLIN)
            return -1;
    }
}

// The port is lost, or the modem: who is connected, or waits to be, must know.
void Engine::fail(const std::string& text) {
    log_(complained_ ? 1 : 0, text);
    complained_ = failed_ = true;
    Link_stop(link_.get(), clock_.nowUs());
    for (Stream& s : streams_)
        s.close();
}

bool Engine::prepareModem(const Settings& settings) {
    ModemSetup setup(serial_, settings, log_,
                     [this](int ms, bool forBytes) { return waitMs(ms, forBytes); });
    if (!settings.setUp) {
        serial_.setSpeed(settings.baud);
    } else if (!setup.run()) {
        return false;
    }
    std::lock_guard<std::mutex> lock(mutex_);
    U32 longest = setup.encrypts() ? LINK_MAX_ENCRYPTED : LINK_MAX_FRAME;
    pacer_ = FramePacer(settings.characterUs(), longest);
    pacer_.clear(clock_.nowUs());
    serialOut_.clear();
    Link_limitFrame(link_.get(), longest);
    log_(1, "modem ready on " + device_ + (setup.encrypts() ? ", it encrypts" : ""));
    return true;
}

// A port that is lost or a modem that does not answer is no end: who connects, or listens, has it
// tried again.
void Engine::run() {
    std::unique_lock<std::mutex> lock(mutex_);
    while (!stop_) {
        if (failed_)
            waitForReason(lock);
        if (!stop_)
            fly(lock);
    }
}

void Engine::waitForReason(std::unique_lock<std::mutex>& lock) {
    auto reason = [this] { return stop_ || isWanted(); };
    if (!listening_)
        changed_.wait(lock, [&] { return reason() || listening_; });
    else
        changed_.wait_for(lock, retryEvery, reason);
}

// From an open port to a lost one. A modem that was reset in flight has its own settings again
// (nothing is written to its memory). It looks like a peer that is silent: so after a while the
// modem is set up once more, and less and less often while nothing changes.
void Engine::fly(std::unique_lock<std::mutex>& lock) {
    const Settings settings = settings_;
    const U32 down = static_cast<U32>(settings.downMs) * 1000;
    patienceUs_ = down;
    if (failed_ && !serial_.open(device_))
        return fail("cannot open serial port '" + device_ + "': " + std::strerror(errno));
    // A simulator waits for this thread as long as it flies.
    struct Step {
        Step(Clock& c, int serial, const std::string& device) : clock(c) {
            clock.keepStep(serial, device);
        }
        ~Step() { clock.leaveStep(); }
        Clock& clock;
    } step(clock_, serial_.fd(), device_);
    for (bool first = true;; first = false) {
        lock.unlock();
        bool ready = prepareModem(settings);
        lock.lock();
        if (stop_)
            return;
        if (!ready && first)
            return fail("no modem answers on '" + device_ +
                        "': check its power and cable, the guard time (-g), or set XBeeAT.Setup=0 "
                        "if it must not be set up; given up");
        if (!ready)
            log_(0, "no modem answers on '" + device_ + "'");
        failed_ = complained_ = false;
        Link_start(link_.get(), clock_.nowUs());
        upAt_ = clock_.nowUs();
        loop(lock);
        if (stop_ || failed_)
            return;
        log_(1, "the link is down: setting the modem up again");
        patienceUs_ = std::min(patienceUs_ * 2, 4 * down);
    }
}

bool Engine::downTooLong(U32 now) {
    if (Link_state(link_.get()) == LINK_STATE_UP) {
        upAt_ = now;
        patienceUs_ = static_cast<U32>(settings_.downMs) * 1000;
    }
    return settings_.setUp && now - upAt_ >= patienceUs_;
}

// ---- bytes ----

void Engine::readSerial(U32 now) {
    U8 bytes[512];
    ssize_t count = serial_.read(bytes, sizeof bytes);
    if (count > 0)
        Link_receive(link_.get(), bytes, static_cast<U32>(count), 0, now);
    else if (count == 0 || (errno != EAGAIN && errno != EINTR))
        fail("serial port '" + device_ + "': " + (count == 0 ? "closed" : std::strerror(errno)));
}

void Engine::writeSerial(U32 now) {
    if (serialOut_.empty())
        serialOut_ = pacer_.due(now);
    if (serialOut_.empty())
        return;
    ssize_t count = serial_.write(serialOut_.data(), serialOut_.size());
    if (count > 0)
        serialOut_.erase(serialOut_.begin(), serialOut_.begin() + count);
}

// Whole messages from the program's stream to the link. False: the stream makes no sense.
bool Engine::sendMessages(int channel, U32 now) {
    Stream& s = streams_[channel];
    while (!s.wanted) {
        Stream::Next next = s.next(LINK_MAX_MESSAGE);
        if (next == Stream::Next::Senseless)
            log_(0, "a message of " + std::to_string(s.size()) +
                        " bytes does not fit the radio link (at most " +
                        std::to_string(LINK_MAX_MESSAGE) + "): connection closed");
        if (next != Stream::Next::Message)
            return next == Stream::Next::None;
        Link_Status status = Link_send(link_.get(), channel, s.data(), s.size(), 0, now);
        s.stuck = status == LINK_FULL;
        if (status != LINK_OK)
            return status == LINK_FULL;
        s.taken(now);
    }
    return true;
}

void Engine::readProgram(int channel, U32 now) {
    Stream& s = streams_[channel];
    bool open = s.read();
    if (sendMessages(channel, now) && open)
        return;
    Link_closeChannel(link_.get(), channel, now);
    s.close();
}

void Engine::openWanted(U32 now) {
    if (Link_state(link_.get()) != LINK_STATE_UP)
        return;
    for (int channel = 0; channel < ownChannels; ++channel)
        if (streams_[channel].wanted && Link_openChannel(link_.get(), channel, now) == LINK_OK)
            streams_[channel].wanted = false;
}

U32 Engine::beat(U32 now) {
    U32 wait = 0xFFFFFFFFu;
    for (Stream& s : streams_)
        wait = std::min(wait, s.beat(now));
    return wait;
}

// Returns when the engine is to stop, has failed, or the link has been down for too long.
void Engine::loop(std::unique_lock<std::mutex>& lock) {
    while (!stop_ && !failed_) {
        U32 now = clock_.nowUs();
        if (downTooLong(now))
            return;
        openWanted(now);
        Link_poll(link_.get(), now);
        U32 deadline = std::min({Link_deadline(link_.get(), now), beat(now), pacer_.deadline(now)});
        std::vector<pollfd> fds = {
            {serial_.fd(), static_cast<short>(serialOut_.empty() ? POLLIN : POLLIN | POLLOUT), 0},
            {wakePipe_[0], POLLIN, 0}};
        for (Stream& s : streams_) {
            short events = static_cast<short>((s.stuck || s.wanted ? 0 : POLLIN) |
                                              (s.wantsWriting() ? POLLOUT : 0));
            fds.push_back({s.wanted ? -1 : s.fd(), events, 0});
        }
        lock.unlock();
        clock_.wait(fds.data(), fds.size(), deadline);
        lock.lock();
        now = clock_.nowUs();
        if (fds[1].revents) {
            char bytes[64];
            (void)!read(wakePipe_[0], bytes, sizeof bytes);
        }
        if (fds[0].revents & (POLLIN | POLLERR | POLLHUP))
            readSerial(now);
        writeSerial(now);
        for (int channel = 0; channel < LINK_CHANNELS; ++channel) {
            pollfd& p = fds[2 + static_cast<size_t>(channel)];
            Stream& s = streams_[channel];
            if (p.fd < 0 || p.fd != s.fd())
                continue;
            s.write();
            if ((p.revents & (POLLIN | POLLHUP | POLLERR)) || (!s.stuck && s.hasBytes()))
                readProgram(channel, now);
        }
    }
    if (!failed_) {
        Link_stop(link_.get(), clock_.nowUs());
        writeSerial(clock_.nowUs());
    }
}

} // namespace XBeeAT
