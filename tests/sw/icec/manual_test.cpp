// SPDX-License-Identifier: MIT
//
// manual_test: tests what Ice's manual promises in its chapters on proxies and adapters, except
// calls (docs/icec.md): parts of a proxy, changes to a copy, adapters, Current, and transports that
// cannot be called. Also tests connections that end, calls back on a connection, time-outs,
// heartbeats, the properties of adapters and proxies, and names that have several addresses.

#include "icec_pair.h"
#include <dlfcn.h>
#include <netdb.h>
#include <netinet/in.h>

extern "C" {
#include "tcp_private.h"
}

// A resolver that replaces the system's: "twofold.test" has the addresses 127.0.0.2 and
// 127.0.0.1, "mixed.test" has ::1 and 127.0.0.1.
static const auto real = reinterpret_cast<decltype(&getaddrinfo)>(dlsym(RTLD_NEXT, "getaddrinfo"));
static addrinfo* inFront(const char* address, const char* port, addrinfo* rest) {
    addrinfo numeric = {}, *one = nullptr;
    numeric.ai_flags = AI_NUMERICHOST;
    numeric.ai_socktype = SOCK_STREAM;
    if (real(address, port, &numeric, &one) == 0)
        one->ai_next = rest;
    return one;
}
extern "C" int getaddrinfo(const char* name, const char* port, const addrinfo* hints,
                           addrinfo** list) {
    bool isTwofold = name && std::string(name) == "twofold.test";
    if (!isTwofold && (!name || std::string(name) != "mixed.test"))
        return real(name, port, hints, list);
    *list = inFront(isTwofold ? "127.0.0.2" : "::1", port, inFront("127.0.0.1", port, nullptr));
    return 0;
}

namespace {

std::string written(const Ice_ObjectPrx& prx) {
    char line[200];
    EXPECT_EQ(Ice_Communicator_proxyToString(&prx, line, sizeof line), ICE_OK);
    return line;
}

class Manual : public IcecPair {};

TEST_F(Manual, AProxyReturnsItsIdentityAndFacet) {
    Ice_ObjectPrx prx = here().proxy("\"cat/a name\" -f side:loop -c 1");
    EXPECT_EQ(str(Ice_ObjectPrx_getIdentity(&prx).name), "a name");
    EXPECT_EQ(str(Ice_ObjectPrx_getIdentity(&prx).category), "cat");
    EXPECT_EQ(str(Ice_ObjectPrx_getFacet(&prx)), "side");
    Ice_ObjectPrx plain = here().proxy("x");
    EXPECT_EQ(str(Ice_ObjectPrx_getIdentity(&plain).category), "");
    EXPECT_EQ(str(Ice_ObjectPrx_getFacet(&plain)), "");
}

TEST_F(Manual, ChangingACopyDoesNotChangeTheProxy) {
    const Ice_ObjectPrx prx = here().proxy("thing:loop");
    Ice_ObjectPrx other = prx;
    EXPECT_EQ(Ice_ObjectPrx_ice_identity(&other, "cat/else"), ICE_OK);
    EXPECT_EQ(Ice_ObjectPrx_ice_facet(&other, "side"), ICE_OK);
    Ice_ObjectPrx_ice_oneway(&other);
    EXPECT_FALSE(Ice_ObjectPrx_equals(&prx, &other));
    EXPECT_EQ(written(other), "cat/else -f side -o -e 1.1:loop -c 0");
    EXPECT_EQ(Ice_ObjectPrx_ice_identity(&other, "thing"), ICE_OK);
    EXPECT_EQ(Ice_ObjectPrx_ice_facet(&other, ""), ICE_OK);
    Ice_ObjectPrx_ice_twoway(&other);
    EXPECT_TRUE(Ice_ObjectPrx_equals(&prx, &other));
    EXPECT_EQ(written(other), written(prx));
    servant_.run = [](const Ice_Current&, Ice_InputStreamPtr, Ice_OutputStreamPtr os) {
        Ice_OutputStream_writeInt(os, 5);
        return ICE_OK;
    };
    EXPECT_EQ(ask(other, "op", 0), 5) << "the proxy must be two-way again";
}

TEST_F(Manual, AProxyOfAnAdapterWorksAtItsReceiver) {
    servant_.run = [&](const Ice_Current& current, Ice_InputStreamPtr, Ice_OutputStreamPtr os) {
        Ice_ObjectPrx self;
        EXPECT_EQ(Ice_ObjectAdapter_createProxy(current.adapter, "thing", &self), ICE_OK);
        Ice_OutputStream_writePrx(os, &self);
        return ICE_OK;
    };
    Ice_ObjectPrx prx = here().proxy("thing:loop"), got;
    Ice_InputStreamPtr is = nullptr;
    ASSERT_NE(Ice_ObjectPrx_begin(&prx, "self", ICE_RESULTS), nullptr);
    ASSERT_EQ(Ice_ObjectPrx_invoke(&prx, &is), ICE_OK);
    Ice_InputStream_readPrx(is, nullptr, &got);
    EXPECT_EQ(Ice_ObjectPrx_end(&prx, ICE_OK), ICE_OK);
    EXPECT_EQ(written(got), "thing -t -e 1.1:loop -c 0");
    EXPECT_EQ(call(got, "op"), ICE_OK);
    EXPECT_EQ(servant_.calls, 2);
}

TEST_F(Manual, SeveralAdaptersServeTheSameConnections) {
    Servant second;
    Ice_ObjectAdapter other;
    ASSERT_EQ(Ice_Communicator_createObjectAdapter(&there().ic, "Other", &other), ICE_OK);
    ASSERT_EQ(Ice_ObjectAdapter_add(&other, &second.base, "second"), ICE_OK);
    Ice_ObjectPrx prx = here().proxy("second:loop"), first = here().proxy("thing:loop");
    EXPECT_EQ(call(prx, "op"), ICE_OBJECT_NOT_EXIST) << "the adapter is not active yet";
    Ice_ObjectAdapter_activate(&other);
    EXPECT_EQ(call(prx, "op"), ICE_OK);
    EXPECT_EQ(call(first, "op"), ICE_OK);
    EXPECT_EQ(second.calls, 1);
    EXPECT_EQ(servant_.calls, 1);
    Ice_ObjectAdapter_destroy(&other);
    EXPECT_EQ(call(prx, "op"), ICE_OBJECT_NOT_EXIST);
}

TEST_F(Manual, CurrentDescribesTheRequest) {
    Ice_ObjectAdapterPtr adapter = nullptr;
    std::string seen;
    servant_.run = [&](const Ice_Current& c, Ice_InputStreamPtr, Ice_OutputStreamPtr) {
        adapter = c.adapter;
        seen = str(c.category) + "/" + str(c.name) + " -f " + str(c.facet) + " " +
               str(c.operation) + " mode " + std::to_string(c.mode) + " encoding 1." +
               std::to_string(c.minor) + " on " + std::to_string(c.connection) +
               (c.requestId ? "" : " one-way");
        return ICE_OK;
    };
    EXPECT_EQ(Ice_ObjectAdapter_addFacet(&there().adapter, &servant_.base, "cat/x", "f"), ICE_OK);
    Ice_ObjectPrx prx = here().proxy("cat/x -f f -e 1.0:loop -c 1");
    EXPECT_EQ(call(prx, "look", 0, nullptr, 2), ICE_OK);
    EXPECT_EQ(seen, "cat/x -f f look mode 2 encoding 1.0 on 2");
    EXPECT_EQ(adapter, &there().adapter);
    prx = here().proxy("thing -o:loop");
    EXPECT_EQ(call(prx, "note"), ICE_OK);
    settle();
    EXPECT_EQ(seen, "/thing -f  note mode 0 encoding 1.1 on 0 one-way");
}

// The servant forwards requests for objects that it does not know.
TEST_F(Manual, AServantWithoutTypeIdsGetsEveryRequest) {
    static Ice_ObjectPtr target;
    static std::vector<std::string> seen;
    target = &servant_.base;
    seen.clear();
    Ice_Object forwarder{};
    forwarder.dispatch = [](Ice_ObjectPtr, const Ice_Current* current, Ice_InputStreamPtr is,
                            Ice_OutputStreamPtr os) {
        seen.push_back(str(current->operation));
        if (seen.back() == "secret") // an interceptor
            return ICE_OPERATION_NOT_EXIST;
        return Ice_Object_invoke(target, current, is, os);
    };
    ASSERT_EQ(Ice_ObjectAdapter_add(&there().adapter, &forwarder, "any"), ICE_OK);
    Ice_ObjectPrx prx = here().proxy("any:loop");
    Ice_Bool is = 0;
    Ice_String id{};
    EXPECT_EQ(Ice_ObjectPrx_ice_ping(&prx), ICE_OK);
    EXPECT_EQ(Ice_ObjectPrx_ice_isA(&prx, "::Test::Thing", &is), ICE_OK);
    EXPECT_TRUE(is);
    EXPECT_EQ(Ice_ObjectPrx_ice_id(&prx, &id), ICE_OK);
    EXPECT_EQ(str(id), "::Test::Thing");
    EXPECT_EQ(call(prx, "op"), ICE_OK);
    EXPECT_EQ(call(prx, "secret"), ICE_OPERATION_NOT_EXIST);
    EXPECT_EQ(seen, (std::vector<std::string>{"ice_ping", "ice_isA", "ice_id", "op", "secret"}));
    EXPECT_EQ(servant_.calls, 1);
    // The target no longer exists. The object that forwards to it reports this, even for ice_ping.
    forwarder.dispatch = [](Ice_ObjectPtr, const Ice_Current*, Ice_InputStreamPtr,
                            Ice_OutputStreamPtr) { return ICE_OBJECT_NOT_EXIST; };
    EXPECT_EQ(Ice_ObjectPrx_ice_ping(&prx), ICE_OBJECT_NOT_EXIST);
}

TEST_F(Manual, AFailedAssertionOfAServantReportsItsLineToTheCaller) {
    servant_.run = [](const Ice_Current& current, Ice_InputStreamPtr is, Ice_OutputStreamPtr os) {
        Ice_Int litres = Ice_InputStream_readInt(is);
        ICE_CHECK(&current, litres > 0);
        Ice_OutputStream_writeInt(os, litres);
        return ICE_OK;
    };
    std::string line = "manual_test.cpp:" + std::to_string(__LINE__ - 4) + ": litres > 0";
    Ice_Int out = 0;
    EXPECT_EQ(call(prx_, "op", 5, &out), ICE_OK);
    EXPECT_EQ(call(prx_, "op", 0, &out), ICE_UNKNOWN_LOCAL_EXCEPTION);
    std::string text = reason(prx_);
    ASSERT_GE(text.size(), line.size()) << text;
    EXPECT_EQ(text.substr(text.size() - line.size()), line);
}

TEST_F(Manual, ARefusalTellsItsReason) {
    servant_.run = [](const Ice_Current& current, Ice_InputStreamPtr is, Ice_OutputStreamPtr os) {
        const Ice_Int litres = Ice_InputStream_readInt(is);
        if (litres < 1)
            return Ice_Current_refuse(&current, "litres: expected 1 or more");
        Ice_OutputStream_writeInt(os, litres);
        return litres == 9 ? ICE_UNKNOWN_EXCEPTION : ICE_OK;
    };
    Ice_Int out = 0;
    EXPECT_EQ(call(prx_, "op", 0, &out), ICE_UNKNOWN_EXCEPTION);
    EXPECT_EQ(reason(prx_), "litres: expected 1 or more");
    EXPECT_EQ(call(prx_, "op", 5, &out), ICE_OK);
    EXPECT_EQ(call(prx_, "op", 9, &out), ICE_UNKNOWN_EXCEPTION);
    EXPECT_EQ(reason(prx_), Ice_Status_text(ICE_UNKNOWN_EXCEPTION)) << "an old reason";
}

TEST_F(Manual, AServantHasRoomForItsResults) {
    servant_.run = [](const Ice_Current& current, Ice_InputStreamPtr is, Ice_OutputStreamPtr os) {
        Ice_Int wanted = Ice_InputStream_readInt(is);
        auto* room = static_cast<Ice_Byte*>(Ice_Current_allocate(&current, wanted));
        EXPECT_EQ(reinterpret_cast<size_t>(room) % 8, 0u);
        if (room)
            std::memset(room, 0x55, static_cast<size_t>(wanted));
        Ice_OutputStream_writeInt(os, room ? room[wanted - 1] : -1);
        return ICE_OK;
    };
    EXPECT_EQ(ask(prx_, "op", ICE_ARENA_BYTES), 0x55);
    EXPECT_EQ(ask(prx_, "op", ICE_ARENA_BYTES + 8), -1)
        << "the servant must report that the arena is full";
    EXPECT_EQ(ask(prx_, "op", 1), 0x55) << "each call must have the whole arena";
}

TEST_F(Manual, ALocatorResolvesAnIndirectProxy) {
    servant_.run = [&](const Ice_Current& current, Ice_InputStreamPtr is, Ice_OutputStreamPtr os) {
        std::string wanted = str(Ice_InputStream_readString(is));
        EXPECT_EQ(current.mode, 2);
        Ice_ObjectPrx known = there().proxy("");
        if (str(current.operation) == "findAdapterById" && wanted == "A")
            known = there().proxy("dummy:loop -c 1");
        else if (str(current.operation) == "findObjectById" && wanted == "x")
            known = there().proxy("x@A");
        Ice_OutputStream_writePrx(os, &known);
        return ICE_OK;
    };
    Ice_ObjectPrx locator = here().proxy("thing:loop");
    for (const char* string : {"x@A", "x"}) {
        Ice_ObjectPrx prx = here().proxy(string);
        EXPECT_EQ(call(prx, "op"), ICE_NO_ENDPOINT);
        EXPECT_EQ(Ice_ObjectPrx_resolve(&prx, &locator), ICE_OK) << string;
        EXPECT_EQ(written(prx), "x -t -e 1.1:loop -c 1");
        int calls = servant_.calls;
        EXPECT_EQ(Ice_ObjectPrx_resolve(&prx, &locator), ICE_OK)
            << "a direct proxy needs no locator";
        EXPECT_EQ(servant_.calls, calls);
    }
    for (const char* string : {"x@B", "y"}) {
        Ice_ObjectPrx prx = here().proxy(string);
        EXPECT_EQ(Ice_ObjectPrx_resolve(&prx, &locator), ICE_NO_ENDPOINT) << string;
    }
}

TEST_F(Manual, ProxiesWithoutAUsableEndpointFailWithNoEndpoint) {
    for (const char* string : {"x -t -e 1.1 @ adapter", "x -t -e 1.1:opaque -t 2 -e 1.1 -v QUI=",
                               "x -d -e 1.1:loop -c 0", "x -D -e 1.1:loop -c 0", "x -t -e 1.1"}) {
        Ice_ObjectPrx prx = here().proxy(string);
        EXPECT_EQ(call(prx, "op"), ICE_NO_ENDPOINT) << string;
        EXPECT_EQ(written(prx), string);
    }
    EXPECT_EQ(servant_.calls, 0);
}

TEST_F(Calls, AReplyOnALostConnectionIsRefused) {
    Ice_Reply later{};
    servant_.answerLater(later);
    prx_.timeoutMs = 5;
    EXPECT_EQ(call(prx_, "slow"), ICE_TIMEOUT);
    Ice_Connection_close(&here().ic, prx_.connection);
    settle();
    servant_.run = returns(ICE_OK);
    EXPECT_EQ(call(prx_, "again"), ICE_OK) << "a new connection with the same number must be used";
    (void)Ice_Reply_begin(&later);
    EXPECT_EQ(Ice_Reply_end(&later, ICE_OK), ICE_CONNECTION_LOST);
}

TEST_F(Calls, TheCallersConnectionCarriesCallsBack) {
    Servant back;
    ASSERT_EQ(Ice_ObjectAdapter_add(&here().adapter, &back.base, "back"), ICE_OK);
    Ice_ObjectPrx fixed{};
    servant_.run = [&](const Ice_Current& current, Ice_InputStreamPtr, Ice_OutputStreamPtr) {
        EXPECT_EQ(Ice_Connection_createProxy(&there().ic, current.connection, "back", &fixed),
                  ICE_OK);
        return ICE_OK;
    };
    ASSERT_EQ(call(prx_, "op"), ICE_OK);
    EXPECT_EQ(call(fixed, "op"), ICE_OK);
    EXPECT_EQ(back.calls, 1);
    EXPECT_EQ(fixed.connection, prx_.connection);
    Ice_Byte bytes[100];
    Ice_OutputStream os;
    Ice_OutputStream_init(&os, bytes, sizeof bytes);
    Ice_OutputStream_writePrx(&os, &fixed);
    EXPECT_TRUE(os.failed) << "a fixed proxy must not be sent to others";
    Ice_Connection_close(&here().ic, prx_.connection);
    settle();
    EXPECT_EQ(call(fixed, "op"), ICE_CONNECTION_LOST);
}

TEST_F(Calls, TimeOutsExpireAndLateRepliesAreIgnored) {
    Ice_Reply later{};
    servant_.answerLater(later);
    Ice_ObjectPrx_ice_invocationTimeout(&prx_, 250);
    U32 begin = here().loop.nowMs();
    EXPECT_EQ(call(prx_, "op"), ICE_TIMEOUT);
    EXPECT_EQ(here().loop.nowMs() - begin, 250u);
    Ice_Status status = ICE_OK;
    callAsync(prx_, "op", status);
    (void)Ice_Communicator_poll(&here().ic, 249);
    EXPECT_EQ(status, ICE_OK);
    (void)Ice_Communicator_poll(&here().ic, 249);
    (void)Ice_Communicator_poll(&here().ic, 0);
    EXPECT_EQ(status, ICE_TIMEOUT);
    (void)Ice_Reply_begin(&later);
    EXPECT_EQ(Ice_Reply_end(&later, ICE_OK), ICE_OK);
    settle();
    servant_.run = returns(ICE_OK);
    EXPECT_EQ(call(prx_, "op"), ICE_OK);
}

// While one task sends a request, another task receives the end of the connection.
TEST_F(Calls, AnAsynchronousCallWhoseSendingFailsIsReportedOnce) {
    ASSERT_EQ(call(prx_, "op"), ICE_OK);
    here().loop.tap = [&](const Bytes& message) {
        if (message[8] != 0) // not a request
            return;
        here().loop.inject(ICE_EVENT_CLOSED, prx_.connection);
        EXPECT_EQ(Ice_Communicator_poll(&here().ic, 0), ICE_OK);
    };
    Ice_Status status = ICE_OK;
    int calls = 0;
    std::pair<Ice_Status*, int*> result(&status, &calls);
    ASSERT_NE(Ice_ObjectPrx_begin(&prx_, "op", 0), nullptr);
    const auto done = [](void* cookie, Ice_Status s, Ice_InputStreamPtr) {
        const auto& to = *static_cast<std::pair<Ice_Status*, int*>*>(cookie);
        *to.first = s;
        ++*to.second;
    };
    const Ice_Status sent = Ice_ObjectPrx_invokeAsync(&prx_, done, &result);
    EXPECT_EQ(sent == ICE_OK ? status : sent, ICE_CONNECTION_LOST);
    EXPECT_EQ(calls, sent == ICE_OK ? 1 : 0) << "the caller must get the failure exactly once";
    here().loop.tap = nullptr;
    for (int i = 0; i < 2 * ICE_CALLS; ++i)
        EXPECT_EQ(call(prx_, "op"), ICE_OK) << "a slot was not released";
}

TEST_F(Calls, CallersOfALongOperationGetHeartbeats) {
    int beats = 0;
    there().loop.tap = [&](const Bytes& m) { beats += m[8] == 3; }; // ValidateConnection
    Ice_Reply later{};
    servant_.answerLater(later);
    prx_.timeoutMs = 5 * ICE_HEARTBEAT_MS + 100;
    EXPECT_EQ(call(prx_, "op"), ICE_TIMEOUT);
    EXPECT_EQ(beats, 1 + 5); // five heartbeats, and one message that opened the connection
    (void)Ice_Reply_begin(&later);
    EXPECT_EQ(Ice_Reply_end(&later, ICE_OK), ICE_OK);
    beats = 0;
    (void)Ice_Communicator_poll(&there().ic, 3 * ICE_HEARTBEAT_MS);
    EXPECT_EQ(beats, 0);
}

TEST_F(Calls, CallsAfterShutdownAreRefusedAndNotExecuted) {
    Ice_ObjectPrx prx = here().proxy("thing:loop"), other = here().proxy("thing:loop -c 1");
    ASSERT_EQ(call(prx, "op"), ICE_OK);
    Ice_Communicator_shutdown(&there().ic);
    EXPECT_EQ(call(prx, "op"), ICE_CONNECTION_CLOSED)
        << "the status must show that the call was not executed";
    EXPECT_EQ(call(other, "op"), ICE_CONNECTION_LOST)
        << "no new connection is accepted after the shutdown";
    EXPECT_EQ(servant_.calls, 1);
}

TEST_F(Calls, DestroyWaitsForPendingReplies) {
    Ice_Reply later{};
    servant_.answerLater(later);
    Ice_Status status = ICE_LIMIT;
    callAsync(prx_, "op", status);
    settle();
    // A call made by the other side; it fails when that side destroys its communicator.
    Ice_ObjectPrx own = there().proxy("missing:loop");
    ASSERT_NE(Ice_ObjectPrx_begin(&own, "op", 0), nullptr);
    ASSERT_EQ(Ice_ObjectPrx_invokeAsync(
                  &own,
                  [](void* cookie, Ice_Status, Ice_InputStreamPtr) {
                      (void)Ice_Reply_begin(static_cast<Ice_Reply*>(cookie));
                      EXPECT_EQ(Ice_Reply_end(static_cast<Ice_Reply*>(cookie), ICE_OK), ICE_OK);
                  },
                  &later),
              ICE_OK);
    Ice_Communicator_destroy(&there().ic, 100);
    settle();
    EXPECT_EQ(status, ICE_OK);
    EXPECT_FALSE(here().loop.open[0]);
}

TEST_F(Calls, AGracefulCloseReportsThatNothingWasExecuted) {
    servant_.run = [&](const Ice_Current& current, Ice_InputStreamPtr, Ice_OutputStreamPtr) {
        Ice_Connection_close(&there().ic, current.connection);
        return ICE_OK;
    };
    EXPECT_EQ(call(prx_, "op"), ICE_CONNECTION_CLOSED);
    servant_.run = returns(ICE_OK);
    EXPECT_EQ(call(prx_, "op"), ICE_OK) << "the call must use a new connection";
}

TEST_F(Calls, AdaptersAndProxiesAreCreatedFromProperties) {
    static const char* const table[] = {"Side.Endpoints=loop",
                                        "Thing.Proxy=thing:loop -c 1",
                                        "Number=-17",
                                        "Wrong=12x",
                                        "Number=4",
                                        nullptr};
    Ice_ObjectAdapter side;
    Ice_ObjectPrx prx;
    Ice_Communicator_setProperties(&here().ic, table);
    EXPECT_STREQ(Ice_Communicator_getProperty(&here().ic, "Side.Endpoints"), "loop");
    EXPECT_EQ(Ice_Communicator_getProperty(&here().ic, "Side"), nullptr);
    EXPECT_EQ(Ice_Communicator_getPropertyAsInt(&here().ic, "Number", 1), -17);
    EXPECT_EQ(Ice_Communicator_getPropertyAsInt(&here().ic, "Wrong", 1), 1);
    EXPECT_EQ(Ice_Communicator_getPropertyAsInt(&here().ic, "None", 7), 7);
    EXPECT_EQ(Ice_Communicator_createObjectAdapter(&here().ic, "Side", &side), ICE_OK);
    EXPECT_EQ(Ice_Communicator_propertyToProxy(&here().ic, "None", &prx), ICE_PARSE);
    ASSERT_EQ(Ice_Communicator_propertyToProxy(&here().ic, "Thing.Proxy", &prx), ICE_OK);
    EXPECT_EQ(call(prx, "op"), ICE_OK);
    EXPECT_EQ(prx.connection, 2);
}

TEST(TcpAddresses, IPv4IsTriedFirstAsInIce) {
    TcpEndpoint_Address address = {};
    address.host.data = "mixed.test";
    address.host.size = 10;
    address.port = 4061;
    TcpEndpoint_Place places[TCP_PLACES];
    ASSERT_EQ(TcpEndpoint_resolve(&address, places), 2);
    EXPECT_EQ(places[0].at.ss_family, AF_INET);
    EXPECT_EQ(reinterpret_cast<sockaddr_in&>(places[0].at).sin_port, htons(4061));
    EXPECT_EQ(places[1].at.ss_family, AF_INET6);
}

} // namespace
