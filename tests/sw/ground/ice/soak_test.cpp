// SPDX-License-Identifier: MIT
//
// soak_test: stock Ice over a bad radio, while UAV, modems and ground start again: no wrong answer,
// no call executed twice, each call answered or reported by an exception that says so; afterwards
// it works.
//
//   SOAK_SECONDS=600 build/main/tests/sw/ground/ice/test_radio_ice --gtest_filter='IceSoak*'
//   (default 10)

#include "../reported.h"
#include "world.h"
#include <cstdlib>
#include <gtest/gtest.h>

namespace {

using Steady = std::chrono::steady_clock;

class IceSoak : public ::testing::Test {
protected:
    static double wanted() {
        const char* text = std::getenv("SOAK_SECONDS");
        return text && *text ? std::atof(text) : 10;
    }
    void startGround() {
        ground_.start(world_.client({{"Ice.Default.InvocationTimeout", "15000"}}));
    }
    // Calls until told to stop.
    void work(int worker) {
        Random random(testSeed() * 100 + static_cast<uint64_t>(worker));
        for (int number = 0; !stop_; ++number) {
            int id = worker << 24 | number;
            uint32_t size = random.below(20) ? random.below(200) : random.below(8000);
            auto data = World::pattern(id, size);
            ++calls_;
            const auto ground = ground_.get();
            try {
                auto echo = world_.proxy(ground, std::to_string(worker % 3));
                if (random.below(4) == 0)
                    echo->ice_oneway()->note(id | 1 << 23);
                auto answer = echo->repeat(id, data);
                ++(answer == data ? answered_ : wrong_);
            } catch (const Ice::Exception& e) {
                note(ground, e);
            }
        }
    }
    // Only what says "this call may not have been executed" is an answer, too.
    void note(const Ice::CommunicatorPtr& ground, const Ice::Exception& e) {
        const std::string id = e.ice_id();
        ++reported_;
        if (!ground_.isReport(ground, id)) {
            std::lock_guard<std::mutex> lock(mutex_);
            faults_.insert(id);
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
    void weather(Random& random) {
        const RfWeather w = RfWeather::drawn(random, 30);
        world_.rig.with([&] { world_.rig.air.weather = w; });
    }
    void reset(XBee& modem) {
        world_.rig.with([&] {
            modem.resetPin(true, world_.rig.ns());
            modem.resetPin(false, world_.rig.ns() + 1000);
        });
        ++modemResets_;
    }
    void misfortune(Random& random) {
        switch (random.below(5)) {
        case 0:
            world_.relay->reboot();
            ++reboots_;
            break;
        case 1:
            reset(*world_.rig.uav);
            break;
        case 2:
            reset(*world_.rig.ground);
            break;
        case 3:
            ground_.end(); // with it the engine goes: a program that ends
            startGround();
            ++groundRestarts_;
            break;
        default:
            weather(random);
        }
    }

    World world_{testSeed()};
    std::mutex mutex_;
    GroundProgram ground_;
    std::atomic<bool> stop_{false};
    std::atomic<unsigned> calls_{0}, answered_{0}, reported_{0}, wrong_{0};
    unsigned reboots_ = 0, modemResets_ = 0, groundRestarts_ = 0;
    std::set<std::string> faults_;
};

TEST_F(IceSoak, EveryCallIsAnsweredRightOrReported) {
    startGround();
    std::vector<std::thread> workers;
    for (int w = 1; w <= 4; ++w)
        workers.emplace_back([this, w] { work(w); });
    Random random(testSeed());
    const auto end = Steady::now() + std::chrono::duration<double>(wanted());
    auto said = Steady::now();
    auto report = [&] {
        std::printf(
            "ice soak: %u calls, %u answered, %u reported; %u reboots of the UAV, %u resets of "
            "modems, %u starts of the ground\n",
            calls_.load(), answered_.load(), reported_.load(), reboots_, modemResets_,
            groundRestarts_);
        std::fflush(stdout);
    };
    while (Steady::now() < end || answered_ == 0) { // a busy machine takes longer
        std::this_thread::sleep_for(std::chrono::milliseconds(1500 + random.below(1500)));
        misfortune(random);
        if (Steady::now() - said > std::chrono::seconds(15)) {
            said = Steady::now();
            report();
        }
    }
    stop_ = true;
    world_.rig.with([&] { world_.rig.air.weather = {}; });
    for (auto& worker : workers)
        worker.join();
    // Good weather: it works again, by one of the workers' three connections: a fourth would be
    // refused. Minutes only where modem set-ups starve on a busy machine.
    bool works = false;
    const auto hung = Steady::now() + std::chrono::minutes(5);
    for (int tries = 0; Steady::now() < hung && !works; ++tries) {
        try {
            auto data = World::pattern(tries, 500);
            works = world_.proxy(ground_.get(), "1")->repeat(1 << 30 | tries, data) == data;
        } catch (const Ice::Exception&) {
            std::this_thread::sleep_for(std::chrono::milliseconds(200));
        }
    }
    ground_.end();
    report();
    EXPECT_TRUE(works) << "no call succeeds in good weather; SEED " << testSeed();
    EXPECT_EQ(wrong_, 0u) << "SEED " << testSeed();
    EXPECT_EQ(world_.echo->twice(), 0) << "SEED " << testSeed();
    EXPECT_GT(answered_, 0u);
    EXPECT_EQ(answered_ + reported_, calls_);
    for (auto& fault : faults_)
        ADD_FAILURE() << "a call ended with " << fault << "; SEED " << testSeed();
}

} // namespace
