// SPDX-License-Identifier: MIT
//
// ice_test: tests stock Ice over the radio: callbacks, long messages, time-outs, shared channels.
// test_chip_soak tests many calls from threads with several proxies, in bad conditions, and calls
// from the UAV to the ground.

#include "held_timer.h"
#include "world.h"
#include <future>
#include <gtest/gtest.h>

namespace {

class StockIce : public ::testing::Test {
protected:
    void TearDown() override {
        EXPECT_EQ(world_.echo->twice(), 0) << "some calls were executed twice";
    }
    World world_{testSeed()};
};

TEST_F(StockIce, MessagesAboveTheLimitAreRefusedInTheCaller) {
    Ice::CommunicatorHolder ic(world_.client());
    auto echo = world_.proxy(ic.communicator());
    // Size of a call without its data: header 14, id 4, identity "echo" 6, facet 1, operation
    // "repeat" 7, mode 1, context 1, encapsulation 6, int 4, size of the sequence 5.
    const size_t most = LINK_MAX_MESSAGE - 49;
    for (size_t size : {most - 1, most})
        EXPECT_EQ(echo->repeat(static_cast<int>(size), World::pattern(1, size)),
                  World::pattern(1, size));
    EXPECT_THROW(echo->repeat(1, World::pattern(1, most + 1)), Ice::MemoryLimitException);
    EXPECT_EQ(echo->repeat(2, World::pattern(2, 10)), World::pattern(2, 10))
        << "a call after the error must succeed";
}

TEST_F(StockIce, TheUavCallsBackOnTheSameConnectionWhileItIsCalled) {
    Ice::CommunicatorHolder ic(world_.client());
    auto adapter = ic->createObjectAdapter("");
    adapter->add(std::make_shared<ListenerServant>(), Ice::stringToIdentity("listener"));
    adapter->activate();
    auto echo = world_.proxy(ic.communicator());
    echo->ice_getConnection()->setAdapter(adapter);
    auto other = std::async(std::launch::async, [&] {
        for (int i = 1; i <= 10; ++i)
            EXPECT_EQ(echo->repeat(i, World::pattern(i, 300)), World::pattern(i, 300));
    });
    EXPECT_EQ(echo->callBack(20), 380);
    other.get();
}

TEST_F(StockIce, ACallForAnotherVehicleDoesNotReachThisOne) {
    Ice::CommunicatorHolder ic(world_.client());
    EXPECT_EQ(world_.proxy(ic.communicator())->repeat(1, {}).size(), 0u);
    auto other = ic->stringToProxy("echo:" + world_.endpoint() + " -a 0x0002");
    EXPECT_THROW(other->ice_invocationTimeout(1500)->ice_ping(), Ice::TimeoutException);
    EXPECT_EQ(world_.proxy(ic.communicator())->repeat(2, {}).size(), 0u);
}

// To close a connection, a message must go to the UAV and back; the channel stays in use until
// then.
TEST_F(StockIce, ANewConnectionWaitsUntilPreviousOnesHaveClosed) {
    Ice::CommunicatorHolder ic(world_.client());
    auto named = [&](const char* name) { return world_.proxy(ic.communicator(), name); };
    for (int i = 0; i < 10; ++i) {
        std::vector<Ice::ConnectionPtr> open;
        for (const char* name : {"a", "b", "c"})
            open.push_back(named(name)->ice_getConnection());
        for (const auto& connection : open)
            connection->close(Ice::ConnectionClose::Gracefully);
        EXPECT_EQ(named("d")->repeat(i, {1}), RadioTest::Bytes{1});
        named("d")->ice_getConnection()->close(Ice::ConnectionClose::GracefullyWithWait);
    }
}

TEST_F(StockIce, MoreProgramsThanChannelsShareThem) {
    std::vector<std::unique_ptr<Ice::CommunicatorHolder>> programs;
    for (int i = 0; i < 5; ++i) {
        programs.push_back(std::make_unique<Ice::CommunicatorHolder>(
            world_.client({{"XBeeAT.Idle", "1"}, {"Ice.RetryIntervals", "0"}})));
        world_.proxy(programs.back()->communicator())->ice_ping();
    }
    // the connection of this program was closed first
    world_.proxy(programs[0]->communicator())->ice_ping();
}

TEST_F(StockIce, AMissingUavCausesAConnectTimeout) {
    world_.rig.with([&] { world_.rig.uav.runs = false; });
    Ice::CommunicatorHolder ic(world_.client());
    auto echo = world_.proxy(ic.communicator())->ice_timeout(1500);
    EXPECT_THROW(echo->ice_ping(), Ice::ConnectTimeoutException);
    world_.rig.with([&] { world_.rig.uav.runs = true; });
    EXPECT_NO_THROW(world_.proxy(ic.communicator())->ice_ping());
}

TEST_F(StockIce, ATimedOutCallIsNeverExecuted) {
    Ice::CommunicatorHolder ic(world_.client({{"Ice.Override.ConnectTimeout", "1800000"}}));
    auto echo = world_.proxy(ic.communicator())->ice_timeout(2000)->ice_invocationTimeout(-2);
    echo->ice_ping();
    const auto take = world_.rig.uav.taking;
    world_.rig.with([&] { world_.rig.uav.taking = [](int, const U8*, U32) { return 1; }; });
    EXPECT_THROW(echo->note(1), Ice::LocalException);
    EXPECT_TRUE(world_.rig.until([&] { return world_.rig.uav.sessions() == 2; }));
    world_.rig.with([&] { world_.rig.uav.taking = take; });
    EXPECT_EQ(world_.proxy(ic.communicator())->noted(), 0);
}

// Ice 3.7 does not count the reference of its timer to a connection. If the connection ended
// otherwise while its time-out expired, the timer used freed memory, which aborted the program.
TEST_F(StockIce, AConnectionOutlivesItsTimeoutThatExpiresWhileItEnds) {
    HeldTimer timer;
    auto ic = world_.client({{"Ice.Override.CloseTimeout", "50"}, {"Ice.ACM.Timeout", "0"}},
                            timer.data());
    auto connection = world_.proxy(ic)->ice_getConnection();
    const std::weak_ptr<Ice::Connection> ended = connection;
    world_.rig.with([&] { world_.rig.uav.runs = false; });
    timer.hold();
    auto end = std::async(std::launch::async, [&] { ic->destroy(); });
    timer.waitUntilHeld(); // the UAV does not reply, so the time-out for closing expires
    connection->close(Ice::ConnectionClose::Forcefully);
    connection = nullptr;
    timer.waitUntilPoolsHaveEnded(); // these threads have no reference to the connection any more
    EXPECT_FALSE(ended.expired()) << "Ice's timer uses a connection that has been freed";
    timer.release();
    end.get();
    world_.rig.with([&] { world_.rig.uav.runs = true; });
    EXPECT_TRUE(ended.expired()) << "the connection is kept after the end of the communicator";
}

TEST_F(StockIce, CallsThatCannotBeBroadcastAreRefusedInTheCaller) {
    Ice::CommunicatorHolder ic(world_.client());
    auto all = Ice::uncheckedCast<RadioTest::UavPrx>(
        ic->stringToProxy("echo -o:" + world_.endpoint() + " -a 0xFFFF"));
    EXPECT_THROW(all->ice_twoway()->ice_ping(), Ice::UnknownLocalException);
    EXPECT_THROW(all->take(8, World::pattern(1, 79)), Ice::MemoryLimitException);
    EXPECT_NO_THROW(all->note(9)) << "a call after the error must succeed";
}

TEST_F(StockIce, EndpointsKeepTheirOptionsAndInvalidOptionsAreRefused) {
    Ice::CommunicatorHolder ic(world_.client());
    auto text = [&](const std::string& endpoint) {
        return ic->proxyToString(ic->stringToProxy("x:xbee-at " + endpoint));
    };
    std::string whole = text("-d \"/dev/a b\" -b 57600 -a 0x12 -s 3 -c 0x14 -i 0xBEEF -p 2 -t 7000 "
                             "-g 30 -k 0011AABB -h any");
    for (std::string part : {"-d \"/dev/a b\"", "-b 57600", "-a 0x12", "-s 0x3", "-c 0x14",
                             "-i 0xbeef", "-p 2", "-t 7000", "-g 30"})
        EXPECT_NE(whole.find(part), std::string::npos) << part << " in " << whole;
    EXPECT_EQ(whole.find("0011AABB"), std::string::npos) << "the key must not be printed";
    EXPECT_EQ(ic->proxyToString(ic->stringToProxy(whole)), whole);
    const std::string wired = "x -t -e 1.1:serial -d /dev/a -b 57600 -a 0x12 -s 0x3 -p 1 -t 7000";
    EXPECT_EQ(ic->proxyToString(ic->stringToProxy(wired)), wired);
    EXPECT_THROW(ic->stringToProxy("x:serial -d /dev/a -c 0x0C"), Ice::EndpointParseException);
    for (std::string wrong : {"-d", "-a 65536", "-a x", "-p 3", "-t -1", "-k 0g", "-y 1",
                              "-k 00112233445566778899AABBCCDDEEFF0"})
        EXPECT_THROW(text(wrong), Ice::EndpointParseException) << wrong;
}

} // namespace
