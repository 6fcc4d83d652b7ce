// SPDX-License-Identifier: MIT
//
// plugin_transceiver: a connection, as Ice sees it: the program's end of a stream.

#pragma once

#include "engine.h"
#include "plugin_instance.h"

#include <Ice/Buffer.h>
#include <Ice/Connection.h>
#include <Ice/Network.h>
#include <Ice/Transceiver.h>
#include <cerrno>
#include <sys/socket.h>
#include <unistd.h>

namespace XBeeAT {

class Transceiver : public IceInternal::Transceiver, public IceInternal::NativeInfo {
public:
    Transceiver(const std::shared_ptr<Peer>& peer, int fd)
        : IceInternal::NativeInfo(fd), peer_(peer) {}
    IceInternal::NativeInfoPtr getNativeInfo() override { return this; }
    IceInternal::SocketOperation initialize(IceInternal::Buffer&, IceInternal::Buffer&) override {
        // Ice waits for the peer's first message next, under the connect time-out: that is "link
        // up".
        return IceInternal::SocketOperationNone;
    }
    IceInternal::SocketOperation closing(bool initiator, const Ice::LocalException&) override {
        return initiator ? IceInternal::SocketOperationRead : IceInternal::SocketOperationNone;
    }
    void close() override {
        ::close(_fd);
        _fd = INVALID_SOCKET;
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
            throw Ice::MemoryLimitException(
                __FILE__, __LINE__,
                std::string("message too long for ") +
                    (peer_->isAll() ? "one packet to all vehicles" : "the radio link") +
                    " (at most " + std::to_string(most) + " bytes)");
    }
    void setBufferSize(int, int) override {}

private:
    [[noreturn]] void lost() {
        if (heard_)
            throw Ice::ConnectionLostException(__FILE__, __LINE__, 0);
        throw Ice::ConnectFailedException(__FILE__, __LINE__, ENOLINK);
    }
    std::shared_ptr<Peer> peer_;
    bool heard_ = false;
};

} // namespace XBeeAT
