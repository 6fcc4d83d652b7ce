// SPDX-License-Identifier: MIT
//
// random_test: checks that the registers of the random number generator behave as RM0033, 20
// describes.

#include "random_block.h"
#include <gtest/gtest.h>
#include <set>

namespace {

constexpr uint32_t control = 0, status = 4, data = 8, enable = 4, ready = 1, noClock = 0x22,
                   badSeed = 0x44;

class RandomNumbers : public testing::Test {
protected:
    uint32_t read(uint32_t offset, bool hasClock = true) {
        return block_.read(offset, ns_, hasClock);
    }
    void write(uint32_t offset, uint32_t value) { block_.write(offset, value, ns_); }
    void pass(uint64_t ns) { ns_ += ns; }
    RandomBlock block_{7};
    uint64_t ns_ = 1000;
};

TEST_F(RandomNumbers, ANumberIsReadyEvery40PeriodsOf48MHz) {
    pass(10'000);
    EXPECT_EQ(read(status), 0u) << "the generator is off";
    write(control, enable);
    pass(832);
    EXPECT_EQ(read(status) | read(data), 0u);
    pass(1);
    EXPECT_EQ(read(status), ready);
    EXPECT_NE(read(data), 0u);
    EXPECT_EQ(read(status) | read(data), 0u)
        << "the next number must take as long as the first one";
}

TEST_F(RandomNumbers, NumbersDoNotRepeatAndDependOnTheSeed) {
    std::set<uint32_t> seen;
    RandomBlock other(8);
    write(control, enable);
    other.write(control, enable, ns_);
    for (int i = 0; i < 1000; ++i) {
        pass(833);
        EXPECT_TRUE(seen.insert(read(data)).second);
        EXPECT_TRUE(seen.insert(other.read(data, ns_, true)).second);
    }
}

TEST_F(RandomNumbers, AMissingClockIsReported) {
    write(control, enable);
    pass(1000);
    EXPECT_EQ(read(status, false), noClock);
    EXPECT_EQ(read(data, false), 0u);
    EXPECT_EQ(read(status), (noClock & 0x60) | ready);
    write(status, 0);
    EXPECT_EQ(read(status), ready);
}

TEST_F(RandomNumbers, ASeedErrorLastsUntilTheGeneratorIsRestarted) {
    write(control, enable);
    pass(1000);
    block_.fail();
    EXPECT_EQ(read(status), badSeed);
    EXPECT_EQ(read(data), 0u);
    write(status, 0);
    EXPECT_EQ(read(status), badSeed & 7);
    write(control, 0);
    write(control, enable);
    pass(833);
    EXPECT_EQ(read(status), ready);
}

} // namespace
