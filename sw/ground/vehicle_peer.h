// SPDX-License-Identifier: MIT
//
// vehicle_peer: the connection to one vehicle, over a link.

#pragma once

#include "peer.h"
#include "rival_station.h"

#include <memory>

namespace XBeeAT {

class VehiclePeer : public Peer {
public:
    VehiclePeer(Host& host, int address, const LinkKeys& keys);
    ~VehiclePeer() override;

    std::string statistics() const override;
    U32 mostBytes() const override { return LINK_MAX_MESSAGE; }
    const char* carrierName() const override { return "the radio link"; }
    bool hasLink() const override { return true; }
    bool isHeard() const override { return isUp() || isYielded(); }
    bool isUp() const override { return Link_state(link_.get()) == LINK_STATE_UP; }
    U32 randomWait() const override { return Link_randomWait(link_.get()); }
    void start(U32 longest, bool isApi, U32 now) override;
    void stop(U32 now) override;
    void receive(const U8* bytes, size_t size, U32 now) override;

private:
    bool isYielded() const override { return rival_.isYielded(); }
    bool isReady() const override { return isUp(); }
    bool openChannel(int channel) override {
        return Link_openChannel(link_.get(), channel) == LINK_OK;
    }
    void opened(ProgramConnection&, U32) override {}
    void closeChannel(int channel) override { Link_closeChannel(link_.get(), channel); }
    U32 longestMessage() const override { return LINK_MAX_MESSAGE; }
    bool send(int channel, U32 now) override;
    U32 pollWay(U32 now) override;

    void yieldOrResume(U32 now);
    void resume(U32 now);
    void leave(ProgramConnection& program);
    void reportLost();
    U32 withdrawLate(U32 now);

    static VehiclePeer& self(void* context) { return *static_cast<VehiclePeer*>(context); }
    static int onTransmit(void* context, const U8* frame, U32 size);
    static U32 onRandom(void* context);
    static int onMessage(void* context, int channel, const U8* data, U32 size);
    static void onChannel(void* context, int channel, int isOpen);
    static void onState(void* context, Link_State state);
    static void onOutcome(void* context, int channel, U32 isCall, Link_Outcome outcome);
    static void onWritable(void* context);

    // number of unconfirmed calls of programs that have disconnected
    unsigned lost_ = 0;
    // times at which the messages of each channel in the link will be late
    std::deque<U32> late_[LINK_CHANNELS];
    RivalStation rival_;
    std::unique_ptr<Link> link_;
    std::unique_ptr<Link_Buffers> buffers_; // buffers of link_
};

} // namespace XBeeAT
