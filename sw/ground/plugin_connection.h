// SPDX-License-Identifier: MIT
//
// plugin_connection: the data that the endpoints of one communicator share (defaults, logger,
// peers), and the connections that Ice opens to the UAV or accepts from it. Ice reads and writes
// each connection as a socket.

#pragma once

#include "engine.h"

#include <Ice/Acceptor.h>
#include <Ice/Buffer.h>
#include <Ice/Connection.h>
#include <Ice/Connector.h>
#include <Ice/EndpointI.h>
#include <Ice/Ice.h>
#include <Ice/Network.h>
#include <Ice/Transceiver.h>
#include <cerrno>
#include <chrono>
#include <deque>
#include <mutex>
#include <set>
#include <string>
#include <sys/socket.h>
#include <system_error>
#include <unistd.h>

namespace XBeeAT {

// types of the two endpoint factories; encoded endpoints of both protocols have the type
// endpointType
constexpr Ice::Short endpointType = 0x4158, wireType = 0x4159;
inline const std::string protocolName = "xbee-at", wireName = "serial";
constexpr Ice::Int defaultTimeoutMs = 30000; // long, because the set-up of a modem takes seconds

struct EndpointOptions {
    Settings serial;
    int channel = 255; // channel of the link; 255: any channel
    Ice::Int timeoutMs = defaultTimeoutMs;
    std::string connectionId;
    bool compress = false;
};

// Checks a modem key. Error messages never contain the key.
inline void checkModemKey(const std::string& key, const std::string& where) {
    if (key.size() > 32 || key.find_first_not_of("0123456789abcdefABCDEF") != std::string::npos)
        throw Ice::EndpointParseException(__FILE__, __LINE__,
                                          "the AES key of " + where +
                                              ": expected at most 32 hexadecimal digits");
}

// Data shared by the endpoints.
class Instance : public IceUtil::Shared {
public:
    explicit Instance(const Ice::CommunicatorPtr& communicator) : communicator_(communicator) {
        Ice::PropertiesPtr p = communicator->getProperties();
        trace_ = p->getPropertyAsInt("XBeeAT.Trace");
        statistics_ = p->getPropertyAsInt("XBeeAT.Statistics") > 0;
        defaults_.serial.device = p->getProperty("XBeeAT.Device");
        defaults_.serial.baud = p->getPropertyAsIntWithDefault("XBeeAT.Baud", 115200);
        defaults_.serial.guardMs = p->getPropertyAsIntWithDefault("XBeeAT.Guard", 1000);
        defaults_.serial.modemKey = p->getProperty("XBeeAT.ModemKey");
        checkModemKey(defaults_.serial.modemKey, "property XBeeAT.ModemKey");
        const std::string keyFile = p->getProperty("XBeeAT.KeyFile");
        try {
            if (!keyFile.empty())
                keys_ = KeyFile(keyFile);
        } catch (const std::runtime_error& e) {
            throw Ice::PluginInitializationException(__FILE__, __LINE__,
                                                     std::string("xbee-at: ") + e.what());
        }
        defaults_.serial.downMs = 1000 * p->getPropertyAsIntWithDefault("XBeeAT.Down", 15);
        defaults_.serial.idleMs = 1000 * p->getPropertyAsIntWithDefault("XBeeAT.Idle", 60);
        defaults_.serial.isApi = p->getPropertyAsIntWithDefault("XBeeAT.Api", 1) > 0;
        defaults_.serial.setUp = p->getPropertyAsIntWithDefault("XBeeAT.Setup", 1) > 0;
    }
    const EndpointOptions& defaults() const { return defaults_; }

    // Returns the peer with these options. Several threads may call this function: one may request
    // a connection while another destroys the communicator.
    std::shared_ptr<Peer> peer(const EndpointOptions& o) {
        std::lock_guard<std::mutex> lock(mutex_);
        if (!communicator_)
            throw Ice::CommunicatorDestroyedException(__FILE__, __LINE__);
        Ice::LoggerPtr logger = communicator_->getLogger();
        int trace = trace_;
        try {
            Settings settings = o.serial;
            settings.keys = keys_.of(settings.target);
            auto peer = Engine::get(settings, [logger, trace](int level, const std::string& text) {
                if (level < 0)
                    logger->print("xbee-at: " + text);
                else if (level == 0)
                    logger->error("xbee-at: " + text);
                else if (level <= trace)
                    logger->trace("XBeeAT", text);
            });
            peers_.insert(peer);
            return peer;
        } catch (const std::system_error& e) {
            logger->error(std::string("xbee-at: ") + e.what());
            throw Ice::ConnectFailedException(__FILE__, __LINE__, e.code().value());
        } catch (const std::runtime_error& e) {
            logger->error(std::string("xbee-at: ") + e.what());
            throw Ice::ConnectFailedException(__FILE__, __LINE__, EACCES);
        }
    }
    // Keeps a closed connection of Ice for a minute. Ice 3.7 does not count the reference of a
    // time-out to its connection (TimeoutCallback in ConnectionI.cpp). If a time-out expires at the
    // moment at which its connection is closed for another reason, Ice's timer thread would
    // otherwise use a freed connection. `connection` is the callback of Ice's thread pool, which
    // has a counted reference to the connection.
    void keep(const IceInternal::ReadyCallbackPtr& connection) {
        std::deque<Closed> expired; // freed after the lock is released
        std::lock_guard<std::mutex> lock(mutex_);
        const auto now = std::chrono::steady_clock::now();
        for (; !closed_.empty() && now - closed_.front().at > closedFor; closed_.pop_front())
            expired.push_back(closed_.front());
        if (communicator_ && connection)
            closed_.push_back({now, connection});
    }
    // Ice has ended its timer when it calls this function.
    void destroy() {
        std::deque<Closed> closed; // freed after the lock is released
        std::lock_guard<std::mutex> lock(mutex_);
        closed.swap(closed_);
        for (const auto& peer : peers_)
            if (statistics_)
                communicator_->getLogger()->print("xbee-at: " + peer->statistics());
        peers_.clear();
        communicator_ = ICE_NULLPTR;
    }

private:
    static constexpr std::chrono::minutes closedFor{1};
    struct Closed {
        std::chrono::steady_clock::time_point at;
        IceInternal::ReadyCallbackPtr connection;
    };

    std::mutex mutex_; // guards communicator_, peers_ and closed_
    Ice::CommunicatorPtr communicator_;
    EndpointOptions defaults_;
    KeyFile keys_;
    int trace_ = 0;
    bool statistics_ = false;
    // peers stay until the communicator is destroyed, because setting up a modem takes time
    std::set<std::shared_ptr<Peer>> peers_;
    std::deque<Closed> closed_; // the connection that was closed first comes first
};
typedef IceUtil::Handle<Instance> InstancePtr;

class Transceiver : public IceInternal::Transceiver, public IceInternal::NativeInfo {
public:
    Transceiver(const InstancePtr& instance, const std::shared_ptr<Peer>& peer, int fd)
        : IceInternal::NativeInfo(fd), instance_(instance), peer_(peer) {}
    IceInternal::NativeInfoPtr getNativeInfo() override { return this; }
    IceInternal::SocketOperation initialize(IceInternal::Buffer&, IceInternal::Buffer&) override {
        // Ice waits for the first message of the peer, at most for the connect time-out. This
        // message shows that the link is up.
        return IceInternal::SocketOperationNone;
    }
    IceInternal::SocketOperation closing(bool initiator, const Ice::LocalException&) override {
        return initiator ? IceInternal::SocketOperationRead : IceInternal::SocketOperationNone;
    }
    void close() override {
        ::close(_fd);
        _fd = INVALID_SOCKET;
        instance_->keep(_readyCallback);
    }
    IceInternal::SocketOperation write(IceInternal::Buffer& buf) override {
        while (buf.i != buf.b.end()) {
            ssize_t count =
                ::send(_fd, &*buf.i, static_cast<size_t>(buf.b.end() - buf.i), MSG_NOSIGNAL);
            if (count > 0)
                buf.i += count;
            else if (errno == EAGAIN)
                return IceInternal::SocketOperationWrite;
            else if (errno != EINTR)
                lost();
        }
        return IceInternal::SocketOperationNone;
    }
    IceInternal::SocketOperation read(IceInternal::Buffer& buf) override {
        while (buf.i != buf.b.end()) {
            ssize_t count = ::recv(_fd, &*buf.i, static_cast<size_t>(buf.b.end() - buf.i), 0);
            if (count > 0) {
                buf.i += count;
                heard_ = true;
            } else if (count < 0 && errno == EAGAIN)
                return IceInternal::SocketOperationRead;
            else if (count == 0 || errno != EINTR)
                lost();
        }
        return IceInternal::SocketOperationNone;
    }
    std::string protocol() const override { return protocolName; }
    std::string toString() const override { return protocolName + " " + peer_->device(); }
    std::string toDetailedString() const override { return toString(); }
    Ice::ConnectionInfoPtr getInfo() const override { return ICE_MAKE_SHARED(Ice::ConnectionInfo); }
    void checkSendSize(const IceInternal::Buffer& buf) override {
        const size_t most = peer_->mostBytes();
        if (buf.b.size() > most)
            throw Ice::MemoryLimitException(__FILE__, __LINE__,
                                            std::string("message too long for ") +
                                                peer_->carrierName() + " (at most " +
                                                std::to_string(most) + " bytes)");
    }
    void setBufferSize(int, int) override {}

private:
    [[noreturn]] void lost() {
        if (heard_)
            throw Ice::ConnectionLostException(__FILE__, __LINE__, 0);
        throw Ice::ConnectFailedException(__FILE__, __LINE__, ENOLINK);
    }
    InstancePtr instance_;
    std::shared_ptr<Peer> peer_;
    bool heard_ = false;
};

using IceInternal::EndpointIPtr;

class Connector : public IceInternal::Connector {
public:
    Connector(const InstancePtr& instance, const EndpointOptions& options)
        : instance_(instance), options_(options) {}
    IceInternal::TransceiverPtr connect() override {
        auto peer = instance_->peer(options_);
        int fd = peer->connect(options_.channel == 255 ? -1 : options_.channel, options_.timeoutMs);
        if (fd < 0) // no descriptor is left
            throw Ice::ConnectFailedException(__FILE__, __LINE__, errno);
        return new Transceiver(instance_, peer, fd);
    }
    Ice::Short type() const override { return endpointType; }
    std::string toString() const override { return options_.serial.device; }
    bool operator==(const IceInternal::Connector& other) const override {
        const Connector* o = dynamic_cast<const Connector*>(&other);
        return o && key() == o->key();
    }
    bool operator<(const IceInternal::Connector& other) const override {
        const Connector* o = dynamic_cast<const Connector*>(&other);
        return o ? key() < o->key() : type() < other.type();
    }

private:
    std::string key() const {
        return options_.serial.device + " " + std::to_string(options_.serial.target) + " " +
               std::to_string(options_.channel) + " " + std::to_string(options_.timeoutMs) + " " +
               options_.connectionId;
    }
    InstancePtr instance_;
    EndpointOptions options_;
};

class Acceptor : public IceInternal::Acceptor, public IceInternal::NativeInfo {
public:
    Acceptor(const InstancePtr& instance, const EndpointOptions& options,
             const EndpointIPtr& endpoint)
        : instance_(instance), peer_(instance->peer(options)), endpoint_(endpoint) {}
    IceInternal::NativeInfoPtr getNativeInfo() override { return this; }
    void close() override {
        if (_fd != INVALID_SOCKET)
            peer_->stopListening();
        _fd = INVALID_SOCKET;
    }
    EndpointIPtr listen() override {
        _fd = peer_->listen();
        if (_fd < 0)
            throw Ice::SocketException(__FILE__, __LINE__, EADDRINUSE);
        return endpoint_;
    }
    IceInternal::TransceiverPtr accept() override {
        int fd = peer_->accept();
        if (fd < 0)
            throw Ice::SocketException(__FILE__, __LINE__, EAGAIN);
        return new Transceiver(instance_, peer_, fd);
    }
    std::string protocol() const override { return protocolName; }
    std::string toString() const override { return protocolName + " " + peer_->device(); }
    std::string toDetailedString() const override { return toString(); }

private:
    InstancePtr instance_;
    std::shared_ptr<Peer> peer_;
    EndpointIPtr endpoint_;
};

} // namespace XBeeAT
