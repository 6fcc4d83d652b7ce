// SPDX-License-Identifier: MIT
//
// wire: sends messages as bytes to a communicator, and returns its answers.

#pragma once

#include "../link/ice_messages.h"
#include "pair.h"

using namespace IceMessages;

class Wire : public ::testing::Test {
protected:
    Wire() : side_(std::make_unique<Side>()) {
        EXPECT_EQ(Ice_ObjectAdapter_add(&side_->adapter, &servant_.base, "thing"), ICE_OK);
        side_->loop.tapContext = this;
        side_->loop.tap = [](void* context, int, const Ice_Byte* m, Ice_Int size) {
            static_cast<Wire*>(context)->sent_.emplace_back(m, m + size);
        };
    }
    // Opens a connection, sends the message, returns the answer after the validation.
    std::vector<Bytes> exchange(const Bytes& m, Ice_Int size = -1) {
        inject(ICE_EVENT_OPENED, {});
        EXPECT_EQ(sent_, std::vector<Bytes>({message(3, {})}));
        sent_.clear();
        LoopEndpoint_inject(&side_->loop, ICE_EVENT_MESSAGE, 1, m.data(),
                            size < 0 ? static_cast<Ice_Int>(m.size()) : size);
        (void)Ice_Communicator_poll(&side_->ic, 0);
        return std::move(sent_);
    }
    void inject(Ice_EventKind kind, const Bytes& m) {
        sent_.clear();
        EXPECT_EQ(
            LoopEndpoint_inject(&side_->loop, kind, 1, m.data(), static_cast<Ice_Int>(m.size())),
            ICE_OK);
        (void)Ice_Communicator_poll(&side_->ic, 0);
    }
    bool isOpen() const { return side_->loop.open[1] != 0; }

    std::unique_ptr<Side> side_;
    Servant servant_;
    std::vector<Bytes> sent_;
};
