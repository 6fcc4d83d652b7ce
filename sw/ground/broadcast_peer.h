// SPDX-License-Identifier: MIT
//
// broadcast_peer: sends one-way calls to all vehicles at once, without a link.

#pragma once

#include "broadcast.h"
#include "peer.h"

namespace XBeeAT {

class BroadcastPeer : public Peer {
public:
    BroadcastPeer(Host& host, const LinkKeys& keys);

    std::string statistics() const override;
    U32 mostBytes() const override;
    const char* carrierName() const override { return "one packet to all vehicles"; }
    bool hasLink() const override { return false; }
    bool isHeard() const override { return false; }
    bool isUp() const override { return false; }
    U32 randomWait() const override { return LINK_WAIT_SHARED; }
    void start(U32 longest, bool, U32) override { broadcast_.limitPacket(longest); }
    void stop(U32) override { broadcast_.stop(); }
    void receive(const U8*, size_t, U32) override {} // vehicles do not answer

private:
    bool isReady() const override { return broadcast_.most() != 0; }
    bool openChannel(int) override { return true; }
    void opened(ProgramConnection& program, U32 now) override { program.greet(now); }
    void closeChannel(int) override {}
    U32 longestMessage() const override { return broadcast_.most(); }
    bool send(int channel, U32 now) override;
    U32 pollWay(U32 now) override;

    Broadcast broadcast_;
    unsigned calls_ = 0;
};

} // namespace XBeeAT
