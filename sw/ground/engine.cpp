// SPDX-License-Identifier: MIT
//
// engine: the calls of programs: connect, listen, statistics.

#include "engine.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <map>
#include <sys/socket.h>
#include <system_error>
#include <unistd.h>

namespace XBeeAT {

namespace {

std::mutex registryMutex;
std::map<std::string, std::weak_ptr<Engine>>& registry() {
    static std::map<std::string, std::weak_ptr<Engine>> engines;
    return engines;
}

void makePipe(int pipeEnds[2]) {
    if (pipe2(pipeEnds, O_CLOEXEC | O_NONBLOCK) != 0)
        throw std::system_error(errno, std::generic_category(), "pipe");
}

// Small buffers, so that back-pressure reaches the caller.
bool makePair(int ends[2]) {
    constexpr int bytes = 4096;
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends) != 0)
        return false;
    for (int end : {ends[0], ends[1]})
        setsockopt(end, SOL_SOCKET, SO_SNDBUF, &bytes, sizeof bytes);
    return true;
}

// Returns whether the program has closed its end and left no bytes to read.
bool hasLeft(int fd) {
    pollfd end{fd, POLLRDHUP, 0};
    char byte;
    return poll(&end, 1, 0) > 0 && recv(fd, &byte, 1, MSG_PEEK | MSG_DONTWAIT) <= 0;
}

} // namespace

std::shared_ptr<Engine> Engine::get(const Settings& settings, const Log& log) {
    std::lock_guard<std::mutex> lock(registryMutex);
    auto& engines = registry();
    for (auto it = engines.begin(); it != engines.end();)
        it = it->second.expired() ? engines.erase(it) : std::next(it);
    // A program with a key does not talk in the clear because another program was here before.
    auto shared = [&](std::shared_ptr<Engine> engine) {
        std::lock_guard<std::mutex> inner(engine->mutex_);
        if (engine->settings_.keys != settings.keys)
            throw std::system_error(EBUSY, std::generic_category(),
                                    "'" + engine->device_ +
                                        "' is in use with other keys: all who share a device give "
                                        "the same key file and address");
        if (engine->failed_ && !settings.device.empty())
            engine->settings_ = settings;
        return engine;
    };
    if (settings.device.empty()) {
        if (engines.size() == 1)
            if (auto engine = engines.begin()->second.lock())
                return shared(engine);
        throw std::system_error(
            ENODEV, std::generic_category(),
            "xbee-at endpoint without -d, XBeeAT.Device not set, and not exactly "
            "one device in use");
    }
    if (auto engine = engines[settings.device].lock())
        return shared(engine);
    std::shared_ptr<Engine> engine(new Engine(settings, log));
    engines[settings.device] = engine;
    return engine;
}

Engine::Engine(const Settings& settings, const Log& log)
    : device_(settings.device), settings_(settings), log_(log), link_(new Link),
      pacer_(settings.characterUs(), LINK_MAX_FRAME) {
    serial_.open(device_);
    makePipe(wakePipe_);
    makePipe(acceptPipe_);
    static const Link_Port port = {onTransmit, onRandom,  onMessage, onChannel,
                                   onState,    onOutcome, onWritable};
    Link_init(link_.get(), &port, this, static_cast<U32>(settings.characterUs() * 16));
    for (size_t slot = 0; slot < settings.keys.size(); ++slot)
        Link_setKey(link_.get(), static_cast<int>(slot), settings.keys[slot].data(),
                    LINK_GROUND | static_cast<U32>(settings.target));
    thread_ = std::thread([this] { run(); });
}

Engine::~Engine() {
    {
        std::lock_guard<std::mutex> lock(mutex_);
        stop_ = true;
    }
    wake();
    thread_.join();
    for (size_t slot = 0; slot < settings_.keys.size(); ++slot) {
        Link_setKey(link_.get(), static_cast<int>(slot), nullptr, LINK_GROUND);
        explicit_bzero(settings_.keys[slot].data(), settings_.keys[slot].size());
    }
    for (const Waiting& program : waiting_)
        close(program.fd);
    for (int fd : {wakePipe_[0], wakePipe_[1], acceptPipe_[0], acceptPipe_[1]})
        if (fd >= 0)
            close(fd);
}

void Engine::wake() {
    char byte = 0;
    (void)!write(wakePipe_[1], &byte, 1);
    changed_.notify_all();
}

// Returns a channel for a program, `wanted` or (-1) any: a free one, else that of the program that
// has been silent longest, if that is long enough to make room. -1 if there is none.
int Engine::freeChannel(int wanted, U32 now) {
    U32 longest = settings_.idleMs ? static_cast<U32>(settings_.idleMs) * 1000 - 1 : 0xFFFFFFFFu;
    int idlest = -1;
    for (int i = 0; i < ownChannels; ++i) {
        const int channel = wanted >= 0 ? wanted : (nextChannel_ + i) % ownChannels;
        Stream& s = streams_[channel];
        if (s.is(Stream::State::Wanted) && hasLeft(s.fd())) // it gave up before the link was up
            s.close();
        if (s.is(Stream::State::Closed)) {
            nextChannel_ = (channel + 1) % ownChannels;
            return channel;
        }
        if (s.silentUs(now) > longest) {
            longest = s.silentUs(now);
            idlest = channel;
        }
    }
    if (idlest >= 0) {
        streams_[idlest].sayGoodbye(now);
        end(idlest, 1, "is idle, and another program waits");
    }
    return idlest;
}

// Gives waiting programs a channel, in their order. One that has left gets none.
void Engine::placePrograms(U32 now) {
    for (auto program = waiting_.begin(); program != waiting_.end();) {
        const bool isGone = hasLeft(program->fd);
        const int channel = isGone ? -1 : freeChannel(program->channel, now);
        if (channel < 0 && !isGone) {
            ++program;
            continue;
        }
        log_(1, isGone ? "a program has left before it got a channel"
                       : "a program is connected, channel " + std::to_string(channel));
        if (isGone)
            ::close(program->fd);
        else
            streams_[channel].want(program->fd, "the program on channel " + std::to_string(channel),
                                   program->lateUs);
        program = waiting_.erase(program);
    }
}

int Engine::connect(int channel, int lateMs) {
    int ends[2];
    if (!makePair(ends))
        return -1;
    std::lock_guard<std::mutex> lock(mutex_);
    const U32 lateUs = static_cast<U32>(lateMs) < Stream::never / 1000
                           ? static_cast<U32>(lateMs) * 1000
                           : Stream::never;
    waiting_.push_back({ends[0], channel, lateUs});
    placePrograms(clock_.nowUs());
    wake();
    return ends[1];
}

size_t Engine::waiting() const {
    std::lock_guard<std::mutex> lock(mutex_);
    return waiting_.size();
}

bool Engine::isWanted() const {
    bool wanted = false;
    for (const Stream& s : streams_)
        wanted = wanted || s.is(Stream::State::Wanted);
    return wanted;
}

int Engine::listen() {
    std::lock_guard<std::mutex> lock(mutex_);
    if (listening_)
        return -1;
    listening_ = true;
    wake();
    return acceptPipe_[0];
}

int Engine::calledChannel() const {
    char byte;
    (void)!read(acceptPipe_[0], &byte, 1);
    for (int channel = ownChannels; channel < LINK_CHANNELS; ++channel)
        if (streams_[channel].is(Stream::State::Called))
            return channel;
    return -1;
}

int Engine::accept() {
    std::lock_guard<std::mutex> lock(mutex_);
    const int channel = calledChannel();
    int ends[2];
    if (channel < 0)
        return -1;
    if (!makePair(ends)) { // nobody answers the UAV
        log_(0, std::string("the UAV calls, and no socket can be made: ") + std::strerror(errno));
        end(channel, 1, "is refused");
        wake();
        return -1;
    }
    streams_[channel].accept(ends[0], "the program on channel " + std::to_string(channel));
    wake();
    return ends[1];
}

void Engine::stopListening() {
    std::lock_guard<std::mutex> lock(mutex_);
    listening_ = false;
}

std::string Engine::statistics() const {
    std::lock_guard<std::mutex> lock(mutex_);
    const Link_Statistics& s = *Link_statistics(link_.get());
    char text[320];
    std::snprintf(
        text, sizeof text,
        "%s: %u bytes in %u frames sent (%u sent again), %u bytes in %u frames received, "
        "%u messages out, %u in, round trip %.1f ms, %u sessions, %u bytes skipped, %u saved",
        device_.c_str(), s.bytesSent, s.framesSent, s.fragmentsResent, s.bytesReceived,
        s.framesReceived, s.messagesSent, s.messagesReceived, s.roundTripUs / 1000.0, s.sessions,
        s.bytesSkipped, s.headBytesSaved);
    return text;
}

} // namespace XBeeAT
