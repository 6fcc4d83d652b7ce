// SPDX-License-Identifier: MIT
//
// gateway_peers_test: the gateway beside ZeroC's own forwarders: it keeps of a call what IceBridge
// keeps, and facets, and programs reach it through a Glacier2 router.

#include "gateway_rig.h"
#include <Glacier2/Router.h>

namespace {

std::string textOf(const Ice::EncodingVersion& e) {
    return std::to_string(e.major) + "." + std::to_string(e.minor);
}

// Witness tells what it sees of a request. Its operation "fail" ends in a user exception.
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

// Returns what becomes of a call of the witness: its answer, or the exception's name.
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

// Returns what a program sees at an endpoint: a line a call.
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
    add(ask(at("nobody"), "ice_ping"));
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

// A server of ZeroC's that prints its endpoints.
int portOf(Server& server) {
    return server.port("127.0.0.1 -p ", " -t");
}

TEST_F(Gateway, KeepsOfACallWhatIceBridgeKeepsAndFacets) {
    world_.uav->addDefaultServant(std::make_shared<Witness>(), "witness");
    const std::string vehicle = endpoint(world_.uavPort);
    Server bridge({"icebridge", "--IceBridge.Source.Endpoints=tcp -h 127.0.0.1",
                   "--IceBridge.Target.Endpoints=" + vehicle, "--Ice.Trace.Network=2"});
    const int port = portOf(bridge);
    ASSERT_GT(port, 0) << bridge.said();
    const bool noFacets = false; // IceBridge 3.7.8 drops them
    EXPECT_EQ(tryAll(plain(), endpoint(port), noFacets), tryAll(plain(), vehicle, noFacets));
    start();
    EXPECT_EQ(tryAll(plain(), endpoint()), tryAll(plain(), vehicle));
}

// Programs have a session with the router, and the router calls at the gateway's machine, as
// docs/security.md shows it.
TEST_F(Gateway, IsReachedThroughAGlacier2Router) {
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
    EXPECT_THROW(echo->ice_ping(), Ice::LocalException) << "without a session";
    session->createSession("pilot", "");
    const auto data = World::pattern(1, 100);
    EXPECT_EQ(proxy(ic.communicator())->repeat(1, data), data);
    const auto other = ic->stringToProxy("nobody:" + endpoint());
    EXPECT_THROW(other->ice_ping(), Ice::ObjectNotExistException) << "the router's filter";
}

} // namespace
