// SPDX-License-Identifier: MIT
//
// axi4_test: a master's bursts through axi4_memory, at a port that stalls: data, ids, order, what
// is refused, speed.

#include "VAxi4Memory.h"
#include "npi_memory.h"
#include <gtest/gtest.h>

namespace {

struct Burst {
    uint32_t address;
    unsigned beats;
    uint8_t size = 3, kind = 1;
    bool refused() const { return beats > 1 && (size != 3 || kind != 1); }
};

class Axi4 : public ::testing::Test {
protected:
    explicit Axi4(double stall = 0.2) : memory_(bench_, stall, testSeed()) {
        bench_.addModel([this] { sample(); }, [this] { drive(); });
        bench_.reset();
        for (uint32_t a = 0; a < 1 << 16; ++a)
            memory_.setByte(a, was(a));
    }
    static uint8_t was(uint32_t address) { return static_cast<uint8_t>(address * 59 >> 4); }
    uint8_t wrote(size_t burst, uint32_t byte) const {
        return static_cast<uint8_t>(burst * 37 + byte);
    }
    // Reads and writes go side by side, each direction in its order.
    void run(std::vector<Burst> reads, std::vector<Burst> writes) {
        reads_ = std::move(reads);
        writes_ = std::move(writes);
        bench_.waitFor([&] { return readEnds_ == reads_.size() && writeEnds_ == writes_.size(); },
                       "the last answer", 200000);
    }
    void expectWritten(size_t number) {
        const Burst& w = writes_[number];
        for (uint32_t b = 0; b < 8 * w.beats; ++b)
            ASSERT_EQ(memory_.byte(w.address + b),
                      w.refused() || b % 8 == 5 ? was(w.address + b) : wrote(number, b))
                << "byte " << b << " of write " << number;
    }

    Random random_{testSeed()};
    double pause_ = 0.2;
    Bench<VAxi4Memory> bench_;
    NpiMemory<VAxi4Memory> memory_;
    std::vector<Burst> reads_, writes_;
    size_t readAsks_ = 0, writeAsks_ = 0, dataOf_ = 0, readEnds_ = 0, writeEnds_ = 0;
    unsigned beat_ = 0, dataBeat_ = 0;

private:
    void sample() {
        auto& t = bench_.top();
        readAsks_ += t.arvalid_i && t.arready_o;
        writeAsks_ += t.awvalid_i && t.awready_o;
        if (t.wvalid_i && t.wready_o && ++dataBeat_ == writes_[dataOf_].beats)
            dataBeat_ = 0, ++dataOf_;
        if (t.bvalid_o && t.bready_i) {
            EXPECT_EQ(t.bid_o, writeEnds_ % 16);
            EXPECT_EQ(t.bresp_o, writes_[writeEnds_].refused() ? 2 : 0);
            ++writeEnds_;
        }
        if (t.rvalid_o && t.rready_i) {
            const Burst& r = reads_[readEnds_];
            EXPECT_EQ(t.rid_o, readEnds_ % 16);
            EXPECT_EQ(t.rresp_o, r.refused() ? 2 : 0);
            EXPECT_EQ(t.rlast_o, beat_ + 1 == r.beats);
            for (uint32_t b = 0; b < 8 && !r.refused(); ++b)
                EXPECT_EQ(uint8_t(t.rdata_o >> (8 * b)), was((r.address & ~7u) + 8 * beat_ + b));
            if (++beat_ == r.beats)
                beat_ = 0, ++readEnds_;
        }
    }
    void drive() {
        auto& t = bench_.top();
        t.arvalid_i = readAsks_ < reads_.size();
        if (t.arvalid_i) {
            const Burst& r = reads_[readAsks_];
            t.araddr_i = r.address, t.arlen_i = static_cast<uint8_t>(r.beats - 1);
            t.arsize_i = r.size, t.arburst_i = r.kind, t.arid_i = readAsks_ % 16;
        }
        t.awvalid_i = writeAsks_ < writes_.size();
        if (t.awvalid_i) {
            const Burst& w = writes_[writeAsks_];
            t.awaddr_i = w.address, t.awlen_i = static_cast<uint8_t>(w.beats - 1);
            t.awsize_i = w.size, t.awburst_i = w.kind, t.awid_i = writeAsks_ % 16;
        }
        t.wvalid_i = dataOf_ < writes_.size();
        if (t.wvalid_i) {
            t.wdata_i = 0;
            for (uint32_t b = 0; b < 8; ++b)
                t.wdata_i |= uint64_t(wrote(dataOf_, 8 * dataBeat_ + b)) << (8 * b);
            t.wstrb_i = 0xDF; // byte 5 of each word stays
            t.wlast_i = dataBeat_ + 1 == writes_[dataOf_].beats;
        }
        t.rready_i = !random_.chance(pause_);
        t.bready_i = !random_.chance(pause_);
    }
};

TEST_F(Axi4, BurstsReadAndWriteWhatTheySay) {
    std::vector<Burst> reads, writes;
    for (uint32_t i = 0; i < 200; ++i) {
        unsigned beats = 1 + random_.below(random_.chance(0.1) ? 256 : 16);
        reads.push_back({8 * random_.below(2048) + (random_.chance(0.2) ? 4u : 0u), beats});
        writes.push_back({0x8000 + 128 * i, 1 + random_.below(16)});
        if (i % 7 == 3)
            reads.back().kind = 0, writes.back().size = 2; // FIXED; narrow
        if (i % 7 == 5)
            reads.back().size = 1, writes.back().kind = 2; // narrow; WRAP
    }
    run(reads, writes);
    for (size_t i = 0; i < writes.size(); ++i)
        expectWritten(i);
}

class Axi4Unhindered : public Axi4 {
protected:
    Axi4Unhindered() : Axi4(0) { pause_ = 0; }
};

TEST_F(Axi4Unhindered, BurstsOf16FollowEachOtherWithoutAGap) {
    uint64_t start = bench_.cycles();
    std::vector<Burst> bursts;
    for (uint32_t i = 0; i < 100; ++i)
        bursts.push_back({128 * i, 16});
    run(bursts, {});
    double reads = 1600.0 / static_cast<double>(bench_.cycles() - start);
    for (auto& b : bursts)
        b.address += 0x8000;
    start = bench_.cycles();
    reads_.clear(), readAsks_ = readEnds_ = 0;
    run({}, bursts);
    double writes = 1600.0 / static_cast<double>(bench_.cycles() - start);
    printf("bursts of 16 beats, words a clock: reads %.3f, writes %.3f\n", reads, writes);
    EXPECT_GE(reads, 0.95);
    EXPECT_GE(writes, 0.95);
}

} // namespace
