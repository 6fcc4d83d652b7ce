// SPDX-License-Identifier: MIT
//
// endpoint_test: tests the events that IceC's radio endpoint reports for connections that open and
// close while no task polls the endpoint.

#include "link_pair.h"
#include <functional>
#include <gtest/gtest.h>
#include <utility>

extern "C" {
#include "xbee_endpoint.h"
}

namespace {

class RadioEndpoint : public ::testing::Test {
protected:
    RadioEndpoint() {
        static const XBeeATEndpoint_Port port = {
            [](void*) {},
            [](void*) {},
            [](void*) {},
            [](void* c, Ice_Int ms) {
                if (ms && self(c).atWait_)
                    std::exchange(self(c).atWait_, nullptr)();
                self(c).run(static_cast<U32>(ms));
                return 0;
            },
            [](void*) {},
            [](void* c) { return static_cast<U32>(self(c).pair_.now) / 1000; }};
        Ice_initialize(&ic_);
        XBeeATEndpoint_init(&ic_, "xbee-at", &endpoint_, pair_.b.link(), 1, &port, this);
    }
    // Runs the links. All messages of the endpoint have the same tag, but a side stores only one
    // outcome per tag, so the outcomes are cleared.
    void run(U32 ms) {
        for (; ms; --ms) {
            pair_.b.outcomes.clear();
            pair_.run(1000);
        }
    }
    static RadioEndpoint& self(void* c) { return *static_cast<RadioEndpoint*>(c); }
    const Ice_Endpoint& ops() { return *ic_.transports[0].endpoint; }
    std::vector<std::pair<Ice_EventKind, int>> events() {
        std::vector<std::pair<Ice_EventKind, int>> list;
        for (;;) {
            Ice_Event event{};
            ops().receive(ic_.transports[0].context, buffer_, 0, &event);
            if (event.kind == ICE_EVENT_NONE)
                return list;
            list.emplace_back(event.kind, event.connection);
        }
    }
    Ice_Status connect() {
        const Ice_Byte encoded[] = {0x58, 0x41};
        int connection = -1;
        Ice_Status status = ops().connect(ic_.transports[0].context, encoded, 2, &connection);
        EXPECT_EQ(connection, status == ICE_OK ? 3 : connection);
        return status;
    }

    // Opens a connection from the vehicle to the ground.
    void open() {
        ASSERT_TRUE(pair_.connect());
        ASSERT_EQ(connect(), ICE_OK);
        pair_.run(500000);
    }
    Ice_Status send(int channel, const Bytes& message) {
        return ops().send(ic_.transports[0].context, channel, message.data(),
                          static_cast<Ice_Int>(message.size()));
    }

    LinkPair pair_{testSeed()};
    Ice_Communicator ic_;
    XBeeATEndpoint endpoint_;
    Ice_Byte buffer_[ICE_MESSAGE_MAX];
    std::function<void()> atWait_; // called when a task next waits
};

using Kinds = std::vector<std::pair<Ice_EventKind, int>>;

TEST_F(RadioEndpoint, OnlyTheLastStateOfAConnectionIsReported) {
    for (int channel = 0; channel < 3; ++channel)
        XBeeATEndpoint_onChannel(&endpoint_, channel, 1);
    EXPECT_EQ(events().size(), 3u);
    // The ground restarts repeatedly while the task of the server is busy.
    for (int times = 0; times < 10; ++times)
        for (int channel = 0; channel < 3; ++channel) {
            XBeeATEndpoint_onChannel(&endpoint_, channel, 0);
            XBeeATEndpoint_onChannel(&endpoint_, channel, 1);
        }
    XBeeATEndpoint_onChannel(&endpoint_, 2, 0);
    EXPECT_EQ(events(), (Kinds{{ICE_EVENT_CLOSED, 0},
                               {ICE_EVENT_CLOSED, 1},
                               {ICE_EVENT_CLOSED, 2},
                               {ICE_EVENT_OPENED, 0},
                               {ICE_EVENT_OPENED, 1}}));
}

TEST_F(RadioEndpoint, AMessageIsDeliveredOnceAndOnlyToAWaitingReceiver) {
    const U8 message[] = {1, 2, 3};
    auto offer = [&](int channel) {
        return XBeeATEndpoint_onMessage(&endpoint_, channel, message, sizeof message);
    };
    EXPECT_EQ(offer(2), 1) << "the link must keep the message";
    atWait_ = [&] {
        EXPECT_EQ(offer(2), 0);
        EXPECT_EQ(offer(1), 1) << "only one message is accepted at a time";
    };
    Ice_Event event{};
    EXPECT_EQ(ops().receive(ic_.transports[0].context, buffer_, 1, &event), ICE_OK);
    EXPECT_EQ(event.kind, ICE_EVENT_MESSAGE);
    EXPECT_EQ(event.connection, 2);
    EXPECT_EQ(Bytes(buffer_, buffer_ + event.size), Bytes(message, message + 3));
    EXPECT_EQ(events(), Kinds{});
}

TEST_F(RadioEndpoint, TheEndOfAConnectionDoesNotEndTheNext) {
    open();
    pair_.a.close(3);
    pair_.run(500000);
    // the channel has closed, but the endpoint has not noticed this yet
    XBeeATEndpoint_onChannel(&endpoint_, 3, 0);
    ASSERT_EQ(connect(), ICE_OK);
    EXPECT_EQ(events(), Kinds{});
}

TEST_F(RadioEndpoint, ConnectingWaitsUntilThePreviousConnectionIsClosed) {
    open();
    ops().close(ic_.transports[0].context, 3);
    EXPECT_EQ(pair_.b.open(3), LINK_FULL);
    EXPECT_EQ(connect(), ICE_OK);
}

TEST_F(RadioEndpoint, RepliesWaitForRoomInASlowLink) {
    open();
    pair_.setWeather({0.4});
    const Bytes answer(7930, 7);
    for (int n = 0; n < 5; ++n)
        EXPECT_EQ(send(3, answer), ICE_OK) << n;
    run(30000);
    EXPECT_EQ(pair_.a.received, (Messages(5, {3, answer})));
}

TEST_F(RadioEndpoint, AConnectionThatWaitsTooLongForTheLinkIsClosed) {
    open();
    pair_.a.refuse = true; // the link stays up, but its messages are not accepted
    const Bytes answer(7930, 7);
    Ice_Status status = ICE_OK;
    for (int n = 0; n < 10 && status == ICE_OK; ++n)
        status = send(3, answer);
    EXPECT_EQ(status, ICE_CONNECTION_LOST);
    EXPECT_EQ(events(), (Kinds{{ICE_EVENT_CLOSED, 3}}));
    pair_.a.refuse = false;
    run(10000);
    EXPECT_EQ(pair_.a.events.back(), "close 3");
    EXPECT_EQ(connect(), ICE_OK);
    run(1000);
    EXPECT_EQ(pair_.a.events.back(), "open 3");
    EXPECT_EQ(events(), Kinds{});
}

// A message that waits to be sent belongs to the program that used the channel when the message was
// passed to the endpoint.
TEST_F(RadioEndpoint, ALateMessageNeverReachesTheNextConnectionOfItsChannel) {
    ASSERT_TRUE(pair_.connect());
    const Bytes answer(7930, 7);
    auto again = [&] { // another program on the ground takes over the channel
        for (int isOpen : {0, 1})
            XBeeATEndpoint_onChannel(&endpoint_, 1, isOpen);
    };
    pair_.a.open(1);
    run(500);
    XBeeATEndpoint_onChannel(&endpoint_, 1, 1);
    EXPECT_EQ(events().size(), 1u);
    pair_.a.refuse = true; // the queue becomes full, because messages are not accepted
    while (pair_.b.send(1, answer, 0) == LINK_OK) {
    }
    atWait_ = [&] { // while the next message waits, another task detects the end of the connection
        again();
        EXPECT_EQ(events(), (Kinds{{ICE_EVENT_CLOSED, 1}, {ICE_EVENT_OPENED, 1}}));
        pair_.a.refuse = false;
    };
    EXPECT_EQ(send(1, answer), ICE_CONNECTION_LOST);
    run(10000);
    EXPECT_EQ(send(1, answer), ICE_OK);
    again(); // the endpoint has not noticed this change yet
    EXPECT_EQ(send(1, answer), ICE_CONNECTION_LOST);
}

TEST_F(RadioEndpoint, ASecondGroundHasSeparateConnections) {
    LinkPair other(testSeed() + 1);
    XBeeATEndpoint_addPeer(&endpoint_, 1, other.b.link(), 0x00F0);
    ASSERT_TRUE(pair_.connect() && other.connect());
    const auto connectTo = [&](Ice_Byte address) {
        const Ice_Byte encoded[] = {0x58, 0x41, 13, 0, 0, 0, 1, 1, address, 0, 255, 0, 0, 0, 0};
        int connection = -1;
        EXPECT_EQ(ops().connect(ic_.transports[0].context, encoded, sizeof encoded, &connection),
                  ICE_OK);
        return connection;
    };
    EXPECT_EQ(connectTo(0xF0), 7);
    EXPECT_EQ(connectTo(0), 3);
    const Bytes call(20, 9);
    EXPECT_EQ(send(7, call), ICE_OK);
    other.run(500'000);
    pair_.run(500'000);
    EXPECT_EQ(other.a.received, (Messages{{3, call}}));
    EXPECT_EQ(pair_.a.received, Messages{});
    // the other ground station closes its channel
    XBeeATEndpoint_onChannel(&endpoint_, 7, 0);
    EXPECT_EQ(events(), (Kinds{{ICE_EVENT_CLOSED, 7}}));
    EXPECT_EQ(send(3, call), ICE_OK);
}

// The options are written in the same way as by the ground's plugin (test_ground_ice,
// EndpointsKeepTheirOptionsAsText...), as far as the UAV supports them.
TEST_F(RadioEndpoint, AProxyOfAPeerEqualsTheProxyFromItsString) {
    Ice_ObjectAdapter adapter;
    Ice_ObjectPrx made, parsed;
    ASSERT_EQ(Ice_Communicator_createObjectAdapterWithEndpoints(&ic_, "", "xbee-at", &adapter),
              ICE_OK);
    ASSERT_EQ(XBeeATEndpoint_makeProxy(&adapter, "uav", 0x12F3, &made), ICE_OK);
    ASSERT_EQ(Ice_Communicator_stringToProxy(&ic_, "uav:xbee-at -a 0x12F3", &parsed), ICE_OK);
    EXPECT_TRUE(Ice_ObjectPrx_equals(&made, &parsed));
}

TEST_F(RadioEndpoint, AProxyPrintsTheOptionsOfItsEndpoint) {
    auto text = [&](const char* proxy) {
        Ice_ObjectPrx prx;
        char line[120] = "";
        EXPECT_EQ(Ice_Communicator_stringToProxy(&ic_, proxy, &prx), ICE_OK) << proxy;
        EXPECT_EQ(Ice_Communicator_proxyToString(&prx, line, sizeof line), ICE_OK) << proxy;
        return std::string(line);
    };
    EXPECT_EQ(text("x:xbee-at -a 0x12 -p 2 -t 7000"), "x -t -e 1.1:xbee-at -a 18 -p 2 -t 7000");
    EXPECT_EQ(text("x -o:xbee-at -a 65535"), "x -o -e 1.1:xbee-at -a 65535 -t 10000");
    EXPECT_EQ(text(text("x:xbee-at -a 1").c_str()), text("x:xbee-at -a 1"));
}

} // namespace
