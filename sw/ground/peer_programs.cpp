// SPDX-License-Identifier: MIT
//
// peer_programs: the functions of a peer that programs call. Each program calls them in its own
// thread.

#include "peer.h"

#include "clock.h"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace XBeeAT {

namespace {

// Creates two connected sockets with small buffers, so that back-pressure reaches the caller.
bool makePair(int ends[2]) {
    constexpr int bytes = 4096;
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0, ends) != 0)
        return false;
    for (int end : {ends[0], ends[1]})
        setsockopt(end, SOL_SOCKET, SO_SNDBUF, &bytes, sizeof bytes);
    return true;
}

// Returns whether the program has closed its side and has left no bytes to read.
bool hasLeft(int fd) {
    pollfd end{fd, POLLRDHUP, 0};
    char byte;
    return poll(&end, 1, 0) > 0 && recv(fd, &byte, 1, MSG_PEEK | MSG_DONTWAIT) <= 0;
}

} // namespace

// Returns a channel for a program: `wanted`, or any channel if `wanted` is -1. Prefers a free
// channel. If no channel is free, takes the channel of the program that has been silent longest,
// provided that this program has been silent long enough. Otherwise returns -1.
int Peer::freeChannel(int wanted, U32 now) {
    U32 longest =
        host_.settings.idleMs ? static_cast<U32>(host_.settings.idleMs) * 1000 - 1 : 0xFFFFFFFFu;
    int idlest = -1;
    for (int i = 0; i < ownChannels; ++i) {
        const int channel = wanted >= 0 ? wanted : (nextChannel_ + i) % ownChannels;
        ProgramConnection& s = programs_[channel];
        if (s.is(ProgramConnection::State::Wanted) &&
            hasLeft(s.fd())) // the program has disconnected before its channel was opened
            s.close();
        if (s.is(ProgramConnection::State::Closed)) {
            nextChannel_ = (channel + 1) % ownChannels;
            return channel;
        }
        if (s.silentUs(now) > longest) {
            longest = s.silentUs(now);
            idlest = channel;
        }
    }
    if (idlest >= 0) {
        programs_[idlest].sayGoodbye(now);
        end(idlest, 1, "is idle, and another program waits for a channel");
    }
    return idlest;
}

// Assigns channels to waiting programs in the order of their arrival. A program that has
// disconnected gets no channel.
void Peer::placePrograms(U32 now) {
    for (auto program = waiting_.begin(); program != waiting_.end();) {
        const bool isGone = hasLeft(program->fd);
        const int channel = isGone ? -1 : freeChannel(program->channel, now);
        if (channel < 0 && !isGone) {
            ++program;
            continue;
        }
        log(1, isGone ? "a program has disconnected before it got a channel"
                      : "a program is connected, channel " + std::to_string(channel));
        if (isGone)
            ::close(program->fd);
        else
            programs_[channel].want(
                program->fd, "the program on channel " + std::to_string(channel), program->lateUs);
        program = waiting_.erase(program);
    }
}

int Peer::connect(int channel, int lateMs) {
    int ends[2];
    std::lock_guard<std::mutex> lock(host_.mutex);
    if (isYielded())
        errno = EBUSY;
    if (isYielded() || !makePair(ends))
        return -1;
    const U32 lateUs = static_cast<U32>(lateMs) < ProgramConnection::never / 1000
                           ? static_cast<U32>(lateMs) * 1000
                           : ProgramConnection::never;
    waiting_.push_back({ends[0], channel, lateUs});
    placePrograms(host_.clock.nowUs());
    host_.wake();
    return ends[1];
}

size_t Peer::waiting() const {
    std::lock_guard<std::mutex> lock(host_.mutex);
    return waiting_.size();
}

bool Peer::isWanted() const {
    bool wanted = false;
    for (const ProgramConnection& s : programs_)
        wanted = wanted || s.is(ProgramConnection::State::Wanted);
    return wanted;
}

int Peer::listen() {
    std::lock_guard<std::mutex> lock(host_.mutex);
    if (listening_)
        return -1;
    listening_ = true;
    host_.wake();
    return acceptPipe_[0];
}

int Peer::calledChannel() const {
    char byte;
    (void)!read(acceptPipe_[0], &byte, 1);
    for (int channel = ownChannels; channel < LINK_CHANNELS; ++channel)
        if (programs_[channel].is(ProgramConnection::State::Called))
            return channel;
    return -1;
}

int Peer::accept() {
    std::lock_guard<std::mutex> lock(host_.mutex);
    const int channel = calledChannel();
    int ends[2];
    if (channel < 0)
        return -1;
    if (!makePair(ends)) { // the system has no socket left, so no program can reply to the UAV
        log(0, std::string("cannot accept a call of the UAV: no socket can be made: ") +
                   std::strerror(errno));
        end(channel, 1, "is refused");
        host_.wake();
        return -1;
    }
    programs_[channel].accept(ends[0], "the program on channel " + std::to_string(channel));
    host_.wake();
    return ends[1];
}

void Peer::stopListening() {
    std::lock_guard<std::mutex> lock(host_.mutex);
    listening_ = false;
}

} // namespace XBeeAT
