// SPDX-License-Identifier: MIT
//
// program_connection: transfers Ice messages between a socket and the link.

#include "program_connection.h"
#include "ice_header.h"

#include <cerrno>
#include <sys/socket.h>
#include <unistd.h>

namespace XBeeAT {

namespace {

constexpr size_t bufferBytes = 4096;
constexpr U32 noBeat = 0xFFFFFFFFu;
// interval of heartbeats during a call, us; shorter than any sensible Ice.ACM.Timeout
constexpr U32 heartbeatUs = 5000000;
// interval of heartbeats without a call, us; needed because Ice 3.8 closes a connection after 60 s
// without traffic
constexpr U32 signUs = 10000000;
constexpr U32 leavingUs = 10000000;

bool isOver(ssize_t count) {
    return count == 0 || (count < 0 && errno != EAGAIN && errno != EINTR);
}

} // namespace

void ProgramConnection::want(int fd, const std::string& name, U32 lateUs) {
    close(State::Wanted);
    fd_ = fd;
    name_ = name;
    lateUs_ = lateUs;
}

void ProgramConnection::call() {
    close(State::Called);
    isServer_ = true;
}

void ProgramConnection::accept(int fd, const std::string& name) {
    state_ = State::Open;
    fd_ = fd;
    name_ = name;
}

void ProgramConnection::open(U32 nowUs) {
    state_ = State::Open;
    activeAt_ = nowUs;
}

unsigned ProgramConnection::leave(U32 nowUs) {
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

void ProgramConnection::close(State to) {
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

pollfd ProgramConnection::interest(bool reads) const {
    const bool wantsIn = reads && is(State::Open) && !ended_;
    const int events = (wantsIn ? POLLIN : 0) | (in_.empty() ? 0 : POLLOUT);
    return {events ? fd_ : -1, static_cast<short>(events), 0};
}

U32 ProgramConnection::messageSize() const {
    return IceHeader::sizeOf(out_.data());
}

void ProgramConnection::read(U32 nowUs) {
    U8 bytes[bufferBytes];
    ssize_t count = recv(fd_, bytes, sizeof bytes, 0);
    if (out_.empty())
        since_ = nowUs;
    readAt_ = nowUs;
    if (count > 0)
        out_.insert(out_.end(), bytes, bytes + count);
    ended_ = isOver(count);
    // an incomplete message does not count as activity
    if (out_.size() >= IceHeader::bytes && out_.size() >= messageSize()) {
        if (!owesSign_)
            owesSince_ = nowUs;
        owesSign_ = true;
        if (IceHeader::typeOf(out_.data()) != IceHeader::Validate)
            activeAt_ = nowUs;
    }
}

ProgramConnection::Next ProgramConnection::next(U32 longest) {
    while (out_.size() >= IceHeader::bytes) {
        U32 size = messageSize();
        if (size < IceHeader::bytes || size > longest)
            return Next::Senseless;
        if (out_.size() < size)
            return Next::None;
        if (IceHeader::typeOf(out_.data()) != IceHeader::Validate)
            return Next::Message;
        bool first = isServer_ && !greeted_;
        greeted_ = true;
        if (first)
            return Next::Message;
        out_.erase(out_.begin(), out_.begin() + size);
    }
    return Next::None;
}

bool ProgramConnection::isCall() const {
    const U8 type = IceHeader::typeOf(out_.data());
    return type == IceHeader::Request || type == IceHeader::Batch;
}

ProgramConnection::Kind ProgramConnection::kind() const {
    const U8 type = IceHeader::typeOf(out_.data());
    if (type != IceHeader::Request || out_.size() < IceHeader::requestIdAt + 4)
        return type == IceHeader::CloseConnection ? Kind::Goodbye : Kind::Other;
    return IceHeader::get32(out_.data() + IceHeader::requestIdAt) ? Kind::Twoway : Kind::Oneway;
}

void ProgramConnection::taken(U32 nowUs) {
    if (kind() == Kind::Twoway && pending_++ == 0)
        heardAt_ = nowUs;
    out_.erase(out_.begin(), out_.begin() + messageSize());
    since_ = readAt_;
}

bool ProgramConnection::give(const U8* message, U32 size, U32 nowUs) {
    if (in_.size() + size > mostUnread)
        return false;
    in_.insert(in_.end(), message, message + size);
    heardAt_ = nowUs;
    owesSign_ = false;
    if (size >= IceHeader::bytes && IceHeader::typeOf(message) == IceHeader::Reply && pending_)
        --pending_;
    write(nowUs);
    return true;
}

void ProgramConnection::write(U32 nowUs) {
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

U32 ProgramConnection::beat(U32 nowUs) {
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
    // the program has read everything and has not closed its side
    if (in_.empty() && poll(&end, 1, 0) == 0) {
        const U32 activeAt = activeAt_;
        (void)giveHead(IceHeader::Validate, nowUs);
        activeAt_ = activeAt;
    }
    return 100000u;
}

U32 ProgramConnection::silentUs(U32 nowUs) const {
    return is(State::Open) && !pending_ ? nowUs - activeAt_ : 0;
}

bool ProgramConnection::giveHead(U8 type, U32 nowUs) {
    return give(IceHeader::pack(type).data(), IceHeader::bytes, nowUs);
}

void ProgramConnection::sayGoodbye(U32 nowUs) {
    (void)giveHead(IceHeader::CloseConnection, nowUs);
}

void ProgramConnection::greet(U32 nowUs) {
    (void)giveHead(IceHeader::Validate, nowUs);
}

void ProgramConnection::refuse(const std::string& why, U32 nowUs) {
    constexpr U8 unknownLocalException = 5;
    const auto id = out_.begin() + IceHeader::requestIdAt;
    std::vector<U8> body(id, id + 4);
    body.push_back(unknownLocalException);
    body.push_back(static_cast<U8>(why.size()));
    body.insert(body.end(), why.begin(), why.end());
    const std::vector<U8> answer = IceHeader::pack(IceHeader::Reply, body);
    taken(nowUs);
    (void)give(answer.data(), static_cast<U32>(answer.size()), nowUs);
}

} // namespace XBeeAT
