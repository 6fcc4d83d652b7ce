// SPDX-License-Identifier: MIT
//
// hearer: a vehicle of the rig's that hears calls to all vehicles; its modem is in API mode.

#pragma once

#include "api_modem.h"
#include "key_file.h"
#include "rig.h"

extern "C" {
#include "link_broadcast.h"
}

class Hearer {
public:
    Hearer(Rig& rig, int address, const XBeeAT::LinkKey& key) : rig_(rig), key_(key) {
        XBee::Options options;
        options.set = {{"BD", 7}, {"MY", static_cast<uint32_t>(address)}, {"AP", 1}};
        modem_ = std::make_unique<XBee>(line_, rig.air, options);
    }
    void step() {
        modem_->advance(rig_.ns());
        frames_.feed(
            line_.received.data(), line_.received.size(),
            [this](int, const uint8_t* data, size_t size) { take({data, data + size}); },
            [](const Rig::Bytes&) {});
        line_.received.clear();
    }

    std::vector<Rig::Bytes> packets, calls; // what was heard, and what is to be carried out

private:
    void take(Rig::Bytes packet) {
        packets.push_back(packet);
        const U32 size =
            Link_openBroadcast(packet.data(), U32(packet.size()), key_.data(), newest_);
        newest_ = size ? LINK_BROADCAST_NUMBER(packet.data()) : newest_;
        const auto from = packet.begin() + LINK_BROADCAST_HEAD;
        if (size)
            calls.emplace_back(from, from + size);
    }
    Rig& rig_;
    XBeeAT::LinkKey key_;
    HostLine line_;
    std::unique_ptr<XBee> modem_;
    XBeeAT::ApiFrames frames_;
    U32 newest_ = 0;
};
