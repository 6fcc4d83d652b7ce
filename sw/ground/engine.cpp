// SPDX-License-Identifier: MIT
//
// engine: manages the devices in use. Each device has an engine with one thread, which serves the
// serial port, its modem, and the peers in turn.

#include "engine.h"
#include "broadcast_peer.h"
#include "modem_setup.h"
#include "vehicle_peer.h"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <poll.h>
#include <system_error>
#include <unistd.h>

namespace XBeeAT {

namespace {

// intervals of two repeated attempts, while programs listen but no program connects: to open a lost
// port, and to set up a modem that does not answer
constexpr std::chrono::seconds reopenEvery{1}, retryEvery{5};

std::mutex registryMutex;
std::map<std::string, std::weak_ptr<Engine>>& registry() {
    static std::map<std::string, std::weak_ptr<Engine>> engines;
    return engines;
}

[[noreturn]] void refuse(int code, const std::string& why) {
    throw std::system_error(code, std::generic_category(), why);
}

} // namespace

std::shared_ptr<Peer> Engine::get(const Settings& settings, const Log& log) {
    std::lock_guard<std::mutex> lock(registryMutex);
    auto& engines = registry();
    for (auto it = engines.begin(); it != engines.end();)
        it = it->second.expired() ? engines.erase(it) : std::next(it);
    std::shared_ptr<Engine> engine;
    if (!settings.device.empty())
        engine = engines[settings.device].lock();
    else if (engines.size() == 1)
        engine = engines.begin()->second.lock();
    if (!engine && settings.device.empty())
        refuse(ENODEV, "no serial port: expected option -d of the xbee-at endpoint, or property "
                       "XBeeAT.Device, unless exactly one port is in use");
    if (!engine) {
        engine.reset(new Engine(settings, log));
        engines[settings.device] = engine;
    }
    return {engine, &engine->peer(settings)};
}

Peer& Engine::peer(const Settings& wanted) {
    std::lock_guard<std::mutex> lock(mutex);
    std::unique_ptr<Peer>& peer = peers_[wanted.target];
    // A program with other keys is refused. Otherwise a program with a key could use the
    // unencrypted peer that an earlier program has created.
    if (peer && peer->keys() != wanted.keys)
        refuse(EBUSY, "'" + device +
                          "' is in use with other keys: programs that share a vehicle must use the "
                          "same key file");
    if (failed_ && !wanted.device.empty())
        settings = wanted;
    if (peer)
        return *peer;
    if (peers_.size() > mostPeers) {
        peers_.erase(wanted.target);
        refuse(EBUSY, "'" + device + "' has " + std::to_string(mostPeers) +
                          " vehicles already, which is the limit of a modem");
    }
    Host& host = *this;
    if (wanted.target == everybody)
        peer = std::make_unique<BroadcastPeer>(host, wanted.keys);
    else
        peer = std::make_unique<VehiclePeer>(host, wanted.target, wanted.keys);
    packets_.join(*peer);
    hasMany = peers_.size() > 1;
    start(*peer);
    wake();
    return *peer;
}

Engine::Engine(const Settings& s, const Log& l) : Host(s, l, makeClock(), packets_) {
    serial_.open(device);
    makePipe(wakePipe_);
    thread_ = std::thread([this] { run(); });
}

Engine::~Engine() {
    {
        std::lock_guard<std::mutex> lock(mutex);
        stop_ = true;
    }
    wake();
    thread_.join();
    peers_.clear();
    for (LinkKey& key : settings.keys)
        explicit_bzero(key.data(), key.size());
    for (int fd : wakePipe_)
        close(fd);
}

void Engine::wake() {
    char byte = 0;
    (void)!write(wakePipe_[1], &byte, 1);
    changed_.notify_all();
}

// ---- set-up and failures of the modem ----

int Engine::waitMs(int ms, bool forBytes) {
    // A lost serial port also ends the wait. This is necessary when the simulator has ended,
    // because simulated time then no longer advances.
    pollfd fds[] = {{wakePipe_[0], POLLIN, 0},
                    {serial_.fd(), static_cast<short>(forBytes ? POLLIN : 0), 0}};
    const U32 begin = clock.nowUs(), us = static_cast<U32>(ms) * 1000;
    for (;;) {
        {
            std::lock_guard<std::mutex> lock(mutex);
            if (stop_)
                return -1;
        }
        U32 passed = clock.nowUs() - begin;
        if (passed >= us || (fds[1].revents & POLLIN))
            return static_cast<int>(passed);
        char bytes[64];
        if (clock.wait(fds, 2, us - passed) > 0 && fds[0].revents)
            (void)!read(wakePipe_[0], bytes, sizeof bytes);
        if (fds[1].revents & ~POLLIN)
            return -1;
    }
}

// Ends all connections and pending connects, because the port or the modem is lost. If the same
// failure repeats, logs only the first one as an error.
void Engine::fail(const std::string& text) {
    log(complaint_ == text ? 1 : 0, text);
    complaint_ = text;
    failed_ = true;
    longest_ = 0;
    for (auto& [address, peer] : peers_)
        peer->fail();
}

// Returns the reason why the modem cannot be used; an empty text if it can be used.
std::string Engine::prepareModem(const Settings& wanted) {
    const U32 begin = clock.nowUs();
    ModemSetup setup(serial_, wanted, log,
                     [this](int ms, bool forBytes) { return waitMs(ms, forBytes); });
    if (!wanted.setUp) {
        serial_.setSpeed(wanted.baud);
    } else if (!setup.run()) {
        return setup.trouble().empty() ? "serial port '" + device + "' was closed during the set-up"
                                       : setup.trouble();
    }
    std::lock_guard<std::mutex> lock(mutex);
    longest_ = setup.encrypts() ? LINK_MAX_ENCRYPTED : LINK_MAX_FRAME;
    packets_.start(setup.isApi(), setup.escapes(), wanted.target);
    log(1, "modem ready on " + device + " after " + std::to_string((clock.nowUs() - begin) / 1000) +
               " ms" + (setup.isApi() ? ", in API mode" : "") +
               (setup.encrypts() ? ", with encryption" : ""));
    return "";
}

// Starts connecting to a peer, if the modem is ready and can reach the peer.
void Engine::start(Peer& peer) {
    if (longest_ && packets_.reaches(peer, peer.hasLink()))
        peer.start(longest_, packets_.isApi(), clock.nowUs());
}

bool Engine::any(bool (Peer::*is)() const) const {
    return std::any_of(peers_.begin(), peers_.end(),
                       [is](const auto& p) { return (*p.second.*is)(); });
}

// Runs the links. If the port is lost or the modem does not answer, sets the modem up again as
// long as a program wants to connect or listens.
void Engine::run() {
    std::unique_lock<std::mutex> lock(mutex);
    while (!stop_) {
        if (failed_) {
            // If a USB adapter is plugged in again while its old device is still open, the device
            // gets another name.
            if (serial_.isGone())
                serial_.close();
            waitForReason(lock);
        }
        if (!stop_)
            fly(lock);
    }
}

void Engine::waitForReason(std::unique_lock<std::mutex>& lock) {
    auto reason = [this] { return stop_ || any(&Peer::isWanted); };
    if (!any(&Peer::listens))
        changed_.wait(lock, [&] { return reason() || any(&Peer::listens); });
    else
        changed_.wait_for(lock, serial_.fd() < 0 ? reopenEvery : retryEvery, reason);
}

// Runs the links until the port is lost. A modem that is reset during operation loses the settings
// of the set-up, because these are not stored in the modem. This program then only notices that the
// peer is silent. After some time of silence, it therefore sets the modem up again. If the peer is
// still silent, it doubles this time, up to four times the configured time.
void Engine::fly(std::unique_lock<std::mutex>& lock) {
    const Settings wanted = settings;
    const U32 down = static_cast<U32>(wanted.downMs) * 1000;
    downLimitUs_ = down;
    try {
        if (failed_)
            serial_.open(device);
    } catch (const std::system_error& e) {
        return fail(e.what());
    }
    // While an object of this type exists, simulated time waits for this thread.
    struct Step {
        Step(Clock& c, int serial, const std::string& device) : clock(c) {
            clock.keepStep(serial, device);
        }
        ~Step() { clock.leaveStep(); }
        Clock& clock;
    } step(clock, serial_.fd(), device);
    for (bool first = true;; first = false) {
        lock.unlock();
        const std::string trouble = prepareModem(wanted);
        lock.lock();
        if (stop_)
            return;
        if (!trouble.empty() && first)
            return fail(trouble + "; the next connection will try again");
        if (!trouble.empty())
            log(0, trouble);
        if (!complaint_.empty())
            log(-1, "serial port '" + device + "' is in use again");
        complaint_.clear();
        failed_ = false;
        for (auto& [address, peer] : peers_)
            start(*peer);
        upAt_ = clock.nowUs();
        loop(lock);
        if (stop_ || failed_)
            return;
        log(0, "no link for " + std::to_string((clock.nowUs() - upAt_) / 1000000) +
                   " s: check that the UAV is on, in range, and " +
                   (wanted.keys.empty() ? "has no key, like this side" : "has the same key") +
                   ". Configuring the modem again");
        downLimitUs_ = std::min(downLimitUs_ * 2, 4 * down);
    }
}

bool Engine::downTooLong(U32 now) {
    if (any(&Peer::isHeard) || !any(&Peer::hasLink)) {
        upAt_ = now;
        downLimitUs_ = static_cast<U32>(settings.downMs) * 1000;
    }
    return settings.setUp && now - upAt_ >= downLimitUs_;
}

// ---- bytes ----

void Engine::readSerial(U32 now) {
    const ssize_t count = packets_.read(
        [&](int source, const U8* data, size_t size) { deliver(source, data, size, now); },
        [&](bool isThere) { answer(isThere, now); });
    if (count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR))
        fail("serial port '" + device + "' has disappeared (" +
             (count == 0 ? "closed" : std::strerror(errno)) +
             "): check its cable. Opening it is retried");
}

// Passes received bytes to the peer with the address `source`. Bytes from a modem without a 16-bit
// address are passed on only if there is a single peer.
void Engine::deliver(int source, const U8* bytes, size_t size, U32 now) {
    for (auto& [address, peer] : peers_)
        if (address == source || (source == ApiFrames::noAddress && !hasMany))
            peer->receive(bytes, size, now);
}

// Passes the modem's result for a packet to the links, which share one list of packets without a
// result. The modem reports no result for packets to all vehicles.
void Engine::answer(bool isThere, U32 now) {
    if (radio)
        Link_answer(radio, isThere, now);
}

// Polls all peers, starting with the peer that has used the least air time. Returns the time until
// the next call, in microseconds.
U32 Engine::pollPeers(U32 now) {
    std::vector<Peer*> order;
    for (auto& [address, peer] : peers_)
        order.push_back(peer.get());
    std::sort(order.begin(), order.end(),
              [](const Peer* a, const Peer* b) { return a->airUs < b->airUs; });
    U32 wait = 0xFFFFFFFFu;
    for (Peer* peer : order) {
        if (!packets_.reaches(*peer, peer->hasLink()) && peer->isWanted()) {
            log(0,
                "the modem on '" + device + "' has no API mode, so it can reach only one vehicle");
            peer->fail();
        }
        wait = std::min(wait, peer->poll(now));
    }
    return wait;
}

// Moves bytes between port and peers until the engine must stop, has failed, or all links have been
// down for too long.
void Engine::loop(std::unique_lock<std::mutex>& lock) {
    while (!stop_ && !failed_) {
        U32 now = clock.nowUs();
        if (downTooLong(now))
            return;
        packets_.expire(now, [&](bool isThere) { answer(isThere, now); });
        const U32 deadline = pollPeers(now);
        std::vector<pollfd> fds = {
            {wakePipe_[0], POLLIN, 0},
            {serial_.fd(), static_cast<short>(packets_.isFlushed() ? POLLIN : POLLIN | POLLOUT),
             0}};
        // iterates over a copy, because another peer may be added while this thread waits
        std::vector<Peer*> served;
        for (auto& [address, peer] : peers_) {
            served.push_back(peer.get());
            peer->addInterest(fds);
        }
        lock.unlock();
        clock.wait(fds.data(), fds.size(), deadline);
        lock.lock();
        now = clock.nowUs();
        if (fds[0].revents) {
            char bytes[64];
            (void)!read(wakePipe_[0], bytes, sizeof bytes);
        }
        if (fds[1].revents & (POLLIN | POLLERR | POLLHUP))
            readSerial(now);
        packets_.flush();
        for (size_t i = 0; i < served.size(); ++i)
            served[i]->servePrograms(&fds[2 + i * LINK_CHANNELS], now);
    }
    if (!failed_)
        for (auto& [address, peer] : peers_)
            peer->stop(clock.nowUs());
    packets_.flush();
}

} // namespace XBeeAT
