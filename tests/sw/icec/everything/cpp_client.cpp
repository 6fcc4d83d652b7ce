// SPDX-License-Identifier: MIT
//
// cpp_client: stock ZeroC Ice in C++ (C++11 mapping): every type, exception and mode of
// Everything.ice.
//
//   cpp_client [slow] PORT|ENDPOINT [Ice's options]    `slow`: fewer, smaller calls

#include "Everything.h"
#include <Ice/Ice.h>
#include <cstring>
#include <iostream>

namespace {

using namespace Everything;
using Strings = Everything::Strings;
using TesterPtr = std::shared_ptr<TesterPrx>;

#define CHECK(condition)                                                  \
    do {                                                                  \
        if (!(condition))                                                 \
            throw std::runtime_error("line " + std::to_string(__LINE__) + \
                                     ": not true: " #condition);          \
    } while (0)

template <class Exception, class F> Exception thrown(int line, F f) {
    try {
        f();
    } catch (const Exception& e) {
        return e;
    }
    throw std::runtime_error("line " + std::to_string(line) +
                             ": not thrown: " + typeid(Exception).name());
}
#define THROWN(Exception, call) thrown<Exception>(__LINE__, [&] { call; })

Numbers numbers(int i = 1) {
    return {true, 200, static_cast<short>(-3 * i), 1 << 30, -(1LL << 62) + i, 0.5F, -1e300};
}

// Compares proxies by their strings: IceC and Ice may encode endpoints differently.
bool alike(const std::shared_ptr<Ice::ObjectPrx>& a, const std::shared_ptr<Ice::ObjectPrx>& b) {
    return a ? b && a->ice_toString() == b->ice_toString() : !b;
}

bool alike(const Mixed& a, const Mixed& b) {
    return a.text == b.text && a.small == b.small && a.wide == b.wide && a.numbers == b.numbers &&
           alike(a.proxy, b.proxy);
}

class WatcherI : public Watcher {
public:
    void progress(int, const Ice::Current&) override {}
    int ask(int question, const Ice::Current&) override { return 10 * question; }
};

struct Peer {
    Ice::CommunicatorPtr ic;
    TesterPtr t;
    bool slow, overTcp, is11;

    void types();
    void classes();
    void exceptions();
    void targets();
    void asynchronous();
    void oneways();
};

void Peer::types() {
    Numbers n = numbers(), same;
    CHECK(t->echoNumbers(n, same) == n && same == n);
    auto version = t->ice_getEncodingVersion(); // 1.0 does not carry a proxy's own
    auto sent = [&](const std::string& text) {
        auto p = ic->stringToProxy(text);
        return p ? p->ice_encodingVersion(version) : p;
    };
    Proxies proxies;
    for (const char* text :
         {"", "cat/other -f facet -o:tcp -h 127.0.0.1 -p 9:opaque -t 99 -e 1.0 -v QUI=",
          "x @ adapter", "y -s", "z:udp -h 127.0.0.1 -p 7"}) {
        CHECK(alike(t->echoProxy(ic->stringToProxy(text)), sent(text)));
        proxies.push_back(sent(text));
    }
    Proxies back = t->echoProxies(proxies);
    CHECK(std::equal(back.begin(), back.end(), proxies.begin(), proxies.end(),
                     [](auto& a, auto& b) { return alike(a, b); }));
    Mixed m{"text \u00e9", Small::two, Wide::far, n, proxies[1]};
    CHECK(alike(t->echoMixed(m), m));
    Mixeds mixeds{m, {"", Small::three, Wide::near, numbers(2), nullptr}};
    int count = 0;
    Mixeds mixedsBack = t->echoMixeds(mixeds, count);
    CHECK(count == 2 && mixedsBack.size() == 2);
    CHECK(alike(mixedsBack[0], m) && alike(mixedsBack[1], mixeds[1]));

    Tester::EchoSequencesResult in{{true, false},
                                   {-1, 32767},
                                   {5, -6},
                                   {1LL << 40, -1},
                                   {0.25F, -1.5F},
                                   {1e-300, 2.5},
                                   {"a", "", "\u4e2d"},
                                   {{"x"}, {}, {"y", "z"}}};
    Tester::EchoSequencesResult out;
    t->echoSequences(in.aa, in.bb, in.cc, in.dd, in.ee, in.ff, in.gg, in.hh, //
                     out.aa, out.bb, out.cc, out.dd, out.ee, out.ff, out.gg, out.hh);
    CHECK(in.aa == out.aa && in.bb == out.bb && in.cc == out.cc && in.dd == out.dd);
    CHECK(in.ee == out.ee && in.ff == out.ff && in.gg == out.gg && in.hh == out.hh);
    CHECK((t->echoCounts({{"a", 1}, {"b", -2}}) == Counts{{"a", 1}, {"b", -2}}));
    CHECK((t->echoLists({{1, {"one"}}, {2, {}}}) == Lists{{1, {"one"}}, {2, {}}}));
    for (size_t size : {0, 1, 254, 255, 256, 1000, 4000, 8000, 8092}) {
        if (slow && size > 1000)
            break;
        Bytes data(size, static_cast<Ice::Byte>(size));
        CHECK(t->echoBytes(data) == data);
    }

    Ice::optional<std::string> a;
    Ice::optional<Numbers> b;
    Ice::optional<Ints> c;
    auto result = t->echoOptionals(5, std::string("a"), n, Ints{1, 2, 3}, a, b, c);
    CHECK(is11 == !!result && is11 == !!a && is11 == !!b && is11 == !!c);
    CHECK(!is11 || (*result == 5 && *a == "a" && *b == n && *c == (Ints{1, 2, 3})));
    result = t->echoOptionals(0, Ice::nullopt, n, Ice::nullopt, a, b, c);
    CHECK(!result && !a && !c && is11 == !!b);
}

void Peer::classes() {
    CHECK(!t->echoNode(nullptr));
    auto first = std::make_shared<Node>(1, nullptr);
    auto leaf = std::make_shared<Leaf>(2, first, "leaf", Ice::optional<int>(9)); // a cycle
    first->next = leaf;
    auto got = t->echoNode(first);
    auto gotLeaf = std::dynamic_pointer_cast<Leaf>(got->next);
    CHECK(got->id == 1 && gotLeaf && gotLeaf->name == "leaf" && gotLeaf->next == got);
    CHECK(is11 == !!gotLeaf->weight && (!is11 || *gotLeaf->weight == 9));
    for (auto& n : {first, got})
        n->next = nullptr; // or they keep each other alive
}

void Peer::exceptions() {
    t->fail(0);
    CHECK(THROWN(Failure, t->fail(1)).reason == "as asked");
    for (auto call : {&TesterPrx::fail, &TesterPrx::failSliced}) {
        Worse e = THROWN(Worse, ((*t).*call)(2, Ice::noExplicitContext));
        CHECK(e.reason == "worse" && e.how == 7);
    }
    Unrelated e = THROWN(Unrelated, t->fail(3));
    CHECK(e.counts == (Counts{{"key", -1}}) && !e.hint);
    Unrelated hinted = THROWN(Unrelated, t->fail(4));
    CHECK(is11 ? hinted.hint && *hinted.hint == "hint" : !hinted.hint);
    CHECK(THROWN(Ice::ObjectNotExistException, t->fail(11)).id.name == "tester");
    CHECK(THROWN(Ice::FacetNotExistException, t->fail(12)).operation == "fail");
    CHECK(THROWN(Ice::OperationNotExistException, t->fail(13)).id.name == "tester");
    THROWN(Ice::UnknownException, t->fail(15));
    THROWN(Ice::UnknownLocalException, t->fail(16));
    THROWN(Ice::UnknownUserException, t->fail(23));
    // An idempotent operation that is called as a normal one is refused.
    Ice::ByteSeq none{6, 0, 0, 0, 1, static_cast<Ice::Byte>(is11)}, out;
    THROWN(Ice::UnknownLocalException,
           t->ice_invoke("echoNumbers", Ice::OperationMode::Normal, none, out));
}

void Peer::targets() {
    CHECK((t->ice_ids() == Strings{"::Everything::Tester", "::Ice::Object"}));
    CHECK(t->ice_id() == "::Everything::Tester" && !t->ice_isA("::Everything::Watcher"));
    CHECK(!Ice::checkedCast<WatcherPrx>(t));
    CHECK(t->context("who", {{"a", "b"}, {"who", "me"}}) == "me" && t->context("who") == "-");
    CHECK(t->ice_context({{"who", "proxy"}})->context("who") == "proxy");
    CHECK(Ice::checkedCast<TesterPrx>(t, "side")->whoAmI() == "/tester -f side mode 0");
    auto other = Ice::uncheckedCast<TesterPrx>(t->ice_identity({"whoever", "any"}));
    CHECK(other->whoAmI() == "any/whoever -f  mode 0");
    THROWN(Ice::FacetNotExistException, t->ice_facet("none")->ice_ping());
    THROWN(Ice::ObjectNotExistException, t->ice_identity({"none", ""})->ice_ping());
    if (!slow) { // compressed requests are refused; the connection is closed in good order
        auto compressed = t->ice_compress(true)->ice_connectionId(is11 ? "z1" : "z0");
        THROWN(Ice::CloseConnectionException, compressed->echoBytes(Bytes(4000)));
        // Longer than a message may be.
        THROWN(Ice::ConnectionLostException, t->echoBytes(Bytes(9000)));
    }
    t->ice_ping();
}

// Calls that are answered later, in the reverse order; others are served meanwhile.
void Peer::asynchronous() {
    std::vector<std::future<int>> later;
    for (int v : {1, 2, -3, 4})
        later.push_back(t->laterAsync(v));
    CHECK(t->echoBytes({1, 2}) == (Bytes{1, 2}));
    CHECK(t->release() == 4);
    CHECK(later[0].get() == 2 && later[1].get() == 4 && later[3].get() == 8);
    THROWN(Failure, later[2].get());
    std::vector<std::future<Tester::EchoNumbersResult>> many;
    for (int i = 0; i < (slow ? 3 : 50); ++i)
        many.push_back(t->echoNumbersAsync(numbers(i)));
    for (size_t i = 0; i < many.size(); ++i)
        CHECK(many[i].get().same == numbers(static_cast<int>(i)));
    std::promise<std::string> what;
    t->failAsync(
        2, [&] { what.set_value("an answer"); },
        [&](std::exception_ptr e) {
            try {
                std::rethrow_exception(e);
            } catch (const Ice::Exception& x) {
                what.set_value(x.ice_id());
            }
        });
    CHECK(what.get_future().get() == "::Everything::Worse");
}

void Peer::oneways() {
    int before = t->sum();
    auto oneway = t->ice_oneway(), batch = t->ice_batchOneway();
    for (int i = 0; i < 20; ++i) {
        oneway->note(i);
        batch->note(1000);
    }
    batch->ice_flushBatchRequests();
    CHECK(t->sum() == before + 190 + 20000);
    THROWN(Ice::TwowayOnlyException, oneway->sum());
    // The servant calls back before it answers.
    if (overTcp) {
        auto adapter = ic->createObjectAdapterWithEndpoints("Watcher", "tcp -h 127.0.0.1");
        auto watcher =
            Ice::uncheckedCast<WatcherPrx>(adapter->addWithUUID(std::make_shared<WatcherI>()));
        adapter->activate();
        CHECK(t->callBack(watcher, 5) == 100);
    }
    Numbers n = numbers(), same;
    for (int i = 0; i < (slow ? 5 : 1000); ++i)
        CHECK(t->echoNumbers(n, same) == n);
}

} // namespace

int main(int argc, char** argv) {
    try {
        Ice::InitializationData data;
        data.properties = Ice::createProperties(argc, argv);
        data.properties->setProperty("Ice.RetryIntervals", "-1");
        data.properties->setProperty("Ice.AcceptClassCycles",
                                     "1"); // C++ only frees trees by itself
        Ice::CommunicatorHolder ic(data);
        if (argc < 2) {
            std::cerr << "usage: cpp_client [slow] PORT|ENDPOINT\n";
            return 2;
        }
        std::string where = argv[argc - 1];
        bool slow = argc > 2 && std::strcmp(argv[1], "slow") == 0, overTcp = where[0] != ':';
        if (overTcp)
            where = ":tcp -h 127.0.0.1 -p " + where;
        Peer peer{ic.communicator(), nullptr, slow, overTcp, true};
        for (const char* encoding : {"1.0", "1.1"}) {
            peer.is11 = encoding[2] == '1';
            peer.t = Ice::checkedCast<TesterPrx>(
                ic->stringToProxy(std::string("tester -e ") + encoding + where));
            CHECK(peer.t);
            peer.types();
            peer.classes();
            peer.exceptions();
            peer.targets();
        }
        peer.asynchronous();
        peer.oneways();
        if (overTcp) // a vehicle is not shut down: who would close the connection with us?
            peer.t->shutdown();
    } catch (const std::exception& e) {
        std::cerr << "cpp_client: " << e.what() << "\n";
        return 1;
    }
    std::cout << "cpp_client: everything as expected\n";
    return 0;
}
