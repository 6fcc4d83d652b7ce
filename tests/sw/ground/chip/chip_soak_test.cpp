// SPDX-License-Identifier: MIT
//
// chip_soak_test: tests the real system for a long time. Stock Ice with the plugin and IceC on the
// RTL call each other over a bad radio link, while UAV, modems and the ground's program restart. No
// message may be wrong, duplicated or out of order, and each call must be answered or reported with
// a status.
//
//   SOAK_SECONDS=600 build/main/tests/sw/ground/chip/test_chip_soak
//
// SOAK_SECONDS is the number of simulated seconds; the default is 5. SOAK_REST=10 makes each caller
// pause for ten seconds on average, and makes faults rarer by the same factor. With SOAK_REST the
// test is a flight (`./icesoc fly`), in which most clocks are skipped; the camera's sensor
// then sends one picture per second, and the cores are called one after the other.

#include "../../../support/delivery_check.h"
#include "../../../support/environment.h"
#include "chip_world.h"
#include "core_pins.h"
#include "random.h"
#include <future>
#include <gtest/gtest.h>
#include <set>

extern "C" {
#include "echo_uav.h"
}

namespace {

RadioTest::Bytes pattern(int id, size_t size) {
    RadioTest::Bytes bytes(size);
    for (size_t i = 0; i < size; ++i)
        bytes[i] = static_cast<Ice::Byte>(i * 7 + static_cast<size_t>(id) * 31);
    return bytes;
}

// The ground's program, which can end and restart while other threads use it.
class GroundProgram {
public:
    Ice::CommunicatorPtr get() {
        std::lock_guard<std::mutex> lock(mutex_);
        return current_;
    }
    void start(const Ice::CommunicatorPtr& fresh) {
        std::lock_guard<std::mutex> lock(mutex_);
        current_ = fresh;
    }
    void end() {
        auto old = get();
        {
            std::lock_guard<std::mutex> lock(mutex_);
            ended_.insert(old);
        }
        old->destroy();
    }
    // Returns true if an Ice exception means that the call may not have been executed. While a
    // communicator is being destroyed, parts of Ice throw other exceptions ("timer destroyed", a
    // null handle) with the same meaning.
    bool isReport(const Ice::CommunicatorPtr& used, const std::string& exceptionId) {
        static const std::set<std::string> reports = {
            "::Ice::ConnectionLostException",    "::Ice::ConnectFailedException",
            "::Ice::ConnectTimeoutException",    "::Ice::InvocationTimeoutException",
            "::Ice::TimeoutException",           "::Ice::CloseConnectionException",
            "::Ice::CloseTimeoutException",      "::Ice::ConnectionTimeoutException",
            "::Ice::ConnectionRefusedException", "::Ice::CommunicatorDestroyedException"};
        std::lock_guard<std::mutex> lock(mutex_);
        return reports.count(exceptionId) != 0 || ended_.count(used) != 0;
    }

private:
    std::mutex mutex_;
    Ice::CommunicatorPtr current_;
    std::set<Ice::CommunicatorPtr> ended_;
};

// The messages in one direction. The upper bits of a message's number identify its sender.
class Book {
public:
    // Records a message. The sender sends its next message only after this one has been reported.
    void sent(int id, const RadioTest::Bytes& data) {
        std::lock_guard<std::mutex> lock(mutex_);
        // an earlier message without a report was lost when the UAV restarted
        (void)check_.forget(id >> 24);
        check_.sent(id >> 24, static_cast<uint32_t>(id), {data.begin(), data.end()});
    }
    void arrived(int id, const RadioTest::Bytes& data) {
        std::lock_guard<std::mutex> lock(mutex_);
        note(check_.arrived(id >> 24, static_cast<uint32_t>(id), {data.begin(), data.end()}));
    }
    void reported(int id, bool isAnswered) {
        std::lock_guard<std::mutex> lock(mutex_);
        note(check_.reported(static_cast<uint32_t>(id), isAnswered));
    }
    // Checks that no error was found.
    void expectRight() {
        std::lock_guard<std::mutex> lock(mutex_);
        for (auto& fault : faults_)
            ADD_FAILURE() << fault << "; SEED " << testSeed();
    }
    unsigned executed() {
        std::lock_guard<std::mutex> lock(mutex_);
        return static_cast<unsigned>(check_.arrivals());
    }

private:
    void note(const std::string& fault) {
        if (!fault.empty())
            faults_.push_back(fault);
    }
    std::mutex mutex_;
    DeliveryCheck check_;
    std::vector<std::string> faults_;
};

// The object on the ground that the UAV calls.
class Station : public RadioTest::Echo {
public:
    explicit Station(Book& book) : book_(book) {}
    RadioTest::Bytes repeat(int id, RadioTest::Bytes data, const Ice::Current&) override {
        book_.arrived(id, data);
        return data;
    }
    void note(int id, const Ice::Current&) override { book_.arrived(id, {}); }
    void take(int, RadioTest::Bytes, const Ice::Current&) override {}
    RadioTest::Bytes fetch(int, const Ice::Current&) override { return {}; }

private:
    Book& book_;
};

class ChipSoak : public ::testing::Test {
protected:
    static double wanted() { return numberFromEnvironment("SOAK_SECONDS", 5); }
    static double rest() { return numberFromEnvironment("SOAK_REST", 0); }
    static double rest(Random& random) { return rest() * (0.5 + random.below(1000) / 1000.0); }
    // ---- the UAV's side, which runs in the thread of the simulation ----
    static ChipSoak& self(void* context) { return *static_cast<ChipSoak*>(context); }
    static void executed(void* context, int id, const U8* data, int size) {
        self(context).up_.arrived(id, RadioTest::Bytes(data, data + size));
    }
    static int next(void* context, int* id, U8* data, int* isOneway) {
        ChipSoak& s = self(context);
        Random& random = s.uavRandom_;
        // The UAV makes calls at random times, the next one only after its previous call has ended.
        if (s.uavStops_ || random.below(4) || s.world_.ns() < s.uavDue_)
            return -1;
        s.uavDue_ = s.world_.ns() + static_cast<uint64_t>(1e9 * rest(random));
        const int uav = 9 << 24;
        *id = uav | ++s.uavSent_;
        *isOneway = random.below(4) == 0;
        const U32 size = random.below(12) ? random.below(200) : random.below(ECHO_UAV_LONGEST);
        s.uavMessage_ = pattern(*id, *isOneway ? 0 : size);
        std::copy(s.uavMessage_.begin(), s.uavMessage_.end(), data);
        s.uavIsOneway_ = *isOneway != 0;
        s.down_.sent(*id, s.uavMessage_);
        return static_cast<int>(s.uavMessage_.size());
    }
    static void outcome(void* context, int id, int status, const char* text, const U8* answer,
                        int size) {
        ChipSoak& s = self(context);
        s.down_.reported(id, status == 0 && !s.uavIsOneway_);
        if (status != 0) {
            ++s.uavReported_;
            ++s.uavReports_[text];
        } else {
            ++s.uavAnswered_;
            const RadioTest::Bytes bytes(answer, answer + size);
            s.uavWrong_ += bytes != s.uavMessage_;
        }
    }

    // ---- the ground's side ----
    void startGround() {
        auto fresh = world_.client();
        auto adapter = fresh->createObjectAdapter("Station");
        adapter->add(std::make_shared<Station>(down_), Ice::stringToIdentity("station"));
        adapter->activate();
        ground_.start(fresh);
    }
    RadioTest::Bytes repeat(const std::shared_ptr<RadioTest::EchoPrx>& echo, int id,
                            const RadioTest::Bytes& data) {
        up_.sent(id, data);
        try {
            const auto answer = echo->repeat(id, data);
            up_.reported(id, true);
            return answer;
        } catch (const Ice::Exception&) {
            up_.reported(id, false);
            throw;
        }
    }
    void work(int worker) {
        Random random(testSeed() * 100 + static_cast<uint64_t>(worker));
        for (int number = 1; !stop_; number += 2) {
            const int id = worker << 24 | number;
            const auto ground = ground_.get();
            try {
                auto echo = world_.echo(ground, std::to_string(worker));
                if (random.below(4) == 0) { // a one-way call, for which no loss is reported
                    up_.sent(id, {});
                    up_.reported(id, false);
                    echo->ice_oneway()->note(id);
                }
                const U32 size = random.below(12) ? random.below(200) : random.below(7000);
                const auto data = pattern(id + 1, size);
                ++calls_;
                const auto answer = repeat(echo, id + 1, data);
                ++(answer == data ? answered_ : wrong_);
                if (rest() > 0)
                    callCore(ground, worker);
            } catch (const Ice::Exception& e) {
                note(ground, e);
            }
            world_.sleep(rest(random));
        }
    }
    // ---- cores that are called during a flight ----
    void connectCamera() {
        Frame frame{320, 240, {}};
        for (int i = 0; i < frame.width * frame.height; ++i) // a chessboard
            frame.pixels.push_back((i / 32 + i / frame.width / 24) % 2 ? 200 : 50);
        world_.with([&] {
            connectSensor(world_.soc, frame, [this, next = uint64_t(0)]() mutable {
                const bool sends = world_.soc.now() >= next;
                next = sends ? world_.soc.now() + 1'000'000'000 : next;
                return sends;
            });
        });
    }
    // Calls the cores in turn. The calls are two-way, so each core has finished before the next
    // call.
    void callCore(const Ice::CommunicatorPtr& ground, int worker) {
        using Bytes = std::vector<Ice::Byte>;
        static const Bytes size = {64, 1, 240, 0}, one = {0, 0, 0, 1, 0}, key(17, 16), text(41, 40),
                           samples(49, 24);
        static const struct {
            const char *object, *operation;
            Ice::OperationMode mode;
            const Bytes parameters;
        } calls[] = {{"camera", "capture", Ice::OperationMode::Idempotent, size},
                     {"hwengine1", "startProcessing", Ice::OperationMode::Normal, {}},
                     {"fir", "setCoefficient", Ice::OperationMode::Idempotent, one},
                     {"fir", "filter", Ice::OperationMode::Normal, samples},
                     {"ascon", "setKey", Ice::OperationMode::Idempotent, key},
                     {"ascon", "hash", Ice::OperationMode::Idempotent, text}};
        const auto& call = calls[coreCalls_++ % std::size(calls)];
        Ice::OutputStream out(ground);
        out.startEncapsulation();
        for (Ice::Byte b : call.parameters)
            out.write(b);
        out.endEncapsulation();
        Bytes in, result;
        out.finished(in);
        const auto core = ground->stringToProxy(call.object + (":" + world_.endpoint()));
        coreAnswers_ += core->ice_connectionId(std::to_string(worker))
                            ->ice_invoke(call.operation, call.mode, in, result);
    }
    void note(const Ice::CommunicatorPtr& ground, const Ice::Exception& e) {
        {
            std::lock_guard<std::mutex> lock(mutex_);
            ++reports_[e.ice_id()];
            if (!ground_.isReport(ground, e.ice_id()))
                faults_.insert(e.ice_id());
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    void misfortune(Random& random, unsigned kind) {
        switch (kind) {
        case 0:
            world_.reboot();
            ++reboots_;
            break;
        case 1:
        case 2:
            world_.with([&] {
                XBee& modem = kind == 1 ? world_.soc.modem() : world_.groundModem;
                modem.resetPin(true, world_.soc.now());
                modem.resetPin(false, world_.soc.now() + 1000);
            });
            ++modemResets_;
            break;
        case 3:
            ground_.end(); // also ends the engine, as happens at the end of a program
            startGround();
            ++groundStarts_;
            break;
        default:
            world_.with([&] { world_.air.weather = RfWeather::drawn(random, 30); });
        }
    }
    void endure() {
        Random random(testSeed());
        const uint64_t end = world_.ns() + static_cast<uint64_t>(wanted() * 1e9);
        misfortune(random, 4); // chooses random radio conditions
        auto said = std::chrono::steady_clock::now();
        for (unsigned events = 0; world_.ns() < end; ++events) {
            misfortune(random,
                       // first the fixed events 3 0 2 4, then random events
                       events < 4 ? (events * 2 + 3) % 5 : random.below(6));
            world_.sleep((0.7 + random.below(1000) / 1000.0) * (1 + rest()));
            if (std::chrono::steady_clock::now() - said > std::chrono::seconds(15)) {
                said = std::chrono::steady_clock::now();
                report();
            }
        }
    }
    bool groundIsAnswered() {
        for (int id = (8 << 24) + 1; id <= (8 << 24) + 20; ++id) {
            try {
                const auto data = pattern(id, 500);
                // Uses one of the three connections; the program of a fourth connection would have
                // to wait.
                if (repeat(world_.echo(ground_.get(), "1"), id, data) == data)
                    return true;
            } catch (const Ice::Exception&) {
                world_.sleep(0.2);
            }
        }
        return false;
    }
    bool uavIsAnswered() {
        const unsigned before = uavAnswered_;
        for (int tries = 0; tries < 200 && uavAnswered_ == before; ++tries)
            world_.sleep(0.1 * (1 + rest()));
        return uavAnswered_ > before;
    }
    void checkBooks() {
        unsigned reported = 0;
        for (auto& [name, count] : reports_)
            reported += count;
        EXPECT_EQ(wrong_ + uavWrong_, 0u) << "wrong answers; SEED " << testSeed();
        up_.expectRight();
        down_.expectRight();
        EXPECT_GE(answered_ + wrong_ + reported, calls_.load())
            << "calls without a report; SEED " << testSeed();
        // A call ends without a report if the UAV reboots.
        EXPECT_LE(uavAnswered_ + uavReported_, static_cast<unsigned>(uavSent_));
        EXPECT_GE(uavAnswered_ + uavReported_ + reboots_ + 1, static_cast<unsigned>(uavSent_));
        EXPECT_GE(2 * coreAnswers_ + 5, coreCalls_) << "too many calls of cores were not answered";
        for (auto& fault : faults_)
            ADD_FAILURE() << "a call ended with " << fault << "; SEED " << testSeed();
    }
    void report() {
        std::printf("chip soak: %.0f s simulated; ground to UAV: %u calls, %u answered, %u "
                    "executed; UAV to "
                    "ground: %u sent, %u answered, %u reported, %u executed; %u reboots of the "
                    "UAV, %u modem "
                    "resets, %u starts of the ground station; cores: %u calls, %u answered\n",
                    static_cast<double>(world_.ns()) / 1e9, calls_.load(), answered_.load(),
                    up_.executed(), uavSent_, uavAnswered_.load(), uavReported_.load(),
                    down_.executed(), reboots_, modemResets_, groundStarts_, coreCalls_.load(),
                    coreAnswers_.load());
        std::fflush(stdout);
    }

    Book up_, down_;
    std::atomic<bool> stop_{false}, uavStops_{false};
    std::atomic<unsigned> calls_{0}, answered_{0}, wrong_{0};
    std::atomic<unsigned> coreCalls_{0}, coreAnswers_{0};
    std::atomic<unsigned> uavAnswered_{0}, uavReported_{0}, uavWrong_{0};
    Random uavRandom_{testSeed() + 7};
    RadioTest::Bytes uavMessage_;
    int uavSent_ = 0;
    bool uavIsOneway_ = false; // true if the last message from the UAV was one-way
    uint64_t uavDue_ = 0;      // earliest time of the UAV's next call, ns
    std::map<std::string, unsigned> uavReports_;
    unsigned reboots_ = 0, modemResets_ = 0, groundStarts_ = 0;
    std::mutex mutex_;
    std::map<std::string, unsigned> reports_;
    std::set<std::string> faults_;
    const EchoUav_Port port_{executed, next, outcome};
    // the link has a key for every second seed
    ChipWorld world_{testSeed(), port_, this, testSeed() % 2 != 0};
    GroundProgram ground_;
};

TEST_F(ChipSoak, EveryMessageArrivesOnceInOrderOrIsReported) {
    struct AtEnd { // stops the workers before they are joined, even after an exception
        ~AtEnd() { stop = true; }
        std::atomic<bool>& stop;
    };
    startGround();
    std::vector<std::future<void>> workers; // the destructor of a future joins its worker
    for (int w = 1; w <= 3; ++w)
        workers.push_back(std::async(std::launch::async, [this, w] { work(w); }));
    AtEnd atEnd{stop_};
    if (rest() > 0)
        connectCamera();
    world_.sleep(2); // time for the set-up, and for some time without faults
    endure();
    stop_ = true;
    world_.with([&] { world_.air.weather = {}; });
    for (auto& worker : workers)
        worker.get();
    EXPECT_TRUE(groundIsAnswered()) << "no call succeeds in good weather";
    EXPECT_TRUE(uavIsAnswered()) << "none of the UAV's calls is answered in good weather";
    uavStops_ = true;
    ground_.end();
    report();
    checkBooks();
}

} // namespace
