// SPDX-License-Identifier: MIT
//
// to_all: a vehicle that receives calls to all vehicles. The host build and the ARM binary fly the
// same flight.

#pragma once

#include "ground.h"
#include <gtest/gtest.h>

extern "C" {
#include "link_broadcast.h"
}

// A vehicle that is called by the pilot, and a modem that sends calls to all vehicles. With a
// threshold of 10 the picture has corners, with a threshold of 200 it has none.
class ToAll : public GroundAndChip {
public:
    using Key = std::vector<uint8_t>;
    using Call = Ground::Call;
    const Key groups = Key(LINK_KEY_BYTES, 0x66), open = Key(LINK_KEY_BYTES);
    const Call low = {"hwengine1", "setParameterA", 0, {10, 0}},
               high = {"hwengine1", "setParameterA", 0, {200, 0}},
               start = {"hwengine1", "startProcessing"}, result = {"hwengine1", "getResult"};

    explicit ToAll(const Key& pilots) {
        ground.key = pilots;
        XBee::Options options;
        options.set = {{"BD", 7}, {"MY", 5}, {"DL", 0xFFFF}};
        modem_ = std::make_unique<XBee>(line_, air, options);
        soc.onTime([this](uint64_t now) {
            modem_->advance(now);
            return std::min(ground.advance(now), modem_->nextEvent());
        });
        provide(64, 64, [](uint32_t i) { return i % 8 < 3 && i / 64 % 8 < 3 ? 150 : 100; });
    }
    // Begins a flight with these steps. Returns the function that the simulated machine calls to
    // ask whether it must continue; the function returns true until the steps are done, or until 60
    // s have passed.
    std::function<bool()> flight(std::vector<Script> steps) {
        soc.reset(true);
        ground.start();
        isDone = false;
        return [this, script = inOrder(std::move(steps))]() mutable {
            isDone = script();
            return !isDone && within(60);
        };
    }
    // Sends a new call in three copies, because one of them may collide with a packet of the link.
    Script send(const Key& key, U32 number, const Call& call) {
        const auto m = Ground::request(0, call.object, call.operation, call.mode, call.parameters);
        Key packet(LINK_MAX_FRAME, 0x55);
        std::copy(m.begin(), m.end(), packet.begin() + LINK_BROADCAST_HEAD);
        packet.resize(Link_sealBroadcast(packet.data(), U32(m.size()), key.data(), number));
        sent.push_back(packet);
        return send({packet, packet, packet});
    }
    Script send(std::vector<Key> packets) {
        return [this, packets, begun = uint64_t(0), at = size_t(0)]() mutable {
            if (soc.now() - begun < 100'000'000)
                return false;
            if (at < packets.size())
                line_.send(packets[at], begun = soc.now());
            return at++ == packets.size();
        };
    }
    // Makes the pilot call the vehicle. The first byte of the last reply's result must be different
    // from 0 if `some` is true, and 0 if it is false.
    Script calls(std::vector<Call> these, bool some = false, const char* what = "") {
        const int last = static_cast<int>(these.size());
        return inOrder({[this] { return ground.replies.clear(), true; },
                        ground.calling(std::move(these)),
                        [=] {
                            const auto& reply = ground.messages[last];
                            EXPECT_EQ(reply.size() > 25 && reply[25] != 0, some) << what;
                            return true;
                        }});
    }

    std::vector<Key> sent;
    bool isDone = false;

private:
    HostLine line_;
    std::unique_ptr<XBee> modem_;
};
