// SPDX-License-Identifier: MIT
//
// peer: passes messages from the programs' connections to the vehicle. Its functions run in the
// engine's thread.

#include "peer.h"

#include "clock.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <system_error>
#include <unistd.h>

namespace XBeeAT {

namespace {

constexpr U32 never = 0xFFFFFFFFu;
// interval between searches for a free channel while programs wait, us
constexpr U32 lookUs = 50000;

} // namespace

void makePipe(int pipeEnds[2]) {
    if (pipe2(pipeEnds, O_CLOEXEC | O_NONBLOCK) != 0)
        throw std::system_error(errno, std::generic_category(), "cannot create a pipe");
}

Peer::Peer(Host& host, int address, const LinkKeys& keys)
    : Sender(address), host_(host), keys_(keys) {
    makePipe(acceptPipe_);
}

Peer::~Peer() {
    for (LinkKey& key : keys_)
        explicit_bzero(key.data(), key.size());
    for (const Waiting& program : waiting_)
        close(program.fd);
    for (int fd : acceptPipe_)
        close(fd);
}

void Peer::log(int level, const std::string& text) const {
    char vehicle[16] = "";
    if (host_.hasMany)
        std::snprintf(vehicle, sizeof vehicle, "0x%04X: ", static_cast<unsigned>(address()));
    host_.log(level, vehicle + text);
}

void Peer::end(int channel, int level, const std::string& why) {
    ProgramConnection& program = programs_[channel];
    log(level, program.name() + " " + why + ": connection closed");
    program.close();
    closeChannel(channel);
}

void Peer::fail() {
    stop(host_.clock.nowUs());
    for (ProgramConnection& program : programs_)
        program.close();
    refusePrograms();
}

void Peer::refusePrograms() {
    for (ProgramConnection& program : programs_)
        if (program.is(ProgramConnection::State::Wanted))
            program.close();
    for (const Waiting& program : waiting_)
        close(program.fd);
    waiting_.clear();
}

// Records that a program's message waits because the link has no room.
void Peer::waitForRoom(int channel) {
    if (!full_)
        turn_ = channel;
    full_ |= 1u << channel;
}

// Passes the next message of a program to the link. Returns whether the link accepted the message.
bool Peer::sendMessage(int channel, U32 now) {
    ProgramConnection& program = programs_[channel];
    if (!program.is(ProgramConnection::State::Open))
        return false;
    const U32 most = longestMessage();
    switch (program.next(most)) {
    case ProgramConnection::Next::Senseless:
        end(channel, 0,
            "sent a message of " + std::to_string(program.size()) + " bytes, too long for " +
                carrierName() + " (at most " + std::to_string(most) + ")");
        return false;
    case ProgramConnection::Next::None:
        if (program.ended())
            end(channel, 1, "has ended");
        return false;
    case ProgramConnection::Next::Message:
        break;
    }
    return send(channel, now);
}

// Passes on the programs' messages, one message of each program in turn, so that a program that
// floods the link leaves room for others. While a message waits for room, other programs may only
// send short messages; the link keeps room for these in reserve.
void Peer::sendMessages(U32 now) {
    for (int idle = 0, channel = turn_; idle < LINK_CHANNELS; ++idle) {
        if (!full_)
            turn_ = (channel + 1) % LINK_CHANNELS;
        if (!(full_ >> channel & 1) && sendMessage(channel, now))
            idle = -1;
        channel = (channel + 1) % LINK_CHANNELS;
    }
}

void Peer::openWanted(U32 now) {
    if (!isReady())
        return;
    for (int channel = 0; channel < ownChannels; ++channel) {
        ProgramConnection& program = programs_[channel];
        if (program.is(ProgramConnection::State::Wanted) && openChannel(channel)) {
            program.open(now);
            opened(program, now);
        }
    }
}

// Ends the connections of programs if their messages have waited too long for room in the link.
// Returns the time until the next check, in microseconds.
U32 Peer::endLate(U32 now) {
    U32 wait = never;
    for (int channel = 0; channel < LINK_CHANNELS; ++channel) {
        const ProgramConnection& program = programs_[channel];
        if (!program.is(ProgramConnection::State::Open) || !(full_ >> channel & 1))
            continue;
        wait = std::min(wait, untilLate(program.lateAt(), now));
        if (!untilLate(program.lateAt(), now))
            end(channel, 0, "has waited for room longer than its time-out");
    }
    return wait;
}

U32 Peer::poll(U32 now) {
    const U32 due = pollWay(now);
    U32 wait = std::min({endLate(now), due, waiting_.empty() && !isYielded() ? never : lookUs});
    for (ProgramConnection& program : programs_)
        wait = std::min(wait, program.beat(now));
    return wait;
}

void Peer::addInterest(std::vector<pollfd>& fds) const {
    for (const ProgramConnection& program : programs_)
        fds.push_back(program.interest(!(full_ >> (&program - programs_) & 1)));
}

void Peer::servePrograms(const pollfd* fds, U32 now) {
    for (ProgramConnection& program : programs_) {
        program.write(now);
        const pollfd& p = *fds++;
        if (p.fd >= 0 && p.fd == program.fd() && (p.events & POLLIN) && p.revents)
            program.read(now);
    }
    openWanted(now);
    sendMessages(now);
}

} // namespace XBeeAT
