// SPDX-License-Identifier: MIT
//
// engine: the thread: serial port, link, streams to the program.

#include "engine.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <map>
#include <poll.h>
#include <random>
#include <sys/socket.h>
#include <system_error>
#include <unistd.h>

namespace XBeeAT {

namespace {

constexpr int ownChannels = 3; // 0..2 are opened by the ground, 3 by the UAV
constexpr int streamBytes =
    4096; // buffer of a stream: small, so that back-pressure reaches the caller
constexpr size_t headerBytes = 14;

std::mutex registryMutex;
std::map<std::string, std::weak_ptr<Engine>>& registry() {
    static std::map<std::string, std::weak_ptr<Engine>> engines;
    return engines;
}

void makePipe(int pipeEnds[2]) {
    if (pipe2(pipeEnds, O_CLOEXEC | O_NONBLOCK) != 0)
        throw std::system_error(errno, std::generic_category(), "pipe");
}

// Of IceP's header: "The Ice Protocol" in the manual of ZeroC Ice.
enum MessageType { request = 0, batch = 1, reply = 2, validate = 3 };
constexpr size_t typeAt = 8, idAt = 14;
constexpr U32 heartbeatUs = 5000000; // below any sensible Ice.ACM.Timeout

U32 messageSize(const std::vector<U8>& head) {
    return static_cast<U32>(head[10]) | static_cast<U32>(head[11]) << 8 |
           static_cast<U32>(head[12]) << 16 | static_cast<U32>(head[13]) << 24;
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
    if (auto engine = engines[settings.device].lock())
        if (!engine->failed_)
            return engine;
    std::shared_ptr<Engine> engine(new Engine(settings, log));
    engines[settings.device] = engine;
    return engine;
}

Engine::Engine(const Settings& settings, const Log& log)
    : settings_(settings), log_(log), link_(new Link),
      pacer_(1e7 / (settings.baud == 115200 ? 111111 : settings.baud), LINK_MAX_FRAME) {
    serial_ = open(settings.device.c_str(), O_RDWR | O_NOCTTY | O_NONBLOCK | O_CLOEXEC);
    if (serial_ < 0)
        throw std::system_error(errno, std::generic_category(),
                                "cannot open serial port '" + settings.device + "'");
    makePipe(wakePipe_);
    makePipe(acceptPipe_);
    static const Link_Port port = {onTransmit, onRandom, onMessage, onChannel,
                                   onState,    nullptr,  onWritable};
    Link_init(link_.get(), &port, this, 1440);
    thread_ = std::thread([this] { run(); });
}

Engine::~Engine() {
    {
        std::lock_guard<std::mutex> lock(mutex_);
        stop_ = true;
    }
    wake();
    thread_.join();
    for (int fd : {serial_, wakePipe_[0], wakePipe_[1], acceptPipe_[0], acceptPipe_[1]})
        close(fd);
    for (int fd : accepted_)
        close(fd);
}

void Engine::wake() {
    char byte = 0;
    (void)!write(wakePipe_[1], &byte, 1);
}

int Engine::newPair(int& programEnd) {
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends) != 0)
        return -1;
    for (int end : ends)
        setsockopt(end, SOL_SOCKET, SO_SNDBUF, &streamBytes, sizeof streamBytes);
    programEnd = ends[1];
    return ends[0];
}

int Engine::connect(int channel) {
    std::lock_guard<std::mutex> lock(mutex_);
    if (failed_)
        return -1;
    for (int i = 0; i < ownChannels; ++i) { // who gave up before the link was up
        pollfd waiting{channels_[i].fd, 0, 0};
        if (channels_[i].wanted && poll(&waiting, 1, 0) > 0)
            closeChannel(i);
    }
    int chosen = -1;
    for (int i = 0; i < ownChannels && chosen < 0; ++i) {
        int candidate = channel >= 0 ? channel : (nextChannel_ + i) % ownChannels;
        if (candidate < ownChannels && channels_[candidate].fd < 0)
            chosen = candidate;
    }
    if (chosen < 0)
        return -1;
    nextChannel_ = (chosen + 1) % ownChannels;
    int programEnd = -1;
    Channel& c = channels_[chosen];
    c = Channel();
    c.fd = newPair(programEnd);
    c.wanted = true;
    wake();
    return programEnd;
}

int Engine::listen() {
    std::lock_guard<std::mutex> lock(mutex_);
    if (listening_)
        return -1;
    listening_ = true;
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

bool Engine::hasFailed() const {
    std::lock_guard<std::mutex> lock(mutex_);
    return failed_;
}

std::string Engine::statistics() const {
    std::lock_guard<std::mutex> lock(mutex_);
    const Link_Statistics& s = *Link_statistics(link_.get());
    char text[320];
    std::snprintf(
        text, sizeof text,
        "%s: %u bytes in %u frames sent (%u sent again), %u bytes in %u frames received, "
        "%u messages out, %u in, round trip %.1f ms, %u sessions, %u bytes skipped, %u saved",
        settings_.device.c_str(), s.bytesSent, s.framesSent, s.fragmentsResent, s.bytesReceived,
        s.framesReceived, s.messagesSent, s.messagesReceived, s.roundTripUs / 1000.0, s.sessions,
        s.bytesSkipped, s.headBytesSaved);
    return text;
}

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
    Channel& c = self(context).channels_[channel];
    if (c.fd < 0)
        return 0; // the program has closed: nobody wants it
    if (!c.in.empty())
        return 1; // the program is slow: the link holds the rest back
    c.in.assign(data, data + size);
    c.heardAt = self(context).clock_.nowUs();
    if (size > typeAt && data[typeAt] == reply && c.pending)
        --c.pending;
    self(context).writeProgram(channel);
    return 0;
}

void Engine::onChannel(void* context, int channel, int isOpen) {
    Engine& e = self(context);
    if (!isOpen) {
        Channel& c = e.channels_[channel];
        if (c.fd >= 0 && !c.wanted)
            e.closeChannel(channel);
        return;
    }
    int programEnd = -1;
    if (channel < ownChannels || !e.listening_) {
        e.log_(1, "the peer opened channel " + std::to_string(channel) + ", and nobody listens");
        Link_closeChannel(e.link_.get(), channel, e.clock_.nowUs());
        return;
    }
    e.closeChannel(channel);
    e.channels_[channel] = Channel();
    e.channels_[channel].fd = e.newPair(programEnd);
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
    for (int channel = 0; channel < LINK_CHANNELS; ++channel)
        if (!e.channels_[channel].wanted)
            e.closeChannel(channel);
}

void Engine::onWritable(void* context) {
    for (Channel& c : self(context).channels_)
        c.stuck = false;
}

// ---- the thread ----

void Engine::closeChannel(int channel) {
    Channel& c = channels_[channel];
    if (c.fd >= 0)
        close(c.fd);
    c = Channel();
}

void Engine::fail(const std::string& text) {
    log_(0, text);
    failed_ = true;
    for (int channel = 0; channel < LINK_CHANNELS; ++channel)
        closeChannel(channel);
}

bool Engine::prepareModem() {
    if (settings_.setUp && !setUpModem()) {
        std::unique_lock<std::mutex> lock(mutex_);
        if (stop_)
            return false;
        lock.unlock();
        log_(0, "no modem answers on '" + settings_.device +
                    "': check its power and cable, the guard time (-g), or set XBeeAT.Setup=0 if "
                    "it must "
                    "not be set up");
        return false;
    }
    if (!settings_.setUp)
        setSpeed(settings_.baud);
    log_(1, "modem ready on " + settings_.device);
    return true;
}

// A modem that was reset in flight has its own settings again (nothing is written to its memory).
// It looks like a peer that is silent: so after a while the modem is set up once more, and less and
// less often while nothing changes.
void Engine::run() {
    bool ready = prepareModem();
    std::unique_lock<std::mutex> lock(mutex_);
    if (!ready && !stop_)
        fail("the modem on '" + settings_.device + "' is given up");
    patienceUs_ = static_cast<U32>(settings_.downMs) * 1000;
    pacer_.clear(clock_.nowUs());
    if (!stop_ && !failed_)
        Link_start(link_.get(), clock_.nowUs());
    while (!stop_ && !failed_) {
        upAt_ = clock_.nowUs();
        loop(lock);
        if (stop_ || failed_)
            break;
        lock.unlock();
        log_(1, "the link is down: setting the modem up again");
        ready = prepareModem();
        lock.lock();
        serialOut_.clear();
        pacer_.clear(clock_.nowUs());
        patienceUs_ = std::min(patienceUs_ * 2, static_cast<U32>(settings_.downMs) * 4000);
    }
}

bool Engine::downTooLong(U32 now) {
    if (Link_state(link_.get()) == LINK_STATE_UP) {
        upAt_ = now;
        patienceUs_ = static_cast<U32>(settings_.downMs) * 1000;
    }
    return settings_.setUp && now - upAt_ >= patienceUs_;
}

void Engine::readSerial(U32 now) {
    U8 bytes[512];
    ssize_t count = read(serial_, bytes, sizeof bytes);
    if (count > 0)
        Link_receive(link_.get(), bytes, static_cast<U32>(count), 0, now);
    else if (count == 0 || (errno != EAGAIN && errno != EINTR))
        fail("serial port '" + settings_.device +
             "': " + (count == 0 ? "closed" : std::strerror(errno)));
}

void Engine::writeSerial(U32 now) {
    if (serialOut_.empty())
        serialOut_ = pacer_.due(now);
    if (serialOut_.empty())
        return;
    ssize_t count = write(serial_, serialOut_.data(), serialOut_.size());
    if (count > 0)
        serialOut_.erase(serialOut_.begin(), serialOut_.begin() + count);
}

void Engine::writeProgram(int channel) {
    Channel& c = channels_[channel];
    if (c.fd < 0 || c.in.empty())
        return;
    ssize_t count = send(c.fd, c.in.data(), c.in.size(), MSG_NOSIGNAL);
    if (count > 0)
        c.in.erase(c.in.begin(), c.in.begin() + count);
    else if (count < 0 && errno != EAGAIN && errno != EINTR)
        c.in.clear();
}

// Whole messages from the program's stream to the link. False: the stream makes no sense.
bool Engine::sendMessages(int channel, U32 now) {
    Channel& c = channels_[channel];
    while (c.out.size() >= headerBytes && !c.wanted) {
        U32 size = messageSize(c.out);
        if (size < headerBytes || size > LINK_MAX_MESSAGE) {
            log_(0, "a message of " + std::to_string(size) +
                        " bytes does not fit the radio link (at "
                        "most " +
                        std::to_string(LINK_MAX_MESSAGE) + "): connection closed");
            return false;
        }
        if (c.out.size() < size)
            return true;
        if (isHeartbeat(channel)) {
            c.out.erase(c.out.begin(), c.out.begin() + size);
            continue;
        }
        Link_Status status = Link_send(link_.get(), channel, c.out.data(), size, 0, now);
        if (status == LINK_FULL)
            c.stuck = true;
        if (status != LINK_OK)
            return status == LINK_FULL;
        noteSent(c);
        c.out.erase(c.out.begin(), c.out.begin() + size);
    }
    return true;
}

// The link itself knows whether the peer is there, so Ice's heartbeats need not cross it. What is
// not one is the greeting of a server, the first message of a connection that the UAV has opened.
bool Engine::isHeartbeat(int channel) {
    Channel& c = channels_[channel];
    if (c.out[typeAt] != validate)
        return false;
    bool first = channel >= ownChannels && !c.greeted;
    c.greeted = true;
    return !first;
}

void Engine::noteSent(Channel& c) {
    bool wantsReply = c.out[typeAt] == request && c.out.size() >= idAt + 4 &&
                      (c.out[idAt] | c.out[idAt + 1] | c.out[idAt + 2] | c.out[idAt + 3]);
    if (wantsReply && c.pending++ == 0)
        c.heardAt = clock_.nowUs();
}

// While a program waits for an answer and the peer is there, the program gets heartbeats from here:
// as a server that runs long would send them, but without air. Returns when to come again.
U32 Engine::beat(U32 now) {
    static const U8 heartbeat[headerBytes] = {'I', 'c', 'e', 'P', 1, 0, 1, 0, validate, 0, 14};
    U32 wait = 0xFFFFFFFFu;
    for (int channel = 0; channel < LINK_CHANNELS; ++channel) {
        Channel& c = channels_[channel];
        if (c.fd < 0 || c.wanted || !c.pending)
            continue;
        if (now - c.heardAt >= heartbeatUs && c.in.empty()) {
            c.in.assign(heartbeat, heartbeat + headerBytes);
            c.heardAt = now;
            writeProgram(channel);
        }
        wait = std::min(wait,
                        now - c.heardAt < heartbeatUs ? heartbeatUs - (now - c.heardAt) : 100000u);
    }
    return wait;
}

void Engine::readProgram(int channel, U32 now) {
    Channel& c = channels_[channel];
    U8 bytes[4096];
    ssize_t count = recv(c.fd, bytes, sizeof bytes, 0);
    if (count > 0)
        c.out.insert(c.out.end(), bytes, bytes + count);
    bool closed = count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR);
    if (sendMessages(channel, now) && !closed)
        return;
    Link_closeChannel(link_.get(), channel, now);
    closeChannel(channel);
}

void Engine::openWanted(U32 now) {
    if (Link_state(link_.get()) != LINK_STATE_UP)
        return;
    for (int channel = 0; channel < ownChannels; ++channel)
        if (channels_[channel].wanted && Link_openChannel(link_.get(), channel, now) == LINK_OK)
            channels_[channel].wanted = false;
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
            {serial_, static_cast<short>(serialOut_.empty() ? POLLIN : POLLIN | POLLOUT), 0},
            {wakePipe_[0], POLLIN, 0}};
        for (Channel& c : channels_) {
            short events = static_cast<short>((c.stuck || c.wanted ? 0 : POLLIN) |
                                              (c.in.empty() ? 0 : POLLOUT));
            fds.push_back({c.wanted ? -1 : c.fd, events, 0});
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
            if (p.fd < 0 || p.fd != channels_[channel].fd)
                continue;
            writeProgram(channel);
            if (p.revents & (POLLIN | POLLHUP | POLLERR))
                readProgram(channel, now);
            else if (!channels_[channel].stuck && !channels_[channel].out.empty())
                readProgram(channel, now);
        }
    }
    if (!failed_) {
        Link_stop(link_.get(), clock_.nowUs());
        writeSerial(clock_.nowUs());
    }
}

} // namespace XBeeAT
