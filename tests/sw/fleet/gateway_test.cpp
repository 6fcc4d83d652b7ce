// SPDX-License-Identifier: MIT
//
// gateway_test: tests icesoc-gateway between the radio and stock Ice programs without the plugin,
// and compares it with ZeroC's forwarders. The gateway must preserve the same parts of a call as
// IceBridge, and also facets. Programs must be able to reach it through a Glacier2 router.
// (bench.load tests many clients at once; test_ground_engine tests a modem that disappears and
// returns.)

#include "gateway_rig.h"
#include <Glacier2/Router.h>
#include <algorithm>
#include <atomic>
#include <chrono>
#include <fstream>
#include <iostream>
#include <thread>
#include <utility>

namespace {

TEST_F(Gateway, TheUavCallsTheStationThroughTheGateway) {
    auto adapter = ic_->createObjectAdapterWithEndpoints("Station", "tcp -h 127.0.0.1");
    adapter->add(std::make_shared<ListenerServant>(), Ice::stringToIdentity("station"));
    adapter->activate();
    auto info =
        std::dynamic_pointer_cast<Ice::TCPEndpointInfo>(adapter->getEndpoints()[0]->getInfo());
    start({"-t", "1", "--station", "127.0.0.1:" + std::to_string(info->port)});
    EXPECT_EQ(echo_->callStation(10), 90);
    // If no server listens at --station, the UAV gets an error, and the gateway continues.
    adapter->destroy();
    EXPECT_ANY_THROW(echo_->callStation(1));
    expectAnswer();
    EXPECT_EQ(stop(), 0);
    EXPECT_TRUE(hasPrinted("no server listens at 127.0.0.1"));
}

// Stores the proxy that the vehicle passes with vehicleState.
struct Station : Ice::Blobject {
    bool ice_invoke(std::vector<Ice::Byte> in, std::vector<Ice::Byte>& out,
                    const Ice::Current& current) override {
        const auto ic = current.adapter->getCommunicator();
        Ice::InputStream parameters(ic, in);
        parameters.startEncapsulation();
        parameters.read(vehicle);
        Ice::OutputStream answer(ic);
        answer.startEncapsulation();
        answer.endEncapsulation();
        answer.finished(out);
        return true;
    }
    std::shared_ptr<Ice::ObjectPrx> vehicle;
};

TEST_F(Gateway, TheStationGetsAProxyOfTheVehicle) {
    const auto station = std::make_shared<Station>();
    auto adapter = ic_->createObjectAdapterWithEndpoints("Station", "tcp -h 127.0.0.1");
    adapter->add(station, Ice::stringToIdentity("station"));
    adapter->activate();
    auto info =
        std::dynamic_pointer_cast<Ice::TCPEndpointInfo>(adapter->getEndpoints()[0]->getInfo());
    start({"--station", "127.0.0.1:" + std::to_string(info->port)});
    expectAnswer(2); // waits until the link has a session
    const auto vehicles = world_.uav->getCommunicator();
    Ice::OutputStream out(vehicles);
    out.startEncapsulation();
    // The address in this proxy's endpoint does not exist on the ground.
    out.write(vehicles->stringToProxy("echo:opaque -t 16728 -e 1.1 -v AQD/ECcAAA=="));
    out.writeSize(0);
    out.endEncapsulation();
    std::vector<Ice::Byte> in, result;
    out.finished(in);
    ASSERT_TRUE(vehicles->stringToProxy(world_.echo->station)
                    ->ice_invoke("vehicleState", Ice::OperationMode::Normal, in, result));
    ASSERT_NE(station->vehicle, nullptr);
    const auto reached = Ice::uncheckedCast<RadioTest::UavPrx>(station->vehicle);
    EXPECT_EQ(reached->repeat(1, {1, 2}), (RadioTest::Bytes{1, 2}));
}

TEST_F(Gateway, ListensAtAnIPv6Address) {
    if (std::ifstream("/proc/net/if_inet6").peek() == EOF)
        GTEST_SKIP() << "this machine has no IPv6";
    start({}, "[::1]:0");
    echo_ = Ice::uncheckedCast<RadioTest::UavPrx>(
        ic_->stringToProxy("echo:tcp -h \"::1\" -t 1800000 -p " + std::to_string(port_)));
    expectAnswer();
}

// ---- sharing the radio ----

TEST_F(Gateway, OnewayCallsArriveAlthoughTheirClientDisconnects) {
    // a call with a long --wait does not fail even if it has to wait on a slow machine
    start({"--wait", "600"});
    constexpr int count = 1000;
    {
        Ice::CommunicatorHolder ic(plain());
        auto echo = proxy(ic.communicator())->ice_oneway();
        for (int i = 0; i < count; ++i)
            echo->note(i);
        echo->ice_getConnection()->close(Ice::ConnectionClose::GracefullyWithWait);
    }
    expectNoted(count);
    EXPECT_EQ(world_.echo->twice(), 0);
}

TEST_F(Gateway, AFloodLeavesRoomForOtherClients) {
    start();
    Ice::CommunicatorHolder flooding(plain());
    auto flood = proxy(flooding.communicator())->ice_oneway();
    echo_->ice_ping();
    for (int i = 0; i < 2000; ++i)
        flood->noteAsync(i);
    expectAnswer(9999);
    EXPECT_LT(echo_->noted(), 1000)
        << "too many calls of the flood came before the other client's call";
}

// Returns the durations of calls in simulated time, ms, sorted.
std::vector<double> timesOf(World& world, const std::shared_ptr<RadioTest::UavPrx>& echo,
                            int calls) {
    const auto now = [&world] {
        double ms = 0;
        world.rig.with([&] { ms = static_cast<double>(world.rig.ns()) / 1e6; });
        return ms;
    };
    std::vector<double> times;
    for (int i = 0; i < calls; ++i) {
        const double begun = now();
        echo->ice_ping();
        times.push_back(now() - begun);
    }
    std::sort(times.begin(), times.end());
    return times;
}

// A hundred connections from another host send long one-way calls continuously; a normal client
// must still be served.
TEST_F(Gateway, AHundredFloodingConnectionsLeaveAGoodClientItsShare) {
    start();
    constexpr int connections = 100, calls = 100;
    timesOf(world_, echo_, 5);
    const auto alone = timesOf(world_, echo_, calls);
    Ice::CommunicatorHolder flooding(program({{"Ice.Default.InvocationTimeout", "1800000"},
                                              {"Ice.RetryIntervals", "-1"},
                                              {"Ice.Override.CloseTimeout", "500"}}));
    const std::vector<Ice::Byte> bytes(7000);
    std::atomic<bool> isOver{false};
    std::atomic<int> sent{0};
    std::vector<std::thread> floods;
    for (int i = 0; i < connections; ++i)
        floods.emplace_back([&, i] {
            const auto proxy =
                flooding->stringToProxy("echo -o:" + endpoint() + " --sourceAddress 127.0.0.2")
                    ->ice_connectionId(std::to_string(i));
            std::vector<Ice::Byte> in{0, 0, 0, 0, 1, 1}, out;
            in.insert(in.end(), bytes.begin(), bytes.end());
            for (int shift = 0; shift < 4; ++shift)
                in[size_t(shift)] = static_cast<Ice::Byte>(in.size() >> 8 * shift);
            while (!isOver)
                try {
                    ++sent;
                    proxy->ice_invoke("note", Ice::OperationMode::Normal, in, out);
                } catch (const Ice::LocalException&) { // the gateway already has too many requests
                    std::this_thread::sleep_for(std::chrono::milliseconds(50));
                }
        });
    for (int tries = 0; tries < 3000 && sent < 2 * connections; ++tries)
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    EXPECT_GE(sent, 2 * connections) << "too few calls of the flood were carried out";
    const auto crowded = timesOf(world_, echo_, calls);
    isOver = true;
    EXPECT_EQ(stop(), 0);
    flooding->destroy();
    for (auto& flood : floods)
        flood.join();
    RecordProperty("alone_ms", std::to_string(alone[calls - 2]));
    RecordProperty("crowded_ms", std::to_string(crowded[calls - 2]));
    std::cout << "99 of 100: alone " << alone[calls - 2] << " ms, crowded " << crowded[calls - 2]
              << " ms; medians " << alone[calls / 2] << " and " << crowded[calls / 2] << " ms\n";
    EXPECT_LE(crowded[calls / 2], 6 * alone[calls / 2]);
}

// Ice 3.8 closes a connection on which nothing has arrived for a minute.
TEST_F(Gateway, AnIdleClientGetsHeartbeats) {
    start({"--Ice.ACM.Timeout=2"}); // time-out, s; heartbeats are sent after half of this time
    const int client = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_port = htons(static_cast<uint16_t>(port_));
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    ASSERT_EQ(connect(client, reinterpret_cast<sockaddr*>(&to), sizeof to), 0);
    const timeval patience{30, 0};
    setsockopt(client, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    for (int message = 0; message < 3; ++message) { // the first message opens the connection
        unsigned char header[14] = {};
        ASSERT_EQ(recv(client, header, sizeof header, MSG_WAITALL), ssize_t(sizeof header))
            << "message " << message;
        EXPECT_EQ(header[8], 3) << "ValidateConnection";
    }
    close(client);
}

TEST_F(Gateway, ATooLongCallFailsWithTheLimit) {
    start();
    expectRefusal([&] { echo_->repeat(1, RadioTest::Bytes(9000)); }, "8192");
    expectAnswer(2);
}

TEST_F(Gateway, CompressedCallsArrive) {
    start();
    echo_ = echo_->ice_compress(true);
    EXPECT_EQ(echo_->repeat(1, RadioTest::Bytes(2000)), RadioTest::Bytes(2000));
    auto batch = echo_->ice_batchOneway();
    for (int i = 0; i < 30; ++i)
        batch->note(100 + i);
    batch->ice_flushBatchRequests();
    // waits, because the server has several threads, which may serve later calls first
    expectNoted(30);
}

TEST_F(Gateway, ACallWithoutAModemFailsWithTheReason) {
    world_.rig.with([&] { world_.rig.ground->power(false, world_.rig.ns()); });
    start();
    expectRefusal([&] { echo_->ice_ping(); },
                  "icesoc-gateway: cannot reach the vehicle: the modem is lost or does not answer");
}

// One-way calls to an absent vehicle are discarded after --wait, even if their program has ended.
TEST_F(Gateway, AOnewayCallThatWaitsTooLongIsNeverExecuted) {
    start({"--wait", "3"});
    const auto power = [&](bool isOn) {
        world_.rig.with([&] { world_.rig.uav.modem->power(isOn, world_.rig.ns()); });
    };
    power(false);
    {
        Ice::CommunicatorHolder ic(plain());
        proxy(ic.communicator())->ice_oneway()->note(1);
    }
    auto batch = echo_->ice_batchOneway();
    batch->note(2);
    batch->note(3);
    batch->ice_flushBatchRequests();
    // this call waits until the calls before it have been handled
    expectRefusal([&] { echo_->ice_ping(); }, "waited 3 s for the radio");
    power(true);
    int noted = -1;
    for (int tries = 0; tries < 50 && noted < 0; ++tries) // repeated until the link has a session
        try {
            noted = echo_->noted();
        } catch (const Ice::LocalException&) {
        }
    EXPECT_EQ(noted, 0);
    stop();
    // sum of the numbers of dropped calls, which are in one or two lines of the log
    int dropped = 0;
    for (size_t at = 0; (at = said().find("were not sent: ", at)) != std::string::npos;)
        dropped += std::atoi(said().c_str() + (at += 15));
    EXPECT_EQ(dropped, 3) << said();
}

TEST(GatewayOptions, WrongOptionsAreRefusedByName) {
    // A key file with a byte order mark and a carriage return, as editors of Windows write it, is
    // not an error; the error is then the device.
    const std::string key = testing::TempDir() + "gateway_modem_key." + std::to_string(getpid());
    std::ofstream(key) << "\xEF\xBB\xBF"
                          "0011\r\n";
    ASSERT_EQ(chmod(key.c_str(), 0600), 0);
    const std::pair<std::multimap<std::string, std::string>, std::string> cases[] = {
        {{}, "it is not a serial port"},
        {{{"-d", "/dev/no-such-port"}}, "No such file"},
        {{{"-l", "nonsense"}}, "expected HOST:PORT"},
        {{{"-l", "127.0.0.1:70000"}}, "expected a port of 0 to 65535"},
        {{{"-l", "[::1"}}, "[::1"},
        {{{"-l", "tcp -h 127.0.0.1 -p 99999999999"}}, "99999999999"},
        {{{"--modem-key", key}}, "it is not a serial port"},
        {{{"-a", "65536"}}, "--address"},
        {{{"--key", "/no/such/file"}}, "openssl rand -hex 16"},
        {{{"--modem-key", "/no/such/file"}}, "No such file"},
        {{{"--wait", "-5"}}, "--wait"},
        {{{"--rights", "/no/such/file"}}, "cannot read rights file"},
        {{{"-l", "0.0.0.0:0"}}, "accepts unencrypted calls from other machines"},
        {{{"--maintenance", "tcp -p 0"}}, "accepts unencrypted calls from other machines"},
        {{{"--vehicle", "uav7=x"}}, "expected NAME=ADDRESS"},
        {{{"--vehicle", "uav7=99999999999999999999"}}, "expected NAME=ADDRESS"},
        {{{"--vehicle", "uav8=0x0007"}, {"--vehicle", "uav7=7"}},
         "--vehicle uav7=7: vehicle 'uav8' already has this address"},
        {{{"--vehicle", "all=0xFFFF"}}, "--vehicle all=0xFFFF: 0xFFFF means all vehicles"},
        {{{"--topics", "t:tcp -h 127.0.0.1 -p 1"}}, "refused"},
        {{{"--station", "x"}}, "expected HOST:PORT"}};
    for (auto [options, said] : cases) {
        for (const auto& [name, value] : {std::pair("-d", "/dev/null"), {"-l", "127.0.0.1:0"}})
            if (!options.count(name))
                options.emplace(name, value);
        std::vector<std::string> words{GATEWAY};
        for (const auto& [name, value] : options)
            words.insert(words.end(), {name, value});
        Server gateway(words);
        EXPECT_GT(gateway.wait(), 0) << said;
        EXPECT_NE(gateway.said().find(said), std::string::npos) << gateway.said();
        // texts that a message must not contain: a place in the source, a class name
        for (const char* internal : {".h:", ".cpp:", "::Ice::"})
            EXPECT_EQ(gateway.said().find(internal), std::string::npos) << gateway.said();
    }
    std::remove(key.c_str());
}

TEST(GatewayOptions, AnUnknownOptionIsReportedEvenIfTheDeviceIsMissing) {
    for (const auto& [words, expected] :
         {std::pair<std::vector<std::string>, std::string>{{GATEWAY, "--wrong"}, "--wrong"},
          {{GATEWAY}, "--device is required"}}) {
        Server gateway(words);
        EXPECT_GT(gateway.wait(), 0);
        EXPECT_NE(gateway.said().find(expected), std::string::npos) << gateway.said();
    }
}

std::string textOf(const Ice::EncodingVersion& e) {
    return std::to_string(e.major) + "." + std::to_string(e.minor);
}

// Records the data of each request. The operation "fail" throws a user exception.
class Witness : public Ice::Blobject {
public:
    bool ice_invoke(std::vector<Ice::Byte> in, std::vector<Ice::Byte>& out,
                    const Ice::Current& current) override {
        std::string seen = Ice::identityToString(current.id) + " " + current.facet + " " +
                           current.operation + " " +
                           std::to_string(static_cast<int>(current.mode)) + " " +
                           textOf(current.encoding) + " " + std::to_string(in.size());
        for (const auto& [key, value] : current.ctx)
            seen += " " + key + "=" + value;
        Ice::OutputStream answer(current.adapter->getCommunicator(), current.encoding);
        answer.startEncapsulation();
        answer.write(seen);
        answer.endEncapsulation();
        answer.finished(out);
        return current.operation != "fail";
    }
};

// Calls a Witness. Returns its reply, or the name of the exception.
std::string ask(const std::shared_ptr<Ice::ObjectPrx>& proxy, const std::string& operation,
                Ice::OperationMode mode = Ice::OperationMode::Normal,
                const Ice::Context& context = {}, const std::vector<Ice::Byte>& in = {}) {
    try {
        std::vector<Ice::Byte> out;
        const bool isOk = proxy->ice_invoke(operation, mode, in, out, context);
        std::string seen;
        if (proxy->ice_isTwoway()) {
            Ice::InputStream answer(proxy->ice_getCommunicator(), out);
            answer.startEncapsulation();
            answer.read(seen);
            answer.endEncapsulation();
        }
        return (isOk ? "answer: " : "exception: ") + seen;
    } catch (const Ice::RequestFailedException& e) {
        return e.ice_id() + " " + Ice::identityToString(e.id) + " " + e.facet + " " + e.operation;
    } catch (const Ice::Exception& e) {
        return e.ice_id();
    }
}

// Makes several calls to an endpoint. Returns the results, one line per call.
std::string tryAll(const Ice::CommunicatorPtr& communicator, const std::string& endpoint,
                   bool facets = true) {
    const Ice::CommunicatorHolder ic(communicator);
    const auto at = [&](const std::string& name) {
        return ic->stringToProxy(name + ":" + endpoint);
    };
    const auto witness = at("witness/one");
    const std::vector<Ice::Byte> empty{6, 0, 0, 0, 1, 1};
    std::string seen;
    const auto add = [&seen](const std::string& line) { seen += line + "\n"; };
    add(ask(witness, "plain"));
    add(ask(witness, "again", Ice::OperationMode::Idempotent));
    add(ask(witness, "context", Ice::OperationMode::Normal, {{"from", "ground"}, {"empty", ""}}));
    add(ask(witness, "parameters", Ice::OperationMode::Normal, {}, empty));
    add(ask(witness->ice_encodingVersion(Ice::Encoding_1_0), "old"));
    add(ask(witness, "fail"));
    add(ask(at(R"("witness/a na\/me")"), "plain"));
    if (facets) {
        add(ask(witness->ice_facet("a facet"), "faceted"));
        add(ask(at("echo -f nothing"), "ice_ping"));
    }
    add(ask(at("missing"), "ice_ping"));
    add(ask(at("echo"), "nothing"));
    const auto echo = Ice::uncheckedCast<RadioTest::UavPrx>(at("echo"));
    for (const auto& id : echo->ice_ids())
        add(id);
    const int before = echo->noted();
    const auto oneway = echo->ice_oneway(), batch = echo->ice_batchOneway();
    for (int i = 0; i < 20; ++i)
        (i % 2 ? oneway : batch)->note(1000 + i);
    batch->ice_flushBatchRequests();
    int after = before;
    for (int calls = 0; calls < 1000 && after < before + 20; ++calls)
        after = echo->noted();
    add("noted: " + std::to_string(after - before));
    const auto adapter = ic->createObjectAdapter("");
    adapter->add(std::make_shared<ListenerServant>(), Ice::stringToIdentity("listener"));
    adapter->activate();
    echo->ice_getConnection()->setAdapter(adapter);
    add("called back: " + std::to_string(echo->callBack(10)));
    return seen;
}

// Returns the port of one of ZeroC's servers, taken from the endpoints that it prints.
int portOf(Server& server) {
    return server.port("127.0.0.1 -p ", " -t");
}

TEST_F(Gateway, PreservesACallAsIceBridgeDoesAndFacets) {
    world_.uav->addDefaultServant(std::make_shared<Witness>(), "witness");
    const std::string vehicle = endpoint(world_.uavPort);
    Server bridge({"icebridge", "--IceBridge.Source.Endpoints=tcp -h 127.0.0.1",
                   "--IceBridge.Target.Endpoints=" + vehicle, "--Ice.Trace.Network=2"});
    const int port = portOf(bridge);
    ASSERT_GT(port, 0) << bridge.said();
    const bool noFacets = false; // IceBridge 3.7.8 drops facets
    EXPECT_EQ(tryAll(plain(), endpoint(port), noFacets), tryAll(plain(), vehicle, noFacets));
    start();
    EXPECT_EQ(tryAll(plain(), endpoint()), tryAll(plain(), vehicle));
}

// A program opens a session with the router. The router passes the program's calls to the gateway,
// which runs on the same machine as the router (see the drawing in docs/security.md).
TEST_F(Gateway, IsReachableThroughAGlacier2Router) {
    start();
    Server router({"glacier2router", "--Glacier2.Client.Endpoints=tcp -h 127.0.0.1",
                   "--Glacier2.InstanceName=Glacier2",
                   "--Glacier2.PermissionsVerifier=Glacier2/NullPermissionsVerifier",
                   "--Glacier2.Filter.Identity.Accept=echo", "--Ice.Trace.Network=2"});
    const int port = portOf(router);
    ASSERT_GT(port, 0) << router.said();
    Ice::CommunicatorHolder ic(plain());
    const auto session = Ice::checkedCast<Glacier2::RouterPrx>(
        ic->stringToProxy("Glacier2/router:" + endpoint(port)));
    ic->setDefaultRouter(session);
    const auto echo = proxy(ic.communicator());
    EXPECT_THROW(echo->ice_ping(), Ice::LocalException)
        << "a client without a session must be refused";
    session->createSession("pilot", "");
    const auto data = World::pattern(1, 100);
    EXPECT_EQ(proxy(ic.communicator())->repeat(1, data), data);
    const auto other = ic->stringToProxy("missing:" + endpoint());
    EXPECT_THROW(other->ice_ping(), Ice::ObjectNotExistException)
        << "the filter of the router must hide this object";
}

} // namespace
