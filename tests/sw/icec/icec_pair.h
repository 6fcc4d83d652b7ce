// SPDX-License-Identifier: MIT
//
// icec_pair: two communicators that the loop-back transport connects, or one communicator that gets
// messages as bytes; and a servant that the tests control.

#pragma once

#include "ice_messages.h"
#include "loop.h"

#include <cstring>
#include <gtest/gtest.h>
#include <memory>
#include <string>

inline Ice_String text(const char* s) {
    return Ice_String_from(s);
}
inline std::string str(Ice_String s) {
    return std::string(s.data, static_cast<size_t>(s.size));
}

using Operation =
    std::function<Ice_Status(const Ice_Current&, Ice_InputStreamPtr, Ice_OutputStreamPtr)>;

inline Operation returns(Ice_Status status) {
    return [=](const Ice_Current&, Ice_InputStreamPtr, Ice_OutputStreamPtr) { return status; };
}

// A servant that calls the function `run` for every operation.
struct Servant {
    // must be the first member, because IceC passes the address of this member as the servant's
    // address
    Ice_Object base;
    Operation run = returns(ICE_OK);
    int calls = 0;

    Servant() {
        static const char* const ids[] = {"::Ice::Object", "::Test::Thing", nullptr};
        base.dispatch = &Servant::dispatch;
        base.ids = ids;
        base.id = ids[1];
    }
    // Makes operations store their reply in `later` instead of sending it.
    void answerLater(Ice_Reply& later) {
        run = [&](const Ice_Current& current, Ice_InputStreamPtr, Ice_OutputStreamPtr) {
            Ice_Current_later(&current, &later);
            return ICE_LATER;
        };
    }
    static Ice_Status dispatch(Ice_ObjectPtr self, const Ice_Current* current,
                               Ice_InputStreamPtr is, Ice_OutputStreamPtr os) {
        auto* servant = reinterpret_cast<Servant*>(self);
        ++servant->calls;
        return servant->run(*current, is, os);
    }
};

struct Side {
    Ice_Communicator ic;
    Loop loop;
    Ice_ObjectAdapter adapter;

    Side() : loop((Ice_initialize(&ic), ic)) {
        EXPECT_EQ(Ice_Communicator_createObjectAdapterWithEndpoints(&ic, "A", "loop", &adapter),
                  ICE_OK);
        Ice_ObjectAdapter_activate(&adapter);
    }
    Ice_ObjectPrx proxy(const char* string) {
        Ice_ObjectPrx prx;
        EXPECT_EQ(Ice_Communicator_stringToProxy(&ic, string, &prx), ICE_OK) << string;
        return prx;
    }
};

// Makes a call with one int parameter and one int result.
inline Ice_Status call(Ice_ObjectPrx& prx, const char* operation, Ice_Int in = 0,
                       Ice_Int* out = nullptr, Ice_Byte mode = 0) {
    Ice_InputStreamPtr is = nullptr;
    Ice_OutputStreamPtr os =
        Ice_ObjectPrx_begin(&prx, operation, static_cast<Ice_Byte>(mode | (out ? ICE_RESULTS : 0)));
    if (!os)
        return static_cast<Ice_Status>(prx.status);
    Ice_OutputStream_writeInt(os, in);
    Ice_Status status = Ice_ObjectPrx_invoke(&prx, &is);
    if (status == ICE_OK && out)
        *out = Ice_InputStream_readInt(is);
    return Ice_ObjectPrx_end(&prx, status);
}

// Makes a call that must succeed, and returns its result.
inline Ice_Int ask(Ice_ObjectPrx& prx, const char* operation, Ice_Int in) {
    Ice_Int out = 0;
    EXPECT_EQ(call(prx, operation, in, &out), ICE_OK);
    return out;
}

// Returns the reason of the last call's failure.
inline std::string reason(const Ice_ObjectPrx& prx) {
    Ice_Failure failure;
    Ice_ObjectPrx_failure(&prx, &failure);
    return str(failure.unknown);
}

// Makes an asynchronous call without parameters; `status` is set when the reply arrives.
inline void callAsync(Ice_ObjectPrx& prx, const char* operation, Ice_Status& status) {
    ASSERT_NE(Ice_ObjectPrx_begin(&prx, operation, 0), nullptr);
    auto done = [](void* cookie, Ice_Status s, Ice_InputStreamPtr) {
        *static_cast<Ice_Status*>(cookie) = s;
    };
    ASSERT_EQ(Ice_ObjectPrx_invokeAsync(&prx, done, &status), ICE_OK);
}

class IcecPair : public ::testing::Test {
protected:
    IcecPair() : here_(std::make_unique<Side>()), there_(std::make_unique<Side>()) {
        here_->loop.join(there_->loop);
        add("thing");
        prx_ = here().proxy("thing:loop");
    }
    void add(const char* identity) {
        EXPECT_EQ(Ice_ObjectAdapter_add(&there_->adapter, &servant_.base, identity), ICE_OK);
    }
    Side& here() { return *here_; }
    Side& there() { return *there_; }
    // Lets both sides process the messages that they have received, until none is left.
    void settle() {
        while (Ice_Communicator_poll(&there_->ic, 0) == ICE_OK ||
               Ice_Communicator_poll(&here_->ic, 0) == ICE_OK)
            ;
    }
    Servant servant_;
    Ice_ObjectPrx prx_;

private:
    std::unique_ptr<Side> here_, there_;
};

// A test suite with tests in several files.
class Calls : public IcecPair {};

using namespace IceMessages;

// Sends messages as bytes to a communicator, and returns its replies.
class Wire : public ::testing::Test {
protected:
    Wire() : side_(std::make_unique<Side>()) {
        EXPECT_EQ(Ice_ObjectAdapter_add(&side_->adapter, &servant_.base, "thing"), ICE_OK);
        side_->loop.tap = [this](const Bytes& m) { sent_.push_back(m); };
    }
    // Opens a connection, sends the message, and returns the reply that follows the validation
    // message.
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
