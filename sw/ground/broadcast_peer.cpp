// SPDX-License-Identifier: MIT
//
// broadcast_peer: passes calls from programs to the packet line, one at a time.

#include "broadcast_peer.h"

#include "clock.h"

namespace XBeeAT {

BroadcastPeer::BroadcastPeer(Host& host, const LinkKeys& keys)
    : Peer(host, everybody, keys), broadcast_(host.settings, keys_) {}

// Passes on the next message of a program. If the program has closed its side of the connection,
// keeps the connection until the program's calls have been sent.
bool BroadcastPeer::send(int channel, U32 now) {
    ProgramConnection& program = programs_[channel];
    if (program.kind() == ProgramConnection::Kind::Twoway) {
        program.refuse(
            "xbee-at: a call to all vehicles (-a 0xFFFF) has no answer: use a oneway proxy", now);
        return true;
    }
    if (broadcast_.isBusy())
        waitForRoom(channel);
    else if (program.kind() == ProgramConnection::Kind::Goodbye)
        end(channel, 1, "has ended");
    else if (program.kind() != ProgramConnection::Kind::Oneway)
        end(channel, 0, "sent a batch; calls to all vehicles must be sent one at a time");
    else if (!broadcast_.take(program.data(), program.size(), now))
        end(channel, 0,
            "calls all vehicles, but the clock of this machine is not set (it numbers such calls)");
    else {
        ++calls_;
        program.taken(now);
        return true;
    }
    return false;
}

// Sends the next copy of a call if it is due. After the last copy, programs may send the next call.
U32 BroadcastPeer::pollWay(U32 now) {
    placePrograms(now);
    openWanted(now);
    const U32 due = broadcast_.poll(now, [this, now](const U8* packet, U32 size) {
        return host_.line.send(*this, packet, size, now);
    });
    if (broadcast_.isBusy() || !full_)
        return due;
    full_ = 0;
    return 0;
}

U32 BroadcastPeer::mostBytes() const {
    std::lock_guard<std::mutex> lock(host_.mutex);
    return broadcast_.most();
}

std::string BroadcastPeer::statistics() const {
    std::lock_guard<std::mutex> lock(host_.mutex);
    return host_.device + " 0xFFFF: " + std::to_string(calls_) + " calls to all vehicles";
}

} // namespace XBeeAT
