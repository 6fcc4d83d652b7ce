// SPDX-License-Identifier: MIT
//
// wishbone_test: the adapter against Wishbone slaves that stall, answer late, err, retry and hang.

#include "VWishboneClassic.h"
#include "VWishbonePipelined.h"
#include "bus_master.h"
#include "random.h"
#include <gtest/gtest.h>
#include <map>

namespace {

constexpr unsigned pageWord = 3, firstWord = 8, irqEvent = 1, timeoutEvent = 2;

// A memory behind Wishbone. It checks the master and misbehaves on request.
template <class Module> class Slave {
public:
    Slave(Bench<Module>& bench, bool pipelined, uint64_t seed)
        : top_(bench.top()), pipelined_(pipelined), random_(seed) {
        bench.addModel([this] { sample(); }, [this] { drive(); });
    }
    double wait = 0, retry = 0; // probability a clock
    bool hang = false, err = false;
    unsigned answerAt = 0; // clocks after which a cycle is answered, not sooner
    std::map<uint32_t, uint32_t> memory;
    unsigned transfers = 0;

private:
    void sample() {
        bool cyc = top_.wb_cyc_o, stb = top_.wb_stb_o;
        if (stb && !cyc)
            throw std::runtime_error("STB without CYC");
        if (top_.wb_sel_o != 15 || top_.wb_adr_o % 4)
            throw std::runtime_error("not a whole word");
        bool taken = stb && (pipelined_ ? !top_.wb_stall_i : !answering_);
        if (!cyc)
            open_ = false;
        if (answering_)
            open_ = false;
        else if (taken)
            open_ = true;
        answering_ = false;
        age_ = open_ ? age_ + 1 : 0;
        if (!open_ || hang || age_ < answerAt || random_.chance(wait))
            return;
        answering_ = true;
        retried_ = random_.chance(retry);
        if (retried_ || err)
            return;
        ++transfers;
        if (top_.wb_we_o)
            memory[top_.wb_adr_o] = top_.wb_dat_o;
        data_ = memory[top_.wb_adr_o];
    }
    void drive() {
        top_.wb_ack_i = answering_ && !retried_ && !err;
        top_.wb_err_i = answering_ && !retried_ && err;
        top_.wb_rty_i = answering_ && retried_;
        top_.wb_dat_i = top_.wb_ack_i ? data_ : 0xBAD0BAD0;
        top_.wb_stall_i = pipelined_ && random_.chance(wait);
    }

    Module& top_;
    bool pipelined_;
    Random random_;
    bool open_ = false, answering_ = false, retried_ = false;
    uint32_t data_ = 0;
    unsigned age_ = 0;
};

template <class Module> struct Rig {
    explicit Rig(bool pipelined) : slave(bench, pipelined, testSeed(11)) { bench.reset(); }
    Bench<Module> bench;
    BusMaster<Module> bus{bench};
    Slave<Module> slave;
};

template <class Module> void randomTraffic(bool pipelined) {
    Rig<Module> rig(pipelined);
    Random random(testSeed(5));
    uint32_t pages[128]; // all over the core's addresses: 32 bits of them, or 12
    for (uint32_t& each : pages)
        each = random.next() & (pipelined ? 0xFFFFFFE0 : 0xFE0);
    std::map<uint32_t, uint32_t> reference;
    unsigned count = 0;
    uint32_t page = 0;
    for (double wait : {0.0, 0.3, 0.7}) {
        rig.slave.wait = wait;
        rig.slave.retry = wait / 10;
        for (int i = 0; i < 700; ++i) {
            if (random.chance(0.1)) {
                page = pages[random.below(128)];
                rig.bus.write(pageWord, page);
                ASSERT_EQ(rig.bus.read(pageWord), page);
            }
            unsigned word = random.below(8);
            bool write = random.chance(0.5);
            uint32_t data = random.next();
            auto answer = rig.bus.transfer(write, firstWord + word, data);
            if (answer.error) { // waits and retries may exceed TIMEOUT: then it is reported, not in
                                // between
                ASSERT_GE(answer.cycles, 40u);
                reference[page + 4 * word] = rig.slave.memory[page + 4 * word];
                continue;
            }
            ++count;
            if (write)
                reference[page + 4 * word] = data;
            else
                ASSERT_EQ(answer.data, reference[page + 4 * word]) << "SEED " << testSeed(5);
        }
    }
    EXPECT_GE(rig.slave.transfers, count) << "one transfer an access";
    EXPECT_GT(count, 2000u);
    EXPECT_EQ(reference, rig.slave.memory);
}

template <class Module> void misbehaviour(bool pipelined) {
    Rig<Module> rig(pipelined);
    rig.slave.err = true;
    auto answer = rig.bus.transfer(false, firstWord, 0);
    EXPECT_TRUE(answer.error);
    EXPECT_EQ(answer.data, 0u) << "no data leaks with an error";
    EXPECT_EQ(rig.bus.read(1), 0u) << "an error is no time-out";
    rig.slave.err = false;

    rig.slave.hang = true;
    answer = rig.bus.transfer(true, firstWord + 1, 5);
    EXPECT_TRUE(answer.error);
    EXPECT_EQ(answer.cycles, 41u) << "TIMEOUT is 40 clocks";
    EXPECT_EQ(rig.bus.read(1), timeoutEvent);
    EXPECT_FALSE(rig.bench.top().wb_cyc_o) << "the cycle ends with the access";
    rig.slave.hang = false;
    rig.bus.write(1, timeoutEvent);
    rig.bus.write(firstWord + 1, 6);
    EXPECT_EQ(rig.bus.read(firstWord + 1), 6u) << "and the next access works";
    EXPECT_TRUE(rig.bus.transfer(false, 4, 0).error) << "words 4..7 do not exist";
}

// The answer is late by a clock, missing, or in time: each access reports it, and the next one does
// not.
template <class Module> void aroundTheTimeOut(bool pipelined) {
    Rig<Module> rig(pipelined);
    for (uint32_t k = 0; k < 8; ++k)
        rig.slave.memory[4 * k] = 100 + k;
    bool hasFailed = false, hasWorked = false;
    for (unsigned clocks = 30; clocks < 50; ++clocks) {
        rig.slave.answerAt = clocks;
        auto answer = rig.bus.transfer(false, firstWord + clocks % 8, 0);
        bool late = rig.bus.read(1) & timeoutEvent;
        rig.bus.write(1, timeoutEvent);
        EXPECT_EQ(answer.error, late) << clocks;
        EXPECT_EQ(answer.data, late ? 0 : 100 + clocks % 8) << clocks;
        EXPECT_FALSE(hasFailed && !late) << "the longer wait is in time: " << clocks;
        (late ? hasFailed : hasWorked) = true;
    }
    EXPECT_TRUE(hasFailed && hasWorked);
}

template <class Module> void interrupt(bool pipelined) {
    Rig<Module> rig(pipelined);
    auto& top = rig.bench.top();
    rig.bus.write(2, irqEvent);
    top.irq_i = 1;
    rig.bench.tick();
    EXPECT_TRUE(top.irq_o);
    rig.bus.write(1, irqEvent);
    EXPECT_TRUE(top.irq_o) << "a level that is still high is not lost";
    top.irq_i = 0;
    rig.bus.write(1, irqEvent);
    rig.bench.tick();
    EXPECT_FALSE(top.irq_o);
}

TEST(WishboneClassic, RandomTraffic) {
    randomTraffic<VWishboneClassic>(false);
}
TEST(WishboneClassic, ErrorsAndHangs) {
    misbehaviour<VWishboneClassic>(false);
}
TEST(WishboneClassic, AnswersAroundTheTimeOut) {
    aroundTheTimeOut<VWishboneClassic>(false);
}
TEST(WishbonePipelined, AnswersAroundTheTimeOut) {
    aroundTheTimeOut<VWishbonePipelined>(true);
}
TEST(WishboneClassic, Interrupt) {
    interrupt<VWishboneClassic>(false);
}
TEST(WishbonePipelined, RandomTraffic) {
    randomTraffic<VWishbonePipelined>(true);
}
TEST(WishbonePipelined, ErrorsAndHangs) {
    misbehaviour<VWishbonePipelined>(true);
}
TEST(WishbonePipelined, Interrupt) {
    interrupt<VWishbonePipelined>(true);
}

} // namespace
