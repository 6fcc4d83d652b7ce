// SPDX-License-Identifier: MIT
//
// transports_test: tests a communicator that has two transports: tcp, and the loop between two
// communicators. Built with ICE_TRANSPORTS=2.

#include "icec_pair.h"

extern "C" {
#include "tcp_endpoint.h"
}

namespace {

struct Both {
    Ice_Communicator ic;
    TcpEndpoint tcp;
    Loop loop;
    Ice_ObjectAdapter adapter;

    Both() : loop((Ice_initialize(&ic), ic)) {
        EXPECT_EQ(TcpEndpoint_init(&ic, &tcp), ICE_OK);
        EXPECT_EQ(
            Ice_Communicator_createObjectAdapterWithEndpoints(&ic, "A", "loop:tcp -p 0", &adapter),
            ICE_OK);
        Ice_ObjectAdapter_activate(&adapter);
    }
    Both(const Both&) = delete;
    Both& operator=(const Both&) = delete;
    ~Both() { TcpEndpoint_destroy(&tcp); }
    std::string port() const { return std::to_string(tcp.port); }
};

enum { LOOP, TCP };

// Tests in which `here_` calls a servant of `there_`. The loop of `here_` also runs `there_`.
class Transports : public ::testing::Test {
protected:
    Transports() : here_(std::make_unique<Both>()), there_(std::make_unique<Both>()) {
        here_->loop.join(there_->loop);
        EXPECT_EQ(Ice_ObjectAdapter_add(&there_->adapter, &servant_.base, "thing"), ICE_OK);
        servant_.run = [this](const Ice_Current& current, Ice_InputStreamPtr is,
                              Ice_OutputStreamPtr os) {
            came_ = current.connection / ICE_CONNECTIONS;
            Ice_OutputStream_writeInt(os, Ice_InputStream_readInt(is) + 1);
            return ICE_OK;
        };
        byLoop_ = proxy("thing:loop");
        byTcp_ = proxy("thing:tcp -p " + there_->port());
    }
    Ice_ObjectPrx proxy(const std::string& text) {
        Ice_ObjectPrx prx;
        EXPECT_EQ(Ice_Communicator_stringToProxy(&here_->ic, text.c_str(), &prx), ICE_OK) << text;
        return prx;
    }
    std::string print(const Ice_ObjectPrx& prx) {
        char printed[200];
        EXPECT_EQ(Ice_Communicator_proxyToString(&prx, printed, sizeof printed), ICE_OK);
        return printed;
    }
    // Makes a call. Returns the number of the transport on which it arrived.
    int callBy(Ice_ObjectPrx& prx) {
        came_ = -1;
        EXPECT_EQ(ask(prx, "op", 7), 8);
        return came_;
    }
    std::unique_ptr<Both> here_, there_;
    Servant servant_;
    Ice_ObjectPrx byLoop_, byTcp_;
    int came_ = -1;
};

TEST_F(Transports, AnAdaptersProxyHasAnEndpointOfEachTransportItListensOn) {
    Ice_ObjectPrx prx;
    ASSERT_EQ(Ice_ObjectAdapter_createProxy(&there_->adapter, "thing", &prx), ICE_OK);
    EXPECT_EQ(print(prx),
              "thing -t -e 1.1:loop -c 0:tcp -h 127.0.0.1 -p " + there_->port() + " -t 60000");
    Ice_ObjectAdapter loopOnly;
    ASSERT_EQ(
        Ice_Communicator_createObjectAdapterWithEndpoints(&there_->ic, "B", "loop", &loopOnly),
        ICE_OK);
    ASSERT_EQ(Ice_ObjectAdapter_createProxy(&loopOnly, "thing", &prx), ICE_OK);
    EXPECT_EQ(print(prx), "thing -t -e 1.1:loop -c 0");
}

// The expected strings are the output of stock Ice's proxyToString(stringToProxy(...)).
TEST_F(Transports, ProxyStringsAreParsedAndPrintedAsInIce) {
    const std::pair<const char*, const char*> cases[] = {
        {"plain", "plain -t -e 1.1"},
        {"plain -t", "plain -t -e 1.1"},
        {" leading", "leading -t -e 1.1"},
        {"cat/name -o", "cat/name -o -e 1.1"},
        {"a\\/b/c -O", "a\\/b/c -O -e 1.1"},
        {"/name", "name -t -e 1.1"},
        {"-t", "-t -t -e 1.1"},
        {"name -f facet", "name -f facet -t -e 1.1"},
        {"name -f \"a facet\" -s", "name -f \"a facet\" -t -s -e 1.1"},
        {"name -e 1.0", "name -t -e 1.0"},
        {"name -p 1.0 -t", "name -t -e 1.1"},
        {"name -t -o", "name -o -e 1.1"},
        {"'single quoted' -d", "\"single quoted\" -d -e 1.1"},
        {"name @ adapter", "name -t -e 1.1 @ adapter"},
        {"cat/name -o @ \"an adapter\"", "cat/name -o -e 1.1 @ \"an adapter\""},
        {"tab\\tand\\nnewline", "tab\\tand\\nnewline -t -e 1.1"},
        {"octal\\101\\7", "octalA\\a -t -e 1.1"},
        {"back\\\\slash", "back\\\\slash -t -e 1.1"},
        {"n:opaque -t 99 -e 1.0 -v QUJD", "n -t -e 1.1:opaque -t 99 -e 1.0 -v QUJD"},
        {"\"with space\":tcp -h a -p 1", "\"with space\" -t -e 1.1:tcp -h a -p 1 -t 60000"},
        {"n -o -s:tcp -h host -p 1 -t 500", "n -o -s -e 1.1:tcp -h host -p 1 -t 500"},
        {"n:tcp -h \"::1\" -p 65535 -t infinite",
         "n -t -e 1.1:tcp -h \"::1\" -p 65535 -t infinite"},
        {"n:opaque -e 1.1 -t 99 -v QUI=:tcp -h x -p 2:tcp -h b -p 2",
         "n -t -e 1.1:opaque -t 99 -e 1.1 -v QUI=:tcp -h x -p 2 -t 60000:tcp -h b -p 2 -t 60000"}};
    for (const auto& [read, printed] : cases)
        EXPECT_EQ(print(proxy(read)), printed);
    Ice_ObjectPrx prx;
    EXPECT_EQ(Ice_Communicator_stringToProxy(&here_->ic, "name:tcp -h", &prx), ICE_PARSE);
}

TEST_F(Transports, IfAnEndpointFailsTheNextIsTried) {
    Ice_ObjectPrx prx = proxy("thing:tcp -h 127.0.0.1 -p 1:loop");
    EXPECT_EQ(callBy(prx), LOOP);
    prx = proxy("thing:opaque -t 99 -e 1.1 -v AAAA:tcp -p " + there_->port());
    EXPECT_EQ(callBy(prx), TCP);
}

TEST_F(Transports, AnOperationMayCallThroughTheOtherTransport) {
    Servant caller;
    Ice_ObjectPrx back;
    ASSERT_EQ(Ice_ObjectAdapter_add(&here_->adapter, &servant_.base, "far"), ICE_OK);
    ASSERT_EQ(Ice_ObjectAdapter_add(&there_->adapter, &caller.base, "caller"), ICE_OK);
    ASSERT_EQ(Ice_Communicator_stringToProxy(&there_->ic, "far:loop -c 1", &back), ICE_OK);
    caller.run = [&](const Ice_Current&, Ice_InputStreamPtr is, Ice_OutputStreamPtr os) {
        Ice_OutputStream_writeInt(os, ask(back, "op", Ice_InputStream_readInt(is)) * 10);
        return ICE_OK;
    };
    Ice_ObjectPrx prx = proxy("caller:tcp -p " + there_->port());
    EXPECT_EQ(ask(prx, "op", 4), 50);
    EXPECT_EQ(came_, LOOP);
}

TEST_F(Transports, TheEndOfAConnectionDoesNotFailCallsOfTheOtherTransport) {
    Ice_Reply later;
    Ice_Status status[2] = {ICE_LATER, ICE_LATER};
    Ice_ObjectPrx* const by[2] = {&byLoop_, &byTcp_};
    EXPECT_EQ(callBy(byLoop_), LOOP);
    EXPECT_EQ(callBy(byTcp_), TCP);
    servant_.answerLater(later);
    for (int t : {LOOP, TCP})
        callAsync(*by[t], "op", status[t]);
    int tcp = -1;
    ASSERT_EQ(Ice_ObjectPrx_ice_getConnection(&byTcp_, &tcp), ICE_OK);
    Ice_Connection_close(&here_->ic, tcp);
    EXPECT_EQ(status[TCP], ICE_CONNECTION_LOST);
    EXPECT_EQ(status[LOOP], ICE_LATER);
    Ice_Connection_close(&here_->ic, tcp % ICE_CONNECTIONS);
    EXPECT_EQ(status[LOOP], ICE_CONNECTION_LOST);
}

TEST_F(Transports, ABusyTransportDoesNotStarveTheOther) {
    EXPECT_EQ(callBy(byTcp_), TCP);
    Ice_ObjectPrx oneway = byTcp_;
    Ice_ObjectPrx_ice_oneway(&oneway);
    there_->loop.inject(ICE_EVENT_OPENED, 1);
    for (int i = 0; i < 500; ++i)
        there_->loop.inject(ICE_EVENT_MESSAGE, 1, IceMessages::validate()); // a heartbeat
    int polls = 0;
    for (; polls < 5; ++polls) // afterwards, the next poll asks `loop` first
        EXPECT_EQ(Ice_Communicator_poll(&there_->ic, 0), ICE_OK);
    ASSERT_EQ(call(oneway, "op"), ICE_OK);
    for (came_ = -1; came_ < 0 && polls < 500; ++polls)
        EXPECT_EQ(Ice_Communicator_poll(&there_->ic, 0), ICE_OK);
    EXPECT_LT(polls, 100);
}

TEST_F(Transports, APollServesEachTransportWithinItsTimeOut) {
    EXPECT_EQ(callBy(byTcp_), TCP);
    Ice_ObjectPrx oneway = byTcp_;
    Ice_ObjectPrx_ice_oneway(&oneway);
    for (int i = 0; i < 3; ++i) {
        came_ = -1;
        ASSERT_EQ(call(oneway, "op"), ICE_OK);
        EXPECT_EQ(Ice_Communicator_poll(&there_->ic, 0), ICE_OK);
        EXPECT_EQ(came_, TCP);
    }
    U32 begin = here_->loop.nowMs();
    EXPECT_EQ(Ice_Communicator_poll(&here_->ic, 50), ICE_TIMEOUT);
    EXPECT_GE(here_->loop.nowMs() - begin, 50U);
}

TEST_F(Transports, AnAdapterRefusedByOneTransportListensOnNone) {
    Ice_Communicator ic;
    TcpEndpoint tcp;
    Ice_ObjectAdapter adapter;
    Ice_initialize(&ic);
    ASSERT_EQ(TcpEndpoint_init(&ic, &tcp), ICE_OK);
    Loop loop(ic);
    for (const char* refused : {"tcp -p 0:udp -p 1", "tcp -p 0:loop:tcp -p 0"}) {
        EXPECT_NE(Ice_Communicator_createObjectAdapterWithEndpoints(&ic, "A", refused, &adapter),
                  ICE_OK);
        EXPECT_EQ(tcp.listener, -1) << refused;
    }
    TcpEndpoint_destroy(&tcp);
}

TEST_F(Transports, ShutdownAndDestroyAffectAllTransports) {
    EXPECT_EQ(callBy(byLoop_), LOOP);
    EXPECT_EQ(callBy(byTcp_), TCP);
    Ice_Communicator_shutdown(&there_->ic);
    EXPECT_EQ(there_->tcp.listener, -1);
    for (Ice_ObjectPrx* prx : {&byLoop_, &byTcp_})
        EXPECT_EQ(call(*prx, "op"), ICE_CONNECTION_CLOSED);
    Ice_Communicator_destroy(&here_->ic, 100);
    for (const Ice_Connection& c : here_->ic.connections)
        EXPECT_EQ(c.state, ICE_CONNECTION_NONE);
}

} // namespace
