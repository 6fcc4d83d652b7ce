// SPDX-License-Identifier: MIT
//
// connections_test: connections that end, calls back on them, time-outs, signs of life, the
// properties that adapters and proxies are made from, and addresses of names.

#include "pair.h"

#include <dlfcn.h>
#include <netdb.h>
#include <netinet/in.h>

extern "C" {
#include "tcp_private.h"
}

// A resolver in place of the system's: "twofold.test" is 127.0.0.2 and 127.0.0.1, "mixed.test" is
// ::1 and 127.0.0.1.
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

TEST_F(Calls, AnAnswerForALostConnectionIsRefused) {
    Ice_Reply later{};
    servant_.answerLater(later);
    prx_.timeoutMs = 5;
    EXPECT_EQ(call(prx_, "slow"), ICE_TIMEOUT);
    Ice_Connection_close(&here().ic, prx_.connection);
    settle();
    servant_.run = returns(ICE_OK);
    EXPECT_EQ(call(prx_, "again"), ICE_OK) << "a new connection of the same number";
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
    EXPECT_TRUE(os.failed) << "a fixed proxy means nothing to others";
    Ice_Connection_close(&here().ic, prx_.connection);
    settle();
    EXPECT_EQ(call(fixed, "op"), ICE_CONNECTION_LOST);
}

TEST_F(Calls, TimeOutsAreKeptAndLateRepliesPassedOver) {
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

TEST_F(Calls, WhoWaitsForALongOperationGetsSignsOfLife) {
    int beats = 0;
    there().loop.tap = [&](const Bytes& m) { beats += m[8] == 3; }; // ValidateConnection
    Ice_Reply later{};
    servant_.answerLater(later);
    prx_.timeoutMs = 5 * ICE_HEARTBEAT_MS + 100;
    EXPECT_EQ(call(prx_, "op"), ICE_TIMEOUT);
    EXPECT_EQ(beats, 1 + 5); // the first opened the connection
    (void)Ice_Reply_begin(&later);
    EXPECT_EQ(Ice_Reply_end(&later, ICE_OK), ICE_OK);
    beats = 0;
    (void)Ice_Communicator_poll(&there().ic, 3 * ICE_HEARTBEAT_MS);
    EXPECT_EQ(beats, 0);
}

TEST_F(Calls, AfterShutdownNothingIsExecutedAndCallersKnowIt) {
    Ice_ObjectPrx prx = here().proxy("thing:loop"), other = here().proxy("thing:loop -c 1");
    ASSERT_EQ(call(prx, "op"), ICE_OK);
    Ice_Communicator_shutdown(&there().ic);
    EXPECT_EQ(call(prx, "op"), ICE_CONNECTION_CLOSED) << "repeating it elsewhere is safe";
    EXPECT_EQ(call(other, "op"), ICE_CONNECTION_LOST) << "no new connection is taken";
    EXPECT_EQ(servant_.calls, 1);
}

TEST_F(Calls, DestroyWaitsForAnswersThatComeLater) {
    Ice_Reply later{};
    servant_.answerLater(later);
    Ice_Status status = ICE_LIMIT;
    callAsync(prx_, "op", status);
    settle();
    // A call of the other side's own, whose failure comes while that side destroys itself.
    Ice_ObjectPrx own = there().proxy("nobody:loop");
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

TEST_F(Calls, AGracefulCloseSaysThatNothingWasExecuted) {
    servant_.run = [&](const Ice_Current& current, Ice_InputStreamPtr, Ice_OutputStreamPtr) {
        Ice_Connection_close(&there().ic, current.connection);
        return ICE_OK;
    };
    EXPECT_EQ(call(prx_, "op"), ICE_CONNECTION_CLOSED);
    servant_.run = returns(ICE_OK);
    EXPECT_EQ(call(prx_, "op"), ICE_OK) << "a new connection";
}

TEST_F(Calls, PropertiesMakeAdaptersAndProxies) {
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

TEST(TcpAddresses, IPv4ComesFirstAsInIce) {
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
