// SPDX-License-Identifier: MIT
//
// wire: sends messages as bytes to a communicator, and returns its answers.

#pragma once

#include "pair.h"

using Bytes = std::vector<Ice_Byte>;

// Returns a message whose size is filled in.
inline Bytes message(Ice_Byte type, Bytes body, Ice_Byte compression = 0) {
    Bytes m = {'I', 'c', 'e', 'P', 1, 0, 1, 0, type, compression};
    size_t size = 14 + body.size();
    for (int i = 0; i < 4; ++i)
        m.push_back(static_cast<Ice_Byte>(size >> (8 * i)));
    m.insert(m.end(), body.begin(), body.end());
    return m;
}

inline void addString(Bytes& to, const std::string& s) {
    to.push_back(static_cast<Ice_Byte>(s.size()));
    to.insert(to.end(), s.begin(), s.end());
}

// Writes a request from the identity on.
inline Bytes requestBody(const std::string& name, const std::string& operation, Ice_Byte minor = 1,
                         Bytes parameters = {}) {
    Bytes b;
    addString(b, name);
    b.push_back(0); // category
    b.push_back(0); // facet
    addString(b, operation);
    b.push_back(0); // mode
    b.push_back(0); // context
    b.push_back(static_cast<Ice_Byte>(6 + parameters.size()));
    b.insert(b.end(), {0, 0, 0, 1, minor});
    b.insert(b.end(), parameters.begin(), parameters.end());
    return b;
}

inline Bytes request(Ice_Byte id, const Bytes& body) {
    Bytes b = {id, 0, 0, 0};
    b.insert(b.end(), body.begin(), body.end());
    return message(0, b);
}

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
