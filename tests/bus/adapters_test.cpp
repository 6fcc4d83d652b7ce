// SPDX-License-Identifier: MIT
//
// adapters_test: the adapters to Wishbone, classic and pipelined, and to AXI4-Lite, against slaves
// that stall, are ready late, answer late, err, retry and hang.

#include "VAxi4Lite.h"
#include "VWishboneClassic.h"
#include "VWishbonePipelined.h"
#include "bus_master.h"
#include "random.h"
#include <gtest/gtest.h>
#include <map>

// A memory behind Wishbone. It checks the master and misbehaves on request.
template <class Top, bool isPipelined> class WishboneSlave {
public:
    using Module = Top;
    // Waits and retries may exceed TIMEOUT.
    static constexpr bool mayTimeOut = true;
    static constexpr double longestWait = 0.7;
    static constexpr uint32_t pages = isPipelined ? 0xFFFFFFE0 : 0xFE0; // 32 bits of address, or 12

    WishboneSlave(Bench<Module>& bench, uint64_t seed) : top_(bench.top()), random_(seed) {
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
        bool taken = stb && (isPipelined ? !top_.wb_stall_i : !answering_);
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
        top_.wb_stall_i = isPipelined && random_.chance(wait);
    }

    Module& top_;
    Random random_;
    bool open_ = false, answering_ = false, retried_ = false;
    uint32_t data_ = 0;
    unsigned age_ = 0;
};

// A memory behind AXI4-Lite; each channel is ready, and each response valid, after random waits.
class Axi {
public:
    using Module = VAxi4Lite;
    static constexpr bool mayTimeOut = false;
    static constexpr double longestWait = 0.6;
    static constexpr uint32_t pages = 0xFE0;

    Axi(Bench<Module>& bench, uint64_t seed) : top_(bench.top()), random_(seed) {
        bench.addModel([this] { sample(); }, [this] { drive(); });
    }
    double wait = 0, retry = 0; // probability a clock, on every channel; AXI has no retry
    bool hang = false, err = false;
    unsigned hangs = 0; // clocks that it still does, if not 0
    std::map<uint32_t, uint32_t> memory;
    unsigned transfers = 0;

private:
    void sample() {
        if (hangs && !--hangs)
            hang = false;
        if (top_.axi_bvalid_i && top_.axi_bready_o) {
            bValid_ = aw_ = w_ = false;
            ++transfers;
        }
        if (top_.axi_rvalid_i && top_.axi_rready_o) {
            rValid_ = ar_ = false;
            ++transfers;
        }
        if (top_.axi_awvalid_o && top_.axi_awready_i) {
            aw_ = true;
            awAddr_ = top_.axi_awaddr_o;
        }
        if (top_.axi_wvalid_o && top_.axi_wready_i) {
            if (top_.axi_wstrb_o != 15)
                throw std::runtime_error("not a whole word");
            w_ = true;
            wData_ = top_.axi_wdata_o;
        }
        if (top_.axi_arvalid_o && top_.axi_arready_i) {
            ar_ = true;
            arAddr_ = top_.axi_araddr_o;
        }
        if (aw_ && w_ && !bValid_ && !hang && !random_.chance(wait)) {
            bValid_ = true;
            if (!err)
                memory[awAddr_] = wData_;
        }
        if (ar_ && !rValid_ && !hang && !random_.chance(wait)) {
            rValid_ = true;
            rData_ = memory[arAddr_];
        }
    }
    void drive() {
        top_.axi_awready_i = !aw_ && !random_.chance(wait);
        top_.axi_wready_i = !w_ && !random_.chance(wait);
        top_.axi_arready_i = !ar_ && !random_.chance(wait);
        top_.axi_bvalid_i = bValid_;
        top_.axi_rvalid_i = rValid_;
        top_.axi_bresp_i = err ? 2 : 0; // SLVERR
        top_.axi_rresp_i = err ? 3 : 0; // DECERR
        top_.axi_rdata_i = rValid_ ? rData_ : 0xBAD0BAD0;
    }

    Module& top_;
    Random random_;
    bool aw_ = false, w_ = false, ar_ = false, bValid_ = false, rValid_ = false;
    uint32_t awAddr_ = 0, arAddr_ = 0, wData_ = 0, rData_ = 0;
};

// CTest puts these names behind those of the cases.
struct Classic : WishboneSlave<VWishboneClassic, false> {
    using WishboneSlave::WishboneSlave;
};
struct Pipelined : WishboneSlave<VWishbonePipelined, true> {
    using WishboneSlave::WishboneSlave;
};

namespace {

constexpr unsigned pageWord = 3, firstWord = 8, irqEvent = 1, timeoutEvent = 2;

template <class Slave> class Adapter : public ::testing::Test {
protected:
    Adapter() { bench_.reset(); }
    Bench<typename Slave::Module> bench_;
    BusMaster<typename Slave::Module> bus_{bench_};
    Slave slave_{bench_, testSeed(11)};
};

using Slaves = ::testing::Types<Classic, Pipelined, Axi>;
TYPED_TEST_SUITE(Adapter, Slaves);

TYPED_TEST(Adapter, RandomTraffic) {
    Random random(testSeed(5));
    uint32_t pages[128]; // all over the core's addresses
    for (uint32_t& each : pages)
        each = random.next() & TypeParam::pages;
    std::map<uint32_t, uint32_t> reference;
    unsigned count = 0;
    uint32_t page = 0;
    for (double wait : {0.0, 0.3, TypeParam::longestWait}) {
        this->slave_.wait = wait;
        this->slave_.retry = wait / 10;
        for (int i = 0; i < 700; ++i) {
            if (random.chance(0.1)) {
                page = pages[random.below(128)];
                this->bus_.write(pageWord, page);
                ASSERT_EQ(this->bus_.read(pageWord), page);
            }
            unsigned word = random.below(8);
            bool write = random.chance(0.5);
            uint32_t data = random.next();
            auto answer = this->bus_.transfer(write, firstWord + word, data);
            if (TypeParam::mayTimeOut && answer.error) { // reported at the time-out, not before
                ASSERT_GE(answer.cycles, 40u);
                reference[page + 4 * word] = this->slave_.memory[page + 4 * word];
                continue;
            }
            ASSERT_FALSE(answer.error) << "SEED " << testSeed(5) << ", step " << i;
            ++count;
            if (write)
                reference[page + 4 * word] = data;
            else
                ASSERT_EQ(answer.data, reference[page + 4 * word]) << "SEED " << testSeed(5);
        }
    }
    EXPECT_GE(this->slave_.transfers, count) << "one transfer an access";
    if (!TypeParam::mayTimeOut) {
        EXPECT_EQ(this->slave_.transfers, count);
    }
    EXPECT_GT(count, 2000u);
    EXPECT_EQ(reference, this->slave_.memory);
}

TYPED_TEST(Adapter, Errors) {
    this->slave_.err = true;
    EXPECT_TRUE(this->bus_.transfer(true, firstWord, 1).error);
    auto answer = this->bus_.transfer(false, firstWord, 0);
    EXPECT_TRUE(answer.error);
    EXPECT_EQ(answer.data, 0u) << "no data leaks with an error";
    EXPECT_EQ(this->bus_.read(1), 0u) << "an error is no time-out";
    EXPECT_TRUE(this->bus_.transfer(false, 4, 0).error) << "words 4..7 do not exist";
}

TYPED_TEST(Adapter, Interrupt) {
    auto& top = this->bench_.top();
    this->bus_.write(2, irqEvent);
    top.irq_i = 1;
    this->bench_.tick();
    EXPECT_TRUE(top.irq_o);
    this->bus_.write(1, irqEvent);
    EXPECT_TRUE(top.irq_o) << "a level that is still high is not lost";
    top.irq_i = 0;
    this->bus_.write(1, irqEvent);
    this->bench_.tick();
    EXPECT_FALSE(top.irq_o);
}

template <class Slave> class Wishbone : public Adapter<Slave> {};
using WishboneSlaves = ::testing::Types<Classic, Pipelined>;
TYPED_TEST_SUITE(Wishbone, WishboneSlaves);

TYPED_TEST(Wishbone, AHangEndsInATimeOut) {
    this->slave_.hang = true;
    auto answer = this->bus_.transfer(true, firstWord + 1, 5);
    EXPECT_TRUE(answer.error);
    EXPECT_EQ(answer.cycles, 41u) << "TIMEOUT is 40 clocks";
    EXPECT_EQ(this->bus_.read(1), timeoutEvent);
    EXPECT_FALSE(this->bench_.top().wb_cyc_o) << "the cycle ends with the access";
    this->slave_.hang = false;
    this->bus_.write(1, timeoutEvent);
    this->bus_.write(firstWord + 1, 6);
    EXPECT_EQ(this->bus_.read(firstWord + 1), 6u) << "and the next access works";
}

// The answer is late by a clock, missing, or in time: each access reports it, and the next one does
// not.
TYPED_TEST(Wishbone, AnswersAroundTheTimeOut) {
    for (uint32_t k = 0; k < 8; ++k)
        this->slave_.memory[4 * k] = 100 + k;
    bool hasFailed = false, hasWorked = false;
    for (unsigned clocks = 30; clocks < 50; ++clocks) {
        this->slave_.answerAt = clocks;
        auto answer = this->bus_.transfer(false, firstWord + clocks % 8, 0);
        bool late = this->bus_.takeEvents() & timeoutEvent;
        EXPECT_EQ(answer.error, late) << clocks;
        EXPECT_EQ(answer.data, late ? 0 : 100 + clocks % 8) << clocks;
        EXPECT_FALSE(hasFailed && !late) << "the longer wait is in time: " << clocks;
        (late ? hasFailed : hasWorked) = true;
    }
    EXPECT_TRUE(hasFailed && hasWorked);
}

using AxiAdapter = Adapter<Axi>;

// AXI cannot give a transfer up: its late response must not answer the next access.
TEST_F(AxiAdapter, ALateResponseIsNotTheNextAnswer) {
    slave_.memory[0x00] = 0x0000AAAA;
    slave_.memory[0x04] = 0x0000BBBB;
    slave_.hang = true;
    auto answer = bus_.transfer(false, firstWord, 0);
    EXPECT_TRUE(answer.error);
    EXPECT_EQ(answer.cycles, 41u) << "TIMEOUT is 40 clocks";
    EXPECT_EQ(bus_.read(1), timeoutEvent);
    EXPECT_TRUE(bus_.transfer(false, firstWord + 1, 0).error) << "the core still owes the first";
    slave_.hangs = 5; // it answers in the midst of the next access
    EXPECT_EQ(bus_.read(firstWord + 1), 0xBBBBu);
    EXPECT_EQ(bus_.read(firstWord), 0xAAAAu);
    bus_.write(firstWord, 7);
    EXPECT_EQ(bus_.read(firstWord), 7u);
}

} // namespace
