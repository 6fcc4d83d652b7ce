// SPDX-License-Identifier: MIT
//
// plugin_connector: lets Ice open connections and accept those of the UAV.

#pragma once

#include "plugin_transceiver.h"

#include <Ice/Acceptor.h>
#include <Ice/Connector.h>
#include <Ice/EndpointI.h>

namespace XBeeAT {

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
        return new Transceiver(peer, fd);
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
        : peer_(instance->peer(options)), endpoint_(endpoint) {}
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
        return new Transceiver(peer_, fd);
    }
    std::string protocol() const override { return protocolName; }
    std::string toString() const override { return protocolName + " " + peer_->device(); }
    std::string toDetailedString() const override { return toString(); }

private:
    std::shared_ptr<Peer> peer_;
    EndpointIPtr endpoint_;
};

} // namespace XBeeAT
