// SPDX-License-Identifier: MIT
//
// litedram_model_test: the LiteDRAM model's native port: order, bank lock, and what it refuses.

#include "litedram_model.h"
#include <gtest/gtest.h>
#include <vector>

namespace {

class Litedram : public ::testing::Test {
protected:
    void SetUp() override {
        while (!memory_.pins.initDone)
            memory_.cycle();
        memory_.pins.rdataReady = memory_.pins.wdataValid = true;
    }
    void cycle(unsigned times = 1) {
        for (unsigned i = 0; i < times; ++i) {
            memory_.cycle();
            if (memory_.pins.rdataValid)
                words_.push_back(memory_.pins.rdataData);
        }
    }
    // Clocks until the command is taken.
    unsigned command(bool write, uint32_t word) {
        memory_.pins.cmdValid = true;
        memory_.pins.cmdWe = write;
        memory_.pins.cmdAddr = word;
        unsigned clocks = 0;
        do {
            memory_.pins.cmdReady = memory_.ready(word);
            cycle();
            ++clocks;
        } while (!memory_.pins.cmdReady && clocks < 1000);
        memory_.pins.cmdValid = false;
        return clocks;
    }

    LitedramModel memory_{1 << 20};
    std::vector<uint64_t> words_;
};

TEST_F(Litedram, ReadsSeeTheWritesBeforeThemAndNoneAfter) {
    memory_.pins.wdataData = 7;
    memory_.pins.wdataWe = 0x0F;
    command(true, 5);
    command(false, 5);
    command(true, 5); // takes the word that is shown then
    command(false, 5);
    while (!memory_.pins.wdataReady)
        cycle();
    cycle();
    memory_.pins.wdataData = 9;
    cycle(100);
    EXPECT_EQ(words_, (std::vector<uint64_t>{7, 9}));
    EXPECT_EQ(memory_.wordsWritten, 2u);
}

TEST_F(Litedram, OneWordAClockInAnOpenRow) {
    for (uint32_t word = 0; word < 8; ++word)
        command(false, word);
    cycle(60);
    words_.clear();
    unsigned clocks = 0;
    for (uint32_t word = 0; word < 64; ++word)
        clocks += command(false, word);
    EXPECT_EQ(clocks, 64u);
}

TEST_F(Litedram, AnotherBankWaitsUntilTheCommandsOfTheFirstAreIssued) {
    EXPECT_EQ(command(false, 0), 1u);
    EXPECT_EQ(command(false, 1), 1u);
    EXPECT_GT(command(false, 128), 3u) << "1 KiB further is the next bank";
}

TEST_F(Litedram, AWriteWithoutItsWordIsRefused) {
    memory_.pins.wdataValid = false;
    command(true, 0);
    EXPECT_THROW(cycle(50), LitedramError);
}

TEST_F(Litedram, AReadWordThatNobodyTakesIsRefused) {
    memory_.pins.rdataReady = false;
    command(false, 0);
    EXPECT_THROW(cycle(50), LitedramError);
}

TEST_F(Litedram, ACommandThatWaitsMayNotChange) {
    command(false, 0);
    memory_.pins.cmdValid = true;
    memory_.pins.cmdAddr = 128;
    memory_.pins.cmdReady = memory_.ready(128);
    ASSERT_FALSE(memory_.pins.cmdReady);
    cycle();
    memory_.pins.cmdAddr = 129;
    EXPECT_THROW(cycle(), LitedramError);
}

TEST_F(Litedram, AddressesBeyondTheMemoryAreRefused) {
    EXPECT_THROW(command(false, (1 << 20) / 8), LitedramError);
}

} // namespace
