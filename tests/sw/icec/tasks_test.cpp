// SPDX-License-Identifier: MIT
//
// tasks_test: tests a communicator that several threads use over tcp: simultaneous calls, with and
// without a receiving task, and replies that are not sent by the task that executes the operation.

#include "icec_pair.h"

#include <atomic>
#include <condition_variable>
#include <deque>
#include <mutex>
#include <thread>

extern "C" {
#include "Graph.h"
#include "tcp_endpoint.h"

Ice_Status Graph_Maker_echo(Graph_MakerPtr, Ice_String text, Ice_String* result,
                            const Ice_Current*) {
    *result = text;
    return ICE_OK;
}
Ice_Status Graph_Maker_make(Graph_MakerPtr, const Graph_Node* a, const Ice_Value*,
                            const Graph_Node** result, Graph_Maker_make_Exception* ex,
                            const Ice_Current*) {
    *result = a;
    if (a->id % 2 == 0)
        return ICE_OK;
    ex->type = Graph_Maker_make_Exception::Graph_Maker_make_Failure;
    ex->u.Failure.why = a->text;
    ex->u.Failure.node = Graph_Node_cast(a);
    return ICE_USER_EXCEPTION;
}
}

namespace {

// Implements Ice_Os with the threads of the host.
struct Threads {
    std::mutex locks[2], waiting;
    std::condition_variable changed[ICE_CALLS + 1];
    bool woken[ICE_CALLS + 1] = {};
    std::atomic<int> callsAsleep{0};

    static Threads& of(void* context) { return *static_cast<Threads*>(context); }
    static const Ice_Os* os() {
        static const Ice_Os table = {[](void* c, int which) { of(c).locks[which].lock(); },
                                     [](void* c, int which) { of(c).locks[which].unlock(); },
                                     [](void* c, int slot, Ice_Int ms) {
                                         Threads& t = of(c);
                                         std::unique_lock<std::mutex> lock(t.waiting);
                                         t.callsAsleep += slot < ICE_CALLS;
                                         bool woken = t.changed[slot].wait_for(
                                             lock, std::chrono::milliseconds(ms),
                                             [&] { return t.woken[slot]; });
                                         t.woken[slot] = false;
                                         t.callsAsleep -= slot < ICE_CALLS;
                                         return woken ? 1 : 0;
                                     },
                                     [](void* c, int slot) {
                                         Threads& t = of(c);
                                         std::lock_guard<std::mutex> lock(t.waiting);
                                         t.woken[slot] = true;
                                         t.changed[slot].notify_all();
                                     },
                                     [](void*) {
                                         static std::atomic<int> next{0};
                                         static thread_local int mine = next++;
                                         return mine;
                                     }};
        return &table;
    }
};

struct Program {
    Ice_Communicator ic;
    TcpEndpoint tcp;
    Ice_ObjectAdapter adapter;
    Threads threads;

    Program() {
        Ice_initialize(&ic);
        Ice_Communicator_setOs(&ic, Threads::os(), &threads);
        EXPECT_EQ(TcpEndpoint_init(&ic, &tcp), ICE_OK);
    }
    ~Program() { TcpEndpoint_destroy(&tcp); }
};

class Tasks : public ::testing::Test {
protected:
    Tasks() : server_(std::make_unique<Program>()), client_(std::make_unique<Program>()) {
        Ice_Communicator& ic = server_->ic;
        EXPECT_EQ(
            Ice_Communicator_createObjectAdapterWithEndpoints(&ic, "A", "tcp", &server_->adapter),
            ICE_OK);
        EXPECT_EQ(Ice_ObjectAdapter_add(&server_->adapter, &servant_.base, "thing"), ICE_OK);
        Ice_ObjectAdapter_activate(&server_->adapter);
        servant_.run = [this](const Ice_Current& current, Ice_InputStreamPtr is,
                              Ice_OutputStreamPtr os) {
            Ice_Int v = Ice_InputStream_readInt(is);
            if (str(current.operation) == "later") {
                std::lock_guard<std::mutex> lock(laterMutex_);
                later_.emplace_back();
                later_.back().second = v;
                Ice_Current_later(&current, &later_.back().first);
                laterCame_.notify_one();
                return ICE_LATER;
            }
            Ice_OutputStream_writeInt(os, 2 * v);
            return ICE_OK;
        };
        serving_ = std::thread([this] { Ice_Communicator_waitForShutdown(&server_->ic); });
        answering_ = std::thread([this] { answer(); });
    }
    ~Tasks() override {
        Ice_Communicator_shutdown(&server_->ic);
        {
            std::lock_guard<std::mutex> lock(laterMutex_);
            over_ = true;
            laterCame_.notify_one();
        }
        serving_.join();
        answering_.join();
    }
    // Sends replies later, from a task that does not dispatch operations.
    void answer() {
        for (;;) {
            std::unique_lock<std::mutex> lock(laterMutex_);
            laterCame_.wait(lock, [this] { return over_ || (!held_ && !later_.empty()); });
            if (over_)
                return;
            auto [reply, v] = later_.front();
            later_.pop_front();
            lock.unlock();
            Ice_OutputStream_writeInt(Ice_Reply_begin(&reply), 3 * v);
            EXPECT_EQ(Ice_Reply_end(&reply, ICE_OK), ICE_OK);
        }
    }
    void hold(bool held) {
        std::lock_guard<std::mutex> lock(laterMutex_);
        held_ = held;
        laterCame_.notify_one();
    }
    // Returns a proxy of the client's communicator for an object of the server.
    Ice_ObjectPrx proxy(const std::string& identity = "thing",
                        const std::string& host = "127.0.0.1") {
        Ice_ObjectPrx prx;
        const std::string text =
            identity + ":tcp -h " + host + " -p " + std::to_string(server_->tcp.port);
        EXPECT_EQ(Ice_Communicator_stringToProxy(&client_->ic, text.c_str(), &prx), ICE_OK);
        prx.timeoutMs = 60000;
        return prx;
    }
    // Calls `what` while this number of tasks serve the client's communicator.
    template <class What> void whileServing(int tasks, What what) {
        std::vector<std::thread> serving;
        for (int t = 0; t < tasks; ++t)
            serving.emplace_back([this] { Ice_Communicator_waitForShutdown(&client_->ic); });
        what();
        Ice_Communicator_shutdown(&client_->ic);
        for (auto& task : serving)
            task.join();
    }
    void callFromThreads(int count) {
        std::vector<std::thread> callers;
        std::atomic<int> wrong{0};
        for (int t = 0; t < count; ++t)
            callers.emplace_back([&, t] {
                Ice_ObjectPrx prx = proxy();
                for (int i = 0; i < 200; ++i) {
                    Ice_Int out = 0, v = 1000 * t + i;
                    bool later = i % 3 == 0;
                    Ice_Status status = call(prx, later ? "later" : "now", v, &out);
                    wrong += status != ICE_OK || out != (later ? 3 : 2) * v;
                }
            });
        for (auto& c : callers)
            c.join();
        EXPECT_EQ(wrong, 0);
    }

    std::unique_ptr<Program> server_, client_;
    Servant servant_;
    std::mutex laterMutex_;
    std::condition_variable laterCame_;
    std::deque<std::pair<Ice_Reply, Ice_Int>> later_;
    bool over_ = false, held_ = false;
    std::thread serving_, answering_;
};

// Tests with a parameter: the number of tasks that serve. If it is 0, the calling tasks receive
// messages in turns.
class TasksThatServe : public Tasks, public ::testing::WithParamInterface<int> {};
TEST_P(TasksThatServe, ServingTasksLetOthersCall) {
    whileServing(GetParam(), [this] { callFromThreads(ICE_CALLS); });
}
INSTANTIATE_TEST_SUITE_P(Tasks, TasksThatServe, ::testing::Values(0, 1, 2));

// In POSIX, the hook for the end of a task is the destructor of a thread key.
TEST_F(Tasks, AThreadKeyReleasesTheSlotOfAThreadThatEnds) {
    pthread_key_t ending;
    ASSERT_EQ(pthread_key_create(&ending,
                                 [](void* ic) {
                                     Ice_Communicator_endTask(static_cast<Ice_Communicator*>(ic),
                                                              Threads::os()->task(nullptr));
                                 }),
              0);
    for (int i = 0; i < ICE_CALLS + 2; ++i)
        std::thread([&] {
            pthread_setspecific(ending, &client_->ic);
            Ice_ObjectPrx prx = proxy();
            EXPECT_EQ(ask(prx, "op", i), 2 * i);
        }).join();
    pthread_key_delete(ending);
}

// Tasks make calls, one task after the other. IceC stores the result of a call until its task ends.
TEST_F(Tasks, AnEndedTaskFreesItsSlot) {
    for (int i = 0; i < ICE_CALLS + 2; ++i)
        std::thread([&] {
            Ice_ObjectPrx prx = proxy();
            Ice_Int out = 0;
            EXPECT_EQ(call(prx, "op", i, &out), ICE_OK) << i;
            EXPECT_EQ(out, 2 * i);
            Ice_Communicator_endTask(&client_->ic, Threads::os()->task(nullptr));
        }).join();
    Ice_ObjectPrx prx = proxy();
    EXPECT_EQ(ask(prx, "op", 1), 2);
    Ice_Communicator_endTask(&client_->ic, Threads::os()->task(nullptr)); // and again
    Ice_Communicator_endTask(&client_->ic, Threads::os()->task(nullptr));
    EXPECT_EQ(ask(prx, "op", 2), 4);
}

// Tasks make calls while two other tasks poll repeatedly. Each poll takes the role of the receiving
// task over from a waiting call, and then gives it back.
TEST_F(Tasks, CallsWorkWhileTwoTasksPoll) {
    std::atomic<bool> over{false};
    auto poll = [&] {
        while (!over)
            Ice_Communicator_poll(&client_->ic, 1);
    };
    std::thread first(poll), second(poll);
    callFromThreads(ICE_CALLS);
    over = true;
    first.join();
    second.join();
}

TEST_F(Tasks, AServerTakesTheReceivingRoleFromAWaitingCall) {
    hold(true);
    std::atomic<bool> answered{false};
    std::thread caller([&] {
        Ice_ObjectPrx prx = proxy();
        prx.timeoutMs = 120000;
        EXPECT_EQ(ask(prx, "later", 14), 42);
        answered = true;
    });
    auto isAsked = [this] {
        std::lock_guard<std::mutex> lock(laterMutex_);
        return !later_.empty();
    };
    while (!isAsked())
        std::this_thread::yield();
    std::atomic<int> polls{0};
    std::thread server([&] {
        for (; !answered && polls < 1000; ++polls)
            Ice_Communicator_poll(&client_->ic, 60);
    });
    while (client_->threads.callsAsleep == 0 && polls < 1000)
        std::this_thread::yield();
    EXPECT_LT(polls, 1000) << "the role was not handed over";
    hold(false);
    caller.join();
    server.join();
}

// The server listens only on the second address of the name (see the resolver in manual_test.cpp).
// The next call uses the existing connection.
TEST_F(Tasks, EachAddressOfANameIsTried) {
    Ice_ObjectPrx prx = proxy("thing", "twofold.test");
    for (int i = 0; i < 3; ++i)
        EXPECT_EQ(ask(prx, "now", 4), 8);
    int open = 0;
    for (const TcpEndpoint_Connection& c : client_->tcp.connections)
        open += c.fd >= 0;
    EXPECT_EQ(open, 1);
}

// (results_m3 tests that results stay valid while other tasks call.)
class Results : public Tasks {
protected:
    Results() {
        Graph_Maker_init(&maker_);
        EXPECT_EQ(Ice_ObjectAdapter_add(&server_->adapter, (Ice_ObjectPtr)&maker_, "maker"),
                  ICE_OK);
    }
    Graph_Maker maker_;
};

TEST_F(Results, ResultsOfAnAsynchronousCallAreValidInItsCallback) {
    Graph_MakerPrx prx = proxy("maker");
    Graph_Node sent;
    Graph_Node_init(&sent);
    sent.has_text = 1;
    sent.text = text("mine");
    for (sent.id = 0; sent.id < 2; ++sent.id) { // the servant throws an exception for an odd id
        static bool isRight;
        isRight = false;
        Graph_Maker_make_Async async;
        async.completed = [](Graph_Maker_make_Async* self) {
            const Graph_Node* node = self->status == ICE_OK ? self->result : nullptr;
            if (self->status == ICE_USER_EXCEPTION && str(self->exception.u.Failure.why) == "mine")
                node = self->exception.u.Failure.node;
            isRight = node && str(node->text) == "mine";
        };
        ASSERT_EQ(Graph_MakerPrx_make_async(&prx, &sent, nullptr, &async), ICE_OK);
        while (!async.done)
            Ice_Communicator_poll(&client_->ic, 1000);
        EXPECT_TRUE(isRight) << sent.id;
    }
}

TEST_F(Results, ACallNeedsTheModeOfItsOperation) {
    Graph_MakerPrx prx = proxy("maker");
    EXPECT_EQ(::call(prx, "echo", 0, nullptr, 2), ICE_UNKNOWN_LOCAL_EXCEPTION)
        << "the operation is not idempotent";
}

} // namespace
