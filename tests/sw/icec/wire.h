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
        side_->loop.tap = [this](const Bytes& m) { sent_.push_back(m); };
    }
    // Opens a connection, sends the message, returns the answer after the validation.
    std::vector<Bytes> exchange(const Bytes& m) {
        inject(ICE_EVENT_OPENED, {});
        EXPECT_EQ(sent_, std::vector<Bytes>({message(3, {})}));
        inject(ICE_EVENT_MESSAGE, m);
        return std::move(sent_);
    }
    void inject(Ice_EventKind kind, const Bytes& m) {
        sent_.clear();
        side_->loop.inject(kind, 1, m);
        (void)Ice_Communicator_poll(&side_->ic, 0);
    }
    bool isOpen() const { return side_->loop.open[1]; }

    std::unique_ptr<Side> side_;
    Servant servant_;
    std::vector<Bytes> sent_;
};
