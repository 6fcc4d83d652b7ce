// SPDX-License-Identifier: MIT
//
// gateway_rights_test: tests which calls clients may make through icesoc-gateway: calls to
// maintenance objects, rights by certificate, and which program receives the vehicle's calls.

#include "gateway_rig.h"
#include <IceSSL/IceSSL.h>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <unistd.h>

namespace {

// An object that has the type of maintenance objects.
struct Maintained : Ice::Object {
    bool ice_isA(std::string id, const Ice::Current&) const override {
        return id == "::IceSoC::Maintenance";
    }
    // counts the calls of the clients; the gateway itself calls only ice_isA
    std::string ice_id(const Ice::Current&) const override {
        ++calls;
        return ice_staticId();
    }
    mutable std::atomic<int> calls{0};
};

// A listener that answers each call with the same number.
struct Heard : RadioTest::Listener {
    explicit Heard(int result) : answer(result) {}
    int heard(int, const Ice::Current&) override {
        ++calls;
        return answer;
    }
    const int answer;
    std::atomic<int> calls{0};
};

TEST_F(Gateway, MaintenanceObjectsHaveASeparateEndpoint) {
    start({"--maintenance", "127.0.0.1:0"});
    ASSERT_TRUE(gateway_->hear("maintenance at port ")) << said();
    ASSERT_TRUE(gateway_->hear("\n"));
    const int door = std::atoi(said().c_str() + said().rfind("port ") + 5);
    const auto call = [&](const std::string& name, int at) {
        return [=] { ic_->stringToProxy(name + ":" + endpoint(at))->ice_id(); };
    };
    const auto servant = std::make_shared<Maintained>();
    for (const std::string name : {"keys", "update", "fpga", "x/any", "faceted"}) {
        const auto id = Ice::stringToIdentity(name);
        const std::string facet = name == "faceted" ? "f" : "";
        world_.uav->addFacet(servant, id, facet);
        const std::string proxy = name + (facet.empty() ? "" : " -f f");
        // Before the first call, the gateway asks the object for its type. For the second call it
        // uses the cached answer.
        for (int turn = 0; turn < 2; ++turn)
            expectRefusal(call(proxy, port_), "'" + name + "' is a maintenance object");
        EXPECT_EQ(whyFails(call(proxy, door)), "");
        const auto oneway = ic_->stringToProxy(proxy + " -o:" + endpoint());
        std::vector<Ice::Byte> out;
        oneway->ice_invoke("ice_id", Ice::OperationMode::Normal, {6, 0, 0, 0, 1, 1}, out);
    }
    EXPECT_EQ(whyFails(call("echo", door)), "");
    EXPECT_EQ(whyFails(call("echo", port_)), "");
    EXPECT_EQ(whyFails(call("missing", port_)), "::Ice::ObjectNotExistException");
    EXPECT_EQ(servant->calls, 5)
        << "the number of calls that arrived at the maintenance endpoint is wrong";
}

// ---- calls made by the vehicle ----

// A program with the object "listener", which the vehicle can call on the program's connection.
struct Program {
    Program(const std::string& at, int answer)
        : ic(program({{"Ice.Default.InvocationTimeout", "1800000"}, {"Ice.RetryIntervals", "-1"}})),
          heard(std::make_shared<Heard>(answer)) {
        adapter = ic->createObjectAdapter("");
        adapter->add(heard, Ice::stringToIdentity("listener"));
        adapter->activate();
        echo = Ice::uncheckedCast<RadioTest::UavPrx>(ic->stringToProxy("echo:" + at));
        echo->ice_getConnection()->setAdapter(adapter);
    }
    Ice::CommunicatorHolder ic;
    std::shared_ptr<Heard> heard;
    std::shared_ptr<Ice::ObjectAdapter> adapter;
    std::shared_ptr<RadioTest::UavPrx> echo;
};

// Passes a proxy of the program's object to an operation, as a program does to let the vehicle call
// this object later. Returns the reason why the gateway has refused the call; the vehicle rejects
// the call, because the operation has no such parameter.
std::string passListener(const Program& program, const std::string& operation) {
    Ice::OutputStream out(program.ic.communicator());
    out.startEncapsulation();
    out.write(0);
    out.write(std::shared_ptr<Ice::ObjectPrx>(
        program.adapter->createProxy(Ice::stringToIdentity("listener"))));
    out.endEncapsulation();
    std::vector<Ice::Byte> in, result;
    out.finished(in);
    return whyFails(
        [&] { program.echo->ice_invoke(operation, Ice::OperationMode::Normal, in, result); });
}

// Both programs have an object with the same name. The vehicle calls this name while it serves a
// call of one of the programs; the call must reach this program.
TEST_F(Gateway, ACallOfTheVehicleReachesOnlyItsAddressee) {
    start();
    Program one(endpoint(), 1), two(endpoint(), 10), idle(endpoint(), 100);
    one.echo->ice_ping();
    two.echo->ice_ping();
    for (int turn = 0; turn < 2; ++turn) {
        EXPECT_EQ(one.echo->callBack(3), 3);
        EXPECT_EQ(two.echo->callBack(3), 30);
    }
    EXPECT_EQ(one.heard->calls, 6);
    EXPECT_EQ(two.heard->calls, 6);
    EXPECT_EQ(idle.heard->calls, 0);
    // every client may call ice_ping, so its parameters do not count as passed objects
    passListener(idle, "ice_ping");
    EXPECT_EQ(two.echo->callBack(1), 10);
    passListener(one, "fetch");
    EXPECT_EQ(two.echo->callBack(1), 1) << "only one client has passed this object";
    passListener(two, "fetch");
    EXPECT_THROW(two.echo->callBack(1), Ice::Exception)
        << "two clients have passed this object, so the call must fail";
    for (const Program* program : {&one, &two})
        program->ic->destroy();
    EXPECT_THROW(idle.echo->callBack(1), Ice::Exception) << "the owners of the object have left";
    EXPECT_EQ(idle.heard->calls, 0);
}

// Without certificates, the host is the subject of a client. Another subject that knows the
// identity of a client's object cannot receive or block the vehicle's calls while the client is
// connected.
TEST_F(Gateway, AClientOfAnotherSubjectCannotPassTheSameObject) {
    start();
    Program owner(endpoint(), 1), caller(endpoint(), 100);
    Program other(endpoint() + " --sourceAddress 127.0.0.2", 10);
    passListener(owner, "fetch");
    const std::string why = passListener(other, "fetch");
    EXPECT_NE(why.find("a proxy of 'listener' belongs to another client"), std::string::npos)
        << why;
    EXPECT_EQ(other.echo->repeat(1, {1}), RadioTest::Bytes{1}) << "other calls are not affected";
    EXPECT_EQ(caller.echo->callBack(1), 1) << "the owner must receive the calls";
    EXPECT_EQ(other.heard->calls, 0);
    // With encoding 1.0, a text before zeros looks like a proxy. Two clients may pass it.
    const std::vector<Ice::Byte> text{21,  0, 0, 0, 1, 0, 5, 'p', 'i', 'l', 'o',
                                      't', 0, 0, 0, 0, 0, 0, 0,   0,   0};
    for (const Program* program : {&owner, &other}) {
        std::vector<Ice::Byte> result;
        const std::string refused = whyFails([&] {
            program->echo->ice_encodingVersion(Ice::Encoding_1_0)
                ->ice_invoke("fetch", Ice::OperationMode::Normal, text, result);
        });
        EXPECT_EQ(refused.find("belongs to another client"), std::string::npos) << refused;
    }
    // A one-way call has no reply, so its connection is closed.
    other.echo = other.echo->ice_oneway();
    const auto connection = other.echo->ice_getConnection();
    passListener(other, "note");
    std::string closed;
    for (int calls = 0; calls < 100 && closed.empty(); ++calls) {
        caller.echo->ice_ping();
        closed = whyFails([&] { connection->throwException(); });
    }
    EXPECT_NE(closed, "") << "the connection was not closed";
    EXPECT_EQ(caller.echo->callBack(1), 1);
    // After the owner has disconnected, the name is free again.
    owner.ic->destroy();
    other.echo = other.echo->ice_twoway();
    std::string last = "belongs to another client";
    for (int calls = 0; calls < 100 && last.find("another client") != std::string::npos; ++calls) {
        caller.echo->ice_ping();
        last = passListener(other, "fetch");
    }
    EXPECT_EQ(last.find("belongs to another client"), std::string::npos) << last;
}

// With TLS, the gateway knows the subject of a client's certificate. `./icesoc key FILE
// --certificate` makes the certificates.
TEST_F(Gateway, ACertificateIdentifiesTheCaller) {
    const std::string folder = testing::TempDir() + "gateway_tls." + std::to_string(getpid());
    std::filesystem::create_directories(folder + "/others");
    for (const std::string name : {"gateway", "pilot", "observer", "others/pilot"})
        ASSERT_EQ(std::system((ICESOC " key " + folder + "/" + name + ".pem --certificate >" +
                               folder + "/said")
                                  .c_str()),
                  0);
    std::ofstream(folder + "/rights")
        << R"([{"who": "CN=pilot", "identities": ["*"], "operations": ["*"]},
               {"who": "CN=observer", "identities": ["echo"], "operations": ["fetch"]}])";
    const std::string authority = folder + "/authority.pem";
    start({"--rights", folder + "/rights", "--IceSSL.CAs=" + authority,
           "--IceSSL.CertFile=" + folder + "/gateway.pem"},
          "ssl -h 127.0.0.1 -p 0");
    const auto call = [&](const std::string& name, bool repeats) {
        Ice::registerIceSSL();
        std::map<std::string, std::string> properties = {
            {"Ice.Plugin.IceSSL", "IceSSL:createIceSSL"},
            {"Ice.RetryIntervals", "-1"},
            {"IceSSL.CAs", authority}};
        if (!name.empty())
            properties["IceSSL.CertFile"] = folder + "/" + name + ".pem";
        Ice::CommunicatorHolder ic(program(properties));
        auto echo = Ice::uncheckedCast<RadioTest::UavPrx>(
            ic->stringToProxy("echo:ssl -h 127.0.0.1 -t 1800000 -p " + std::to_string(port_)));
        return whyFails([&] {
            if (repeats)
                echo->repeat(1, {1, 2});
            else
                echo->fetch(1);
        });
    };
    EXPECT_EQ(call("pilot", true), "");
    EXPECT_EQ(call("observer", false), "");
    EXPECT_NE(call("observer", true).find("'CN=observer' has no right to call repeat of 'echo'"),
              std::string::npos);
    EXPECT_NE(call("", false), "") << "a client without a certificate must be refused";
    EXPECT_NE(call("others/pilot", false), "")
        << "a certificate of another authority must be refused";
    std::filesystem::remove_all(folder);
}

TEST_F(Gateway, RightsRestrictCalls) {
    const std::string rights = testing::TempDir() + "gateway_rights.json";
    std::ofstream(rights)
        << R"([{"who": "", "identities": ["ec*"], "operations": ["repeat", "note*"]}])";
    start({"--rights", rights});
    expectAnswer();
    EXPECT_EQ(echo_->noted(), 0);
    EXPECT_EQ(whyFails([&] { echo_->ice_ping(); }), "");
    expectRefusal([&] { echo_->fetch(1); }, "has no right to call fetch of 'echo'");
    expectRefusal([&] { ic_->stringToProxy("other:" + endpoint())->ice_ping(); }, "has no right");
}

} // namespace
