// SPDX-License-Identifier: MIT
//
// stream: Ice messages between a socket and the link.

#include "stream.h"

#include <algorithm>
#include <cerrno>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace XBeeAT {

namespace {

constexpr int bufferBytes = 4096; // of the socket: small, so that back-pressure reaches the caller
constexpr size_t headerBytes = 14;

// Of IceP's header: "The Ice Protocol" in the manual of ZeroC Ice.
enum MessageType { request = 0, batch = 1, reply = 2, validate = 3 };
constexpr size_t sizeAt = 10, typeAt = 8, idAt = 14;
constexpr U32 heartbeatUs = 5000000; // below any sensible Ice.ACM.Timeout

bool isOver(ssize_t count) {
    return count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR);
}

} // namespace

int Stream::open(bool isServer) {
    close();
    int ends[2];
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends) != 0)
        return -1;
    for (int end : ends)
        setsockopt(end, SOL_SOCKET, SO_SNDBUF, &bufferBytes, sizeof bufferBytes);
    fd_ = ends[0];
    isServer_ = isServer;
    return ends[1];
}

void Stream::close() {
    if (fd_ >= 0)
        ::close(fd_);
    fd_ = -1;
    out_.clear();
    in_.clear();
    wanted = stuck = isServer_ = greeted_ = false;
    pending_ = 0;
}

bool Stream::isLeft() const {
    pollfd waiting{fd_, 0, 0};
    return poll(&waiting, 1, 0) > 0;
}

U32 Stream::messageSize() const {
    const U8* p = out_.data() + sizeAt;
    return static_cast<U32>(p[0]) | static_cast<U32>(p[1]) << 8 | static_cast<U32>(p[2]) << 16 |
           static_cast<U32>(p[3]) << 24;
}

bool Stream::read() {
    U8 bytes[bufferBytes];
    ssize_t count = recv(fd_, bytes, sizeof bytes, 0);
    if (count > 0)
        out_.insert(out_.end(), bytes, bytes + count);
    return !isOver(count);
}

Stream::Next Stream::next(U32 longest) {
    while (out_.size() >= headerBytes) {
        U32 size = messageSize();
        if (size < headerBytes || size > longest)
            return Next::Senseless;
        if (out_.size() < size)
            return Next::None;
        if (out_[typeAt] != validate)
            return Next::Message;
        bool first = isServer_ && !greeted_;
        greeted_ = true;
        if (first)
            return Next::Message;
        out_.erase(out_.begin(), out_.begin() + size);
    }
    return Next::None;
}

void Stream::taken(U32 nowUs) {
    bool wantsReply = out_[typeAt] == request && out_.size() >= idAt + 4 &&
                      (out_[idAt] | out_[idAt + 1] | out_[idAt + 2] | out_[idAt + 3]);
    if (wantsReply && pending_++ == 0)
        heardAt_ = nowUs;
    out_.erase(out_.begin(), out_.begin() + messageSize());
}

bool Stream::give(const U8* message, U32 size, U32 nowUs) {
    if (!in_.empty())
        return false;
    in_.assign(message, message + size);
    heardAt_ = nowUs;
    if (size > typeAt && message[typeAt] == reply && pending_)
        --pending_;
    write();
    return true;
}

void Stream::write() {
    if (fd_ < 0 || in_.empty())
        return;
    ssize_t count = send(fd_, in_.data(), in_.size(), MSG_NOSIGNAL);
    if (count > 0)
        in_.erase(in_.begin(), in_.begin() + count);
    else if (isOver(count))
        in_.clear();
}

U32 Stream::beat(U32 nowUs) {
    static const U8 heartbeat[headerBytes] = {'I', 'c', 'e', 'P', 1, 0, 1, 0, validate, 0, 14};
    if (fd_ < 0 || wanted || !pending_)
        return 0xFFFFFFFFu;
    if (nowUs - heardAt_ >= heartbeatUs)
        (void)give(heartbeat, headerBytes, nowUs);
    U32 since = nowUs - heardAt_;
    return since < heartbeatUs ? heartbeatUs - since : 100000u;
}

} // namespace XBeeAT
