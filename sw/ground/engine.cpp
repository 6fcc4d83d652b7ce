// SPDX-License-Identifier: MIT
//
// engine: what programs call: connect, listen, statistics.

#include "engine.h"

#include <cerrno>
#include <cstdio>
#include <fcntl.h>
#include <map>
#include <system_error>
#include <unistd.h>

namespace XBeeAT {

namespace {

constexpr int ownChannels = 3; // 0..2 are opened by the ground, 3 by the UAV

std::mutex registryMutex;
std::map<std::string, std::weak_ptr<Engine>>& registry() {
    static std::map<std::string, std::weak_ptr<Engine>> engines;
    return engines;
}

void makePipe(int pipeEnds[2]) {
    if (pipe2(pipeEnds, O_CLOEXEC | O_NONBLOCK) != 0)
        throw std::system_error(errno, std::generic_category(), "pipe");
}

} // namespace

std::shared_ptr<Engine> Engine::get(const Settings& settings, const Log& log) {
    std::lock_guard<std::mutex> lock(registryMutex);
    auto& engines = registry();
    for (auto it = engines.begin(); it != engines.end();)
        it = it->second.expired() ? engines.erase(it) : std::next(it);
    if (settings.device.empty()) {
        if (engines.size() == 1)
            if (auto engine = engines.begin()->second.lock())
                return engine;
        throw std::system_error(
            ENODEV, std::generic_category(),
            "xbee-at endpoint without -d, XBeeAT.Device not set, and not exactly "
            "one device in use");
    }
    if (auto engine = engines[settings.device].lock()) {
        std::lock_guard<std::mutex> inner(engine->mutex_);
        if (engine->failed_)
            engine->settings_ = settings;
        return engine;
    }
    std::shared_ptr<Engine> engine(new Engine(settings, log));
    engines[settings.device] = engine;
    return engine;
}

Engine::Engine(const Settings& settings, const Log& log)
    : device_(settings.device), settings_(settings), log_(log), link_(new Link),
      pacer_(settings.characterUs(), LINK_MAX_FRAME) {
    if (!serial_.open(device_))
        throw std::system_error(errno, std::generic_category(),
                                "cannot open serial port '" + device_ + "'");
    makePipe(wakePipe_);
    makePipe(acceptPipe_);
    static const Link_Port port = {onTransmit, onRandom, onMessage, onChannel,
                                   onState,    nullptr,  onWritable};
    Link_init(link_.get(), &port, this, static_cast<U32>(settings.characterUs() * 16));
    thread_ = std::thread([this] { run(); });
}

Engine::~Engine() {
    {
        std::lock_guard<std::mutex> lock(mutex_);
        stop_ = true;
    }
    wake();
    thread_.join();
    for (int fd : {wakePipe_[0], wakePipe_[1], acceptPipe_[0], acceptPipe_[1]})
        if (fd >= 0)
            close(fd);
    for (int fd : accepted_)
        close(fd);
}

void Engine::wake() {
    char byte = 0;
    (void)!write(wakePipe_[1], &byte, 1);
    changed_.notify_all();
}

int Engine::connect(int channel) {
    std::lock_guard<std::mutex> lock(mutex_);
    for (int i = 0; i < ownChannels; ++i) // who gave up before the link was up
        if (streams_[i].wanted && streams_[i].isLeft())
            streams_[i].close();
    int chosen = -1;
    for (int i = 0; i < ownChannels && chosen < 0; ++i) {
        int candidate = channel >= 0 ? channel : (nextChannel_ + i) % ownChannels;
        if (candidate < ownChannels && !streams_[candidate].isOpen())
            chosen = candidate;
    }
    if (chosen < 0)
        return -1;
    nextChannel_ = (chosen + 1) % ownChannels;
    int programEnd = streams_[chosen].open(false);
    streams_[chosen].wanted = programEnd >= 0;
    wake();
    return programEnd;
}

bool Engine::isWanted() const {
    bool wanted = false;
    for (const Stream& s : streams_)
        wanted = wanted || s.wanted;
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

int Engine::accept() {
    std::lock_guard<std::mutex> lock(mutex_);
    char byte;
    (void)!read(acceptPipe_[0], &byte, 1);
    if (accepted_.empty())
        return -1;
    int fd = accepted_.front();
    accepted_.pop_front();
    return fd;
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
