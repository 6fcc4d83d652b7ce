// SPDX-License-Identifier: MIT
//
// cpp_server: stock ZeroC Ice in C++ (C++11 mapping) as the server of Everything.ice. Prints its
// port, serves until `shutdown`.

#include "Everything.h"
#include <Ice/Ice.h>
#include <iostream>
#include <mutex>

namespace {

using namespace Everything;
using Strings = Everything::Strings;

class TesterI : public Tester {
public:
    ~TesterI() override {
        for (auto& n : nodes_) // cycles keep themselves alive
            if (n)
                n->next = nullptr;
    }
    Numbers echoNumbers(Numbers v, Numbers& same, const Ice::Current&) override { return same = v; }
    Mixed echoMixed(Mixed v, const Ice::Current&) override { return v; }
    Mixeds echoMixeds(Mixeds v, int& count, const Ice::Current&) override {
        count = static_cast<int>(v.size());
        return v;
    }
    Bytes echoBytes(Bytes v, const Ice::Current&) override { return v; }
    void echoSequences(Bools a, Shorts b, Ints c, Longs d, Floats e, Doubles f, Strings g,
                       StringLists h, //
                       Bools& aa, Shorts& bb, Ints& cc, Longs& dd, Floats& ee, Doubles& ff,
                       Strings& gg, StringLists& hh, const Ice::Current&) override {
        aa = a, bb = b, cc = c, dd = d, ee = e, ff = f, gg = g, hh = h;
    }
    Counts echoCounts(Counts v, const Ice::Current&) override { return v; }
    Lists echoLists(Lists v, const Ice::Current&) override { return v; }
    std::shared_ptr<Ice::ObjectPrx> echoProxy(std::shared_ptr<Ice::ObjectPrx> v,
                                              const Ice::Current&) override {
        return v;
    }
    Proxies echoProxies(Proxies v, const Ice::Current&) override { return v; }
    Ice::optional<int> echoOptionals(int required, Ice::optional<std::string> a,
                                     Ice::optional<Numbers> b, Ice::optional<Ints> c,
                                     Ice::optional<std::string>& aa, Ice::optional<Numbers>& bb,
                                     Ice::optional<Ints>& cc, const Ice::Current&) override {
        aa = a, bb = b, cc = c;
        return required ? Ice::optional<int>(required) : Ice::nullopt;
    }
    std::shared_ptr<Node> echoNode(std::shared_ptr<Node> v, const Ice::Current&) override {
        std::lock_guard<std::mutex> lock(mutex_);
        nodes_.push_back(v);
        return v;
    }

    void fail(int how, const Ice::Current&) override {
        switch (how) {
        case 0:
            return;
        case 1:
            throw Failure("as asked");
        case 2:
            throw Worse("worse", 7);
        case 3:
            throw Unrelated({{"key", -1}}, Ice::nullopt);
        case 4:
            throw Unrelated({{"key", -1}}, std::string("hint"));
        case 11:
            throw Ice::ObjectNotExistException(__FILE__, __LINE__, {"n", "c"}, "f", "op");
        case 12:
            throw Ice::FacetNotExistException(__FILE__, __LINE__, {"n", "c"}, "f", "op");
        case 13:
            throw Ice::OperationNotExistException(__FILE__, __LINE__, {"n", "c"}, "f", "op");
        case 16:
            throw Ice::MarshalException(__FILE__, __LINE__, "as asked");
        default:
            throw std::runtime_error("as asked");
        }
    }
    void failSliced(int how, const Ice::Current& current) override { fail(how, current); }

    std::string context(std::string key, const Ice::Current& current) override {
        auto found = current.ctx.find(key);
        return found == current.ctx.end() ? "-" : found->second;
    }
    std::string whoAmI(const Ice::Current& current) override {
        return current.id.category + "/" + current.id.name + " -f " + current.facet + " mode " +
               std::to_string(static_cast<int>(current.mode));
    }
    int callBack(std::shared_ptr<WatcherPrx> watcher, int times,
                 const Ice::Current& current) override {
        // Calls over the caller's own connection: it may listen nowhere.
        auto bound =
            Ice::uncheckedCast<WatcherPrx>(current.con->createProxy(watcher->ice_getIdentity()));
        int sum = 0;
        for (int i = 0; i < times; ++i)
            sum += bound->ask(i);
        return sum;
    }
    void laterAsync(int v, std::function<void(int)> response,
                    std::function<void(std::exception_ptr)> exception,
                    const Ice::Current&) override {
        std::lock_guard<std::mutex> lock(mutex_);
        waiting_.push_back([=] {
            if (v < 0)
                exception(std::make_exception_ptr(Failure("negative")));
            else
                response(2 * v);
        });
    }
    int release(const Ice::Current&) override {
        std::vector<std::function<void()>> waiting;
        {
            std::lock_guard<std::mutex> lock(mutex_);
            waiting.swap(waiting_);
        }
        for (auto answer = waiting.rbegin(); answer != waiting.rend(); ++answer)
            (*answer)();
        return static_cast<int>(waiting.size());
    }
    void note(int v, const Ice::Current&) override {
        std::lock_guard<std::mutex> lock(mutex_);
        total_ += v;
    }
    int sum(const Ice::Current&) override {
        std::lock_guard<std::mutex> lock(mutex_);
        return total_;
    }
    void shutdown(const Ice::Current& current) override {
        current.adapter->getCommunicator()->shutdown();
    }

private:
    std::mutex mutex_;
    std::vector<std::function<void()>> waiting_;
    std::vector<std::shared_ptr<Node>> nodes_;
    int total_ = 0;
};

// A class that is called.
class SquareI : public SquareDisp {
public:
    std::string label(const Ice::Current&) override { return "square"; }
    int area(int scale, const Ice::Current&) override {
        if (scale < 0)
            throw Failure("negative");
        return scale * side_ * side_;
    }
    void growAsync(int by, std::function<void(int)> response,
                   std::function<void(std::exception_ptr)>, const Ice::Current&) override {
        response(side_ += by);
    }

private:
    int side_ = 0;
};

class OlderI : public Older {
public:
    Ice::optional<int> echoOptionals(int required, Ice::optional<std::string>,
                                     const Ice::Current&) override {
        return required;
    }
};

} // namespace

int main(int argc, char** argv) {
    try {
        Ice::InitializationData data;
        data.properties = Ice::createProperties(argc, argv);
        data.properties->setProperty("Ice.ThreadPool.Server.Size", "4");
        data.properties->setProperty("Ice.Warn.Dispatch", "0");
        data.properties->setProperty("Ice.AcceptClassCycles",
                                     "1"); // C++ only frees trees by itself
        Ice::CommunicatorHolder ic(data);
        auto adapter = ic->createObjectAdapterWithEndpoints("Adapter", "tcp -h 127.0.0.1");
        auto servant = std::make_shared<TesterI>();
        adapter->add(servant, {"tester", ""});
        adapter->addFacet(servant, {"tester", ""}, "side");
        adapter->add(std::make_shared<SquareI>(), {"square", ""});
        adapter->add(std::make_shared<OlderI>(), {"older", ""});
        adapter->addDefaultServant(servant, "any");
        adapter->activate();
        auto info = adapter->getPublishedEndpoints().at(0)->getInfo();
        std::cout << std::dynamic_pointer_cast<Ice::IPEndpointInfo>(info)->port << std::endl;
        ic->waitForShutdown();
    } catch (const std::exception& e) {
        std::cerr << "cpp_server: " << e.what() << "\n";
        return 1;
    }
    return 0;
}
