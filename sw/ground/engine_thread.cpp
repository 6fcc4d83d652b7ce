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
#include <system_error>
#include <unistd.h>

namespace XBeeAT {

namespace {

constexpr std::chrono::seconds retryEvery{5}; // while only a listener waits for the modem
constexpr U32 lookUs = 50000;   // interval of looking for a channel while programs wait
constexpr U32 briefBytes = 128; // of a message that one fragment takes, its head compressed

} // namespace

// ---- link callbacks, in the engine's thread, mutex held ----

int Engine::onTransmit(void* context, const U8* frame, U32 size) {
    Engine& e = self(context);
    U32 now = e.clock_.nowUs();
    if (!e.serialOut_.empty() ||
        (!e.api_ && (e.serial_.waiting() || !e.pacer_.offer(frame, size, now))))
        return 1;
    if (e.api_)
        e.serialOut_ = e.api_->packet(frame, size, now);
    e.writeSerial(now);
    return 0;
}

U32 Engine::onRandom(void* context) {
    return self(context).settings_.random();
}

int Engine::onMessage(void* context, int channel, const U8* data, U32 size) {
    Engine& e = self(context);
    Stream& s = e.streams_[channel];
    U32 now = e.clock_.nowUs();
    bool isWanted = s.is(Stream::State::Open) || s.is(Stream::State::Called);
    // The link delivers in order, so a message held back would hold all other programs' back.
    if (isWanted && !s.give(data, size, now))
        e.end(channel, 0,
              "does not read: " + std::to_string(Stream::mostUnread) + " bytes wait for it");
    return 0;
}

void Engine::onChannel(void* context, int channel, int isOpen) {
    Engine& e = self(context);
    Stream& s = e.streams_[channel];
    if (!isOpen) {
        if (!s.is(Stream::State::Wanted))
            e.lost_ += s.leave(e.clock_.nowUs());
        return;
    }
    if (channel < ownChannels || !e.listening_) {
        e.log_(1, "the peer opened channel " + std::to_string(channel) + ", and nobody listens");
        Link_closeChannel(e.link_.get(), channel);
        return;
    }
    s.call();
    char byte = 0;
    (void)!write(e.acceptPipe_[1], &byte, 1);
}

void Engine::onState(void* context, Link_State state) {
    Engine& e = self(context);
    static const char* const names[] = {"idle", "connecting", "up"};
    const bool isSecure = Link_keyInUse(e.link_.get()) >= 0;
    e.log_(1, "link " + std::string(names[state]) +
                  (state != LINK_STATE_UP ? ""
                   : isSecure             ? ", secure"
                                          : ", in the clear"));
    if (state == LINK_STATE_UP)
        return;
    for (Stream& s : e.streams_)
        if (!s.is(Stream::State::Wanted))
            e.lost_ += s.leave(e.clock_.nowUs());
}

void Engine::onOutcome(void* context, int channel, U32 isCall, Link_Outcome outcome) {
    const Stream& s = self(context).streams_[channel];
    self(context).late_[channel].pop_front();
    bool hasLeft = !s.is(Stream::State::Open) || s.ended();
    self(context).lost_ += hasLeft && isCall && outcome == LINK_UNKNOWN;
}

void Engine::onWritable(void* context) {
    self(context).full_ = 0;
}

// ---- the modem's life ----

int Engine::waitMs(int ms, bool forBytes) {
    // The wait also ends when the port is lost: where its simulator has ended, time stands still.
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

// Ends all connections and those that wait for one, since the port or the modem is lost.
void Engine::fail(const std::string& text) {
    log_(complained_ ? 1 : 0, text);
    complained_ = failed_ = true;
    Link_stop(link_.get(), clock_.nowUs());
    for (Stream& s : streams_)
        s.close();
    for (const Waiting& program : waiting_)
        close(program.fd);
    waiting_.clear();
    reportLost();
}

// Returns why the modem cannot be used; empty: it can.
std::string Engine::prepareModem(const Settings& settings) {
    const U32 begin = clock_.nowUs();
    ModemSetup setup(serial_, settings, log_,
                     [this](int ms, bool forBytes) { return waitMs(ms, forBytes); });
    if (!settings.setUp) {
        serial_.setSpeed(settings.baud);
    } else if (!setup.run()) {
        return setup.trouble().empty() ? "the port '" + device_ + "' is lost" : setup.trouble();
    }
    std::lock_guard<std::mutex> lock(mutex_);
    U32 longest = setup.encrypts() ? LINK_MAX_ENCRYPTED : LINK_MAX_FRAME;
    pacer_ = FramePacer(settings.characterUs(), longest);
    pacer_.clear(clock_.nowUs());
    serialOut_.clear();
    Link_limitFrame(link_.get(), longest);
    api_.reset();
    if (setup.isApi())
        api_ = std::make_unique<ApiModem>(setup.escapes(), settings.target, setup.encrypts());
    Link_expectAnswers(link_.get(), setup.isApi());
    log_(1, "modem ready on " + device_ + " after " +
                std::to_string((clock_.nowUs() - begin) / 1000) + " ms" +
                (setup.isApi() ? ", in API mode" : "") + (setup.encrypts() ? ", it encrypts" : ""));
    return "";
}

// Runs the link again and again: a lost port or a silent modem is tried again for a program that
// connects or listens.
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

// Runs the link from an open port to a lost one. A modem that was reset in flight has its own
// settings again, since nothing is written to its memory. It looks like a silent peer. So the modem
// is set up again after a while, less and less often while nothing changes.
void Engine::fly(std::unique_lock<std::mutex>& lock) {
    const Settings settings = settings_;
    const U32 down = static_cast<U32>(settings.downMs) * 1000;
    patienceUs_ = down;
    try {
        if (failed_)
            serial_.open(device_);
    } catch (const std::system_error& e) {
        return fail(e.what());
    }
    // Keeps step: a simulator waits for this thread while it runs.
    struct Step {
        Step(Clock& c, int serial, const std::string& device) : clock(c) {
            clock.keepStep(serial, device);
        }
        ~Step() { clock.leaveStep(); }
        Clock& clock;
    } step(clock_, serial_.fd(), device_);
    for (bool first = true;; first = false) {
        lock.unlock();
        const std::string trouble = prepareModem(settings);
        lock.lock();
        if (stop_)
            return;
        if (!trouble.empty() && first)
            return fail(trouble + "; the next connection tries again");
        if (!trouble.empty())
            log_(0, trouble);
        failed_ = complained_ = false;
        Link_start(link_.get(), clock_.nowUs());
        upAt_ = clock_.nowUs();
        loop(lock);
        if (stop_ || failed_)
            return;
        log_(0, "no link for " + std::to_string((clock_.nowUs() - upAt_) / 1000000) +
                    " s: is the UAV on, in reach, and " +
                    (settings.keys.empty() ? "without a key as this side is" : "has it this key") +
                    "? Setting the modem up again");
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
    if (count > 0 && api_)
        api_->feed(
            bytes, static_cast<size_t>(count), now,
            [&](const U8* data, size_t size) {
                Link_receive(link_.get(), data, static_cast<U32>(size), now);
            },
            [&](bool isThere) { Link_answer(link_.get(), isThere, now); });
    else if (count > 0)
        Link_receive(link_.get(), bytes, static_cast<U32>(count), now);
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

// Ends a program's connection: `why` completes a sentence about it.
void Engine::end(int channel, int level, const std::string& why) {
    Stream& s = streams_[channel];
    log_(level, s.name() + " " + why + ": connection closed");
    s.close();
    Link_closeChannel(link_.get(), channel);
}

// Sends the next message of a program. True: it went to the link.
bool Engine::sendMessage(int channel, U32 now) {
    Stream& s = streams_[channel];
    if (!s.is(Stream::State::Open))
        return false;
    switch (s.next(LINK_MAX_MESSAGE)) {
    case Stream::Next::Senseless:
        end(channel, 0,
            "sent a message of " + std::to_string(s.size()) +
                " bytes, which does not fit the radio link (at most " +
                std::to_string(LINK_MAX_MESSAGE) + ")");
        return false;
    case Stream::Next::None:
        if (s.ended())
            end(channel, 1, "has ended");
        return false;
    case Stream::Next::Message:
        break;
    }
    const bool mustWait = full_ && s.size() > briefBytes;
    const Link_Status status =
        mustWait ? LINK_FULL : Link_send(link_.get(), channel, s.data(), s.size(), s.isCall());
    if (status == LINK_FULL) {
        if (!full_)
            turn_ = channel;
        full_ |= 1u << channel;
    } else if (status == LINK_OK) {
        late_[channel].push_back(s.lateAt());
        s.taken(now);
    } else
        end(channel, 1, "has no channel any more");
    return status == LINK_OK;
}

// Sends what the programs have written. They take turns, a message each, so that a flood leaves
// room for others. While one waits for room the others send only short ones, for which the link has
// a reserve.
void Engine::sendMessages(U32 now) {
    for (int idle = 0, channel = turn_; idle < LINK_CHANNELS; ++idle) {
        if (!full_)
            turn_ = (channel + 1) % LINK_CHANNELS;
        if (!(full_ >> channel & 1) && sendMessage(channel, now))
            idle = -1;
        channel = (channel + 1) % LINK_CHANNELS;
    }
}

void Engine::servePrograms(const std::vector<pollfd>& fds, U32 now) {
    for (size_t channel = 0; channel < LINK_CHANNELS; ++channel) {
        Stream& s = streams_[channel];
        s.write(now);
        const pollfd& p = fds[channel];
        if (p.fd >= 0 && p.fd == s.fd() && (p.events & POLLIN) && p.revents)
            s.read(now);
    }
    openWanted(now);
    sendMessages(now);
}

void Engine::openWanted(U32 now) {
    if (Link_state(link_.get()) != LINK_STATE_UP)
        return;
    for (int channel = 0; channel < ownChannels; ++channel)
        if (streams_[channel].is(Stream::State::Wanted) &&
            Link_openChannel(link_.get(), channel) == LINK_OK)
            streams_[channel].open(now);
}

// Logs the calls of programs that have left: nobody else can be told.
void Engine::reportLost() {
    if (lost_)
        log_(0, "calls of programs that have left, and may not have reached the UAV: " +
                    std::to_string(lost_));
    lost_ = 0;
}

// Withdraws what is late, so that nobody carries out what its caller has given up. Returns when to
// look again, in microseconds.
U32 Engine::withdrawLate(U32 now) {
    U32 wait = 0xFFFFFFFFu;
    const auto isLate = [&wait, now](U32 at) {
        const bool is = static_cast<int32_t>(at - now) <= 0;
        wait = std::min(wait, is ? 0 : at - now);
        return is;
    };
    for (int channel = 0; channel < LINK_CHANNELS; ++channel) {
        const Stream& s = streams_[channel];
        if (!late_[channel].empty() && isLate(late_[channel].front())) {
            log_(0, s.name() + " has a message that nobody took in time: the session ends");
            Link_stop(link_.get(), now);
            Link_start(link_.get(), now);
            return 0;
        }
        if (s.is(Stream::State::Open) && (full_ >> channel & 1) && isLate(s.lateAt()))
            end(channel, 0, "waits for room longer than its time-out");
    }
    return wait;
}

U32 Engine::beat(U32 now) {
    U32 wait = 0xFFFFFFFFu;
    for (Stream& s : streams_)
        wait = std::min(wait, s.beat(now));
    return wait;
}

// Moves bytes until the engine must stop, has failed, or the link has been down for too long.
void Engine::loop(std::unique_lock<std::mutex>& lock) {
    while (!stop_ && !failed_) {
        U32 now = clock_.nowUs();
        if (downTooLong(now))
            return;
        reportLost();
        placePrograms(now);
        Link_poll(link_.get(), now);
        const U32 late = withdrawLate(now);
        U32 deadline = std::min({late, Link_deadline(link_.get(), now), beat(now),
                                 pacer_.deadline(now), waiting_.empty() ? 0xFFFFFFFFu : lookUs});
        std::vector<pollfd> fds;
        for (Stream& s : streams_)
            fds.push_back(s.interest(!(full_ >> (&s - streams_) & 1)));
        fds.push_back(
            {serial_.fd(), static_cast<short>(serialOut_.empty() ? POLLIN : POLLIN | POLLOUT), 0});
        fds.push_back({wakePipe_[0], POLLIN, 0});
        const pollfd &serial = fds[LINK_CHANNELS], &wakes = fds[LINK_CHANNELS + 1];
        lock.unlock();
        clock_.wait(fds.data(), fds.size(), deadline);
        lock.lock();
        now = clock_.nowUs();
        if (wakes.revents) {
            char bytes[64];
            (void)!read(wakePipe_[0], bytes, sizeof bytes);
        }
        if (serial.revents & (POLLIN | POLLERR | POLLHUP))
            readSerial(now);
        writeSerial(now);
        servePrograms(fds, now);
    }
    if (!failed_) {
        Link_stop(link_.get(), clock_.nowUs());
        writeSerial(clock_.nowUs());
        reportLost();
    }
}

} // namespace XBeeAT
