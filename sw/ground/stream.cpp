// SPDX-License-Identifier: MIT
//
// stream: Ice messages between a socket and the link.

#include "stream.h"

#include <cerrno>
#include <sys/socket.h>
#include <unistd.h>

namespace XBeeAT {

namespace {

constexpr size_t bufferBytes = 4096, headerBytes = 14;
constexpr U32 noBeat = 0xFFFFFFFFu;
constexpr U32 heartbeatUs = 5000000; // below any sensible Ice.ACM.Timeout
constexpr U32 signUs = 10000000;     // Ice 3.8 cuts a connection on which nothing comes for 60 s
constexpr U32 leavingUs = 10000000;

// Message types and offsets of IceP: "The Ice Protocol" in the manual of ZeroC Ice.
enum MessageType { request = 0, batch = 1, reply = 2, validate = 3, closeConnection = 4 };
constexpr size_t typeAt = 8, sizeAt = 10, idAt = 14;

bool isOver(ssize_t count) {
    return count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR);
}

} // namespace

void Stream::want(int fd, const std::string& name, U32 lateUs) {
    close(State::Wanted);
    fd_ = fd;
    name_ = name;
    lateUs_ = lateUs;
}

void Stream::call() {
    close(State::Called);
    isServer_ = true;
}

void Stream::accept(int fd, const std::string& name) {
    state_ = State::Open;
    fd_ = fd;
    name_ = name;
}

void Stream::open(U32 nowUs) {
    state_ = State::Open;
    activeAt_ = nowUs;
}

unsigned Stream::leave(U32 nowUs) {
    unsigned unsent = 0;
    for (size_t had = ~size_t(0); fd_ >= 0 && !ended_ && had != out_.size(); read(nowUs))
        had = out_.size();
    for (; ended_ && next(0xFFFFFFFFu) == Next::Message; taken(nowUs))
        unsent += isCall();
    state_ = State::Leaving;
    leftAt_ = nowUs;
    write(nowUs);
    if (in_.empty())
        close();
    return unsent;
}

void Stream::close(State to) {
    if (fd_ >= 0)
        ::close(fd_);
    fd_ = -1;
    state_ = to;
    out_.clear();
    in_.clear();
    ended_ = isServer_ = greeted_ = owesSign_ = false;
    pending_ = 0;
    lateUs_ = never;
}

pollfd Stream::interest(bool reads) const {
    const bool wantsIn = reads && is(State::Open) && !ended_;
    const int events = (wantsIn ? POLLIN : 0) | (in_.empty() ? 0 : POLLOUT);
    return {events ? fd_ : -1, static_cast<short>(events), 0};
}

U32 Stream::messageSize() const {
    const U8* p = out_.data() + sizeAt;
    return static_cast<U32>(p[0]) | static_cast<U32>(p[1]) << 8 | static_cast<U32>(p[2]) << 16 |
           static_cast<U32>(p[3]) << 24;
}

void Stream::read(U32 nowUs) {
    U8 bytes[bufferBytes];
    ssize_t count = recv(fd_, bytes, sizeof bytes, 0);
    if (out_.empty())
        since_ = nowUs;
    readAt_ = nowUs;
    if (count > 0)
        out_.insert(out_.end(), bytes, bytes + count);
    ended_ = isOver(count);
    if (out_.size() >= headerBytes && out_.size() >= messageSize()) { // a part is no activity
        if (!owesSign_)
            owesSince_ = nowUs;
        owesSign_ = true;
        if (out_[typeAt] != validate)
            activeAt_ = nowUs;
    }
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

bool Stream::isCall() const {
    return out_[typeAt] == request || out_[typeAt] == batch;
}

Stream::Kind Stream::kind() const {
    if (out_[typeAt] != request || out_.size() < idAt + 4)
        return out_[typeAt] == closeConnection ? Kind::Goodbye : Kind::Other;
    const bool hasId = out_[idAt] | out_[idAt + 1] | out_[idAt + 2] | out_[idAt + 3];
    return hasId ? Kind::Twoway : Kind::Oneway;
}

void Stream::taken(U32 nowUs) {
    if (kind() == Kind::Twoway && pending_++ == 0)
        heardAt_ = nowUs;
    out_.erase(out_.begin(), out_.begin() + messageSize());
    since_ = readAt_;
}

bool Stream::give(const U8* message, U32 size, U32 nowUs) {
    if (in_.size() + size > mostUnread)
        return false;
    in_.insert(in_.end(), message, message + size);
    heardAt_ = nowUs;
    owesSign_ = false;
    if (size > typeAt && message[typeAt] == reply && pending_)
        --pending_;
    write(nowUs);
    return true;
}

void Stream::write(U32 nowUs) {
    if (fd_ < 0 || in_.empty())
        return;
    ssize_t count = send(fd_, in_.data(), in_.size(), MSG_NOSIGNAL);
    if (count > 0) {
        in_.erase(in_.begin(), in_.begin() + count);
        activeAt_ = nowUs;
    } else if (isOver(count)) {
        in_.clear();
    }
    if (is(State::Leaving) && in_.empty())
        close();
}

U32 Stream::beat(U32 nowUs) {
    if (is(State::Leaving)) {
        if (nowUs - leftAt_ < leavingUs)
            return leavingUs - (nowUs - leftAt_);
        close();
    }
    if (!is(State::Open) || !(pending_ || owesSign_))
        return noBeat;
    const U32 since = nowUs - (pending_ ? heardAt_ : owesSince_);
    const U32 limit = pending_ ? heartbeatUs : signUs;
    if (since < limit)
        return limit - since;
    pollfd end{fd_, POLLRDHUP, 0};
    if (in_.empty() && poll(&end, 1, 0) == 0) { // it has not ended its writing
        const U32 activeAt = activeAt_;
        (void)giveHead(validate, nowUs);
        activeAt_ = activeAt;
    }
    return 100000u;
}

U32 Stream::silentUs(U32 nowUs) const {
    return is(State::Open) && !pending_ ? nowUs - activeAt_ : 0;
}

bool Stream::giveHead(U8 type, U32 nowUs) {
    const U8 head[headerBytes] = {'I', 'c', 'e', 'P', 1, 0, 1, 0, type, 0, headerBytes};
    return give(head, headerBytes, nowUs);
}

void Stream::sayGoodbye(U32 nowUs) {
    (void)giveHead(closeConnection, nowUs);
}

void Stream::greet(U32 nowUs) {
    (void)giveHead(validate, nowUs);
}

void Stream::refuse(const std::string& why, U32 nowUs) {
    constexpr U8 unknownLocalException = 5;
    std::vector<U8> answer = {'I', 'c', 'e', 'P', 1, 0, 1, 0, reply, 0, 0, 0, 0, 0};
    answer.insert(answer.end(), out_.begin() + idAt, out_.begin() + idAt + 4);
    answer.push_back(unknownLocalException);
    answer.push_back(static_cast<U8>(why.size()));
    answer.insert(answer.end(), why.begin(), why.end());
    answer[sizeAt] = static_cast<U8>(answer.size());
    taken(nowUs);
    (void)give(answer.data(), static_cast<U32>(answer.size()), nowUs);
}

} // namespace XBeeAT
