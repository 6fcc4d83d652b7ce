// SPDX-License-Identifier: MIT
//
// engine: the devices that are in use, and their peers.

#include "engine.h"

#include <cerrno>
#include <cstring>
#include <system_error>
#include <unistd.h>

namespace XBeeAT {

namespace {

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
        refuse(ENODEV, "xbee-at endpoint without -d, XBeeAT.Device not set, and not exactly "
                       "one device in use");
    if (!engine) {
        engine.reset(new Engine(settings, log));
        engines[settings.device] = engine;
    }
    return {engine, &engine->peer(settings)};
}

Peer& Engine::peer(const Settings& wanted) {
    std::lock_guard<std::mutex> lock(mutex);
    std::unique_ptr<Peer>& peer = peers_[wanted.target];
    // A program with a key does not talk in the clear because another program was here before.
    if (peer && peer->keys() != wanted.keys)
        refuse(EBUSY, "'" + device +
                          "' is in use with other keys: all who share a vehicle give the same key "
                          "file");
    if (failed_ && !wanted.device.empty())
        settings = wanted;
    if (peer)
        return *peer;
    if (peers_.size() > mostPeers) {
        peers_.erase(wanted.target);
        refuse(EBUSY, "'" + device + "' has " + std::to_string(mostPeers) +
                          " vehicles already, as many as a modem serves");
    }
    peer = std::make_unique<Peer>(static_cast<Host&>(*this), wanted.target, wanted.keys);
    peer->airUs = airUs_;
    hasMany = peers_.size() > 1;
    start(*peer);
    wake();
    return *peer;
}

Engine::Engine(const Settings& s, const Log& l) : Host(s, l, clock_) {
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

} // namespace XBeeAT
