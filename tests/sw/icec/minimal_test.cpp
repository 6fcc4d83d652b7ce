// SPDX-License-Identifier: MIT
//
// minimal_test: tests calls of the minimal run time, and the requests that it rejects.

#include "icec_pair.h"

namespace {

class Minimal : public IcecPair {};

TEST_F(Minimal, MissingParametersAndTooLargeResultsAreUnknownLocalExceptions) {
    servant_.run = [](const Ice_Current&, Ice_InputStreamPtr is, Ice_OutputStreamPtr) {
        (void)Ice_InputStream_readLong(is);
        return ICE_OK;
    };
    EXPECT_EQ(call(prx_, "op"), ICE_UNKNOWN_LOCAL_EXCEPTION);
    servant_.run = [](const Ice_Current&, Ice_InputStreamPtr, Ice_OutputStreamPtr os) {
        static const Ice_Byte much[ICE_MESSAGE_MAX] = {};
        Ice_OutputStream_writeBlob(os, much, ICE_MESSAGE_MAX - ICE_MESSAGE_MAX / 1000);
        Ice_OutputStream_writeBlob(os, much, ICE_MESSAGE_MAX);
        return ICE_OK;
    };
    EXPECT_EQ(call(prx_, "op"), ICE_UNKNOWN_LOCAL_EXCEPTION);
    EXPECT_EQ(Ice_ObjectPrx_ice_ping(&prx_), ICE_OK);
}

TEST_F(Minimal, CallsWithinAnOperationAreRefused) {
    Ice_Status inner = ICE_OK;
    servant_.run = [&](const Ice_Current&, Ice_InputStreamPtr is, Ice_OutputStreamPtr os) {
        Ice_ObjectPrx back = there().proxy("thing -o:loop");
        inner = call(back, "op");
        Ice_OutputStream_writeInt(os, Ice_InputStream_readInt(is) + 1);
        return ICE_OK;
    };
    EXPECT_EQ(ask(prx_, "op", 4), 5);
    EXPECT_EQ(inner, ICE_LIMIT);
    Ice_ObjectPrx back = there().proxy("missing:loop");
    EXPECT_EQ(call(back, "op"), ICE_OBJECT_NOT_EXIST)
        << "outside a dispatch, calls must be possible";
}

TEST_F(Minimal, InvalidProxyStringsAreReported) {
    Ice_ObjectPrx prx;
    const std::pair<const char*, Ice_Status> cases[] = {
        {"x", ICE_NO_ENDPOINT},
        {"x:ssl -p 1", ICE_NO_ENDPOINT},
        {"x:loops", ICE_NO_ENDPOINT},
        {":loop", ICE_LIMIT},
        {"x -t:loop -c 1", ICE_OK},
        {"a-name-of-fifty-characters-which-is-one-too-many-00:loop", ICE_LIMIT},
        {"a-name-of-forty-nine-characters-which-still-fit-0:loop", ICE_OK}};
    for (const auto& c : cases)
        EXPECT_EQ(Ice_Communicator_stringToProxy(&here().ic, c.first, &prx), c.second) << c.first;
    Ice_ObjectAdapter other;
    EXPECT_EQ(Ice_Communicator_createObjectAdapterWithEndpoints(&there().ic, "B", "ssl", &other),
              ICE_NO_ENDPOINT);
    EXPECT_EQ(Ice_ObjectAdapter_createProxy(&there().adapter, "thing", &prx), ICE_OK);
    Ice_Byte bytes[64];
    Ice_OutputStream os;
    Ice_OutputStream_init(&os, bytes, sizeof bytes);
    Ice_OutputStream_writePrx(&os, &prx);
    EXPECT_EQ(Bytes(bytes, bytes + os.size),
              Bytes({5, 't', 'h', 'i',  'n',  'g', 0, 0, 0, 0, 1, 0,
                     1, 1,   1,   0x50, 0x4C, 7,   0, 0, 0, 1, 1, 0}));
}

// Acts as the peer of a communicator, and sends prepared messages. The communicator has opened
// connection 0.
class MinimalPeer : public ::testing::Test {
protected:
    MinimalPeer() {
        side_.loop.silent = true;
        prx_ = side_.proxy("far:loop");
        prx_.timeoutMs = 50;
        side_.loop.tap = [this](const Bytes& m) {
            ++requests_;
            if (answer_)
                answer_(Bytes(m.begin() + 14, m.begin() + 18));
        };
    }
    void arrives(const Bytes& m) { side_.loop.inject(ICE_EVENT_MESSAGE, 0, m); }
    void arrives(Ice_Byte type, Bytes id, const Bytes& rest) {
        id.insert(id.end(), rest.begin(), rest.end());
        arrives(message(type, id));
    }
    void validate() {
        arrives(message(3, {}));
        EXPECT_EQ(Ice_Communicator_poll(&side_.ic, 0), ICE_OK);
    }
    const Bytes seven_ = {0, 10, 0, 0, 0, 1, 1, 7, 0, 0, 0};

    Side side_;
    Ice_ObjectPrx prx_;
    int requests_ = 0;
    std::function<void(Bytes id)> answer_;
};

TEST_F(MinimalPeer, NothingIsSentBeforeTheFirstMessageOfThePeer) {
    EXPECT_EQ(call(prx_, "op"), ICE_TIMEOUT);
    EXPECT_EQ(requests_, 0);
    validate();
    EXPECT_EQ(call(prx_, "op"), ICE_TIMEOUT);
    EXPECT_EQ(requests_, 1);
}

TEST_F(MinimalPeer, RepliesToOtherCallsAreIgnored) {
    EXPECT_EQ(call(prx_, "op"), ICE_TIMEOUT);
    validate();
    Bytes late;
    answer_ = [&](const Bytes& id) { late = id; };
    EXPECT_EQ(call(prx_, "op"), ICE_TIMEOUT);
    answer_ = [&](const Bytes& id) {
        arrives(2, late, {7, 0});
        arrives(message(3, {})); // a heartbeat
        arrives(2, id, seven_);
    };
    EXPECT_EQ(ask(prx_, "op", 0), 7);
}

TEST_F(MinimalPeer, ARequestIsServedBeforeTheReplyIsRead) {
    Servant servant;
    EXPECT_EQ(Ice_ObjectAdapter_add(&side_.adapter, &servant.base, "thing"), ICE_OK);
    EXPECT_EQ(call(prx_, "op"), ICE_TIMEOUT);
    validate();
    answer_ = [&](const Bytes& id) {
        answer_ = nullptr;
        arrives(request(9, requestBody("thing", "op")));
        arrives(2, id, seven_);
    };
    EXPECT_EQ(ask(prx_, "op", 0), 7);
    EXPECT_EQ(servant.calls, 1);
    EXPECT_EQ(requests_, 2) << "one message is the request, one is the answer to the other request";
}

TEST_F(MinimalPeer, ALostConnectionFailsTheCallAndTheNextCallReconnects) {
    const std::pair<Bytes, Ice_Status> ends[] = {{message(4, {}), ICE_CONNECTION_CLOSED},
                                                 {message(9, {}), ICE_CONNECTION_LOST},
                                                 {message(1, {}), ICE_CONNECTION_LOST}};
    for (const auto& end : ends) {
        answer_ = nullptr;
        EXPECT_EQ(call(prx_, "op"), ICE_TIMEOUT);
        validate();
        answer_ = [&](const Bytes&) { arrives(end.first); };
        EXPECT_EQ(call(prx_, "op"), end.second);
        EXPECT_FALSE(side_.loop.open[0]);
    }
    EXPECT_EQ(requests_, 3);
}

TEST_F(MinimalPeer, MalformedRepliesAreReported) {
    EXPECT_EQ(call(prx_, "op"), ICE_TIMEOUT);
    validate();
    const std::pair<Bytes, Ice_Status> replies[] = {
        {{6, 0}, ICE_UNKNOWN_USER_EXCEPTION},
        {{}, ICE_MARSHAL},                          // no status
        {{8}, ICE_MARSHAL},                         // unknown status
        {{0, 6, 0, 0}, ICE_MARSHAL},                // the encapsulation is truncated
        {{0, 7, 0, 0, 0, 1, 1}, ICE_MARSHAL},       // the encapsulation is longer than the message
        {{0, 6, 0, 0, 0, 2, 0}, ICE_PROTOCOL},      // encoding 2.0
        {{0, 8, 0, 0, 0, 1, 1, 7, 0}, ICE_MARSHAL}, // the encapsulation is too short for the result
    };
    for (const auto& reply : replies) {
        answer_ = [&](const Bytes& id) { arrives(2, id, reply.first); };
        Ice_Int out = 0;
        EXPECT_EQ(call(prx_, "op", 0, &out), reply.second);
    }
    Ice_ObjectPrx oneway = prx_;
    oneway.mode = ICE_ONEWAY;
    EXPECT_EQ(call(oneway, "op"), ICE_OK) << "the earlier malformed message has no effect";
}

} // namespace
