// SPDX-License-Identifier: MIT
//
// any_bridge: the fixture of the tests of fsmc_bridge and fsmc_sync_bridge, with the checks that
// both bridges must pass.

#pragma once

#include "traffic.h"

template <class Model> class AnyBridge : public ::testing::Test {
protected:
    void SetUp() override {
        RecordProperty("seed", static_cast<int>(testSeed()));
        ASSERT_EQ(b_.init(), FSMC_OK); // uses the driver's settings for this bridge
        doorbell();                    // waits for the last write of init(), which is posted
    }
    static uint32_t at(uint32_t word) { return control + 4 * word; }
    // Reads a register. When this access ends, all earlier writes have reached the memory.
    void doorbell() { b_.master.read32(at(0)); }

    void doorbellMakesWritesVisibleAndReadsFresh() {
        fsmc_.write16(ddr + 0x100, 0xBEEF);
        doorbell();
        EXPECT_EQ(b_.memory.byte(0x100), 0xEF);
        EXPECT_EQ(fsmc_.read16(ddr + 0x100), 0xBEEF);
        b_.memory.setByte(0x100, 0x11); // another master
        doorbell();
        EXPECT_EQ(fsmc_.read16(ddr + 0x100), 0xBE11);
    }

    void errorOfTheSlaveIsReportedWithItsPlace() {
        b_.slave.firstError = 500;
        EXPECT_EQ(fsmc_.read32(at(700)), 0u);
        EXPECT_EQ(b_.errors, 1u);
        EXPECT_EQ(b_.errorAddr, 700u);
        EXPECT_FALSE(b_.errorWrite);
        fsmc_.write32(at(800), 1);
        doorbell();
        EXPECT_EQ(b_.errors, 2u);
        EXPECT_EQ(b_.errorAddr, 800u);
        EXPECT_TRUE(b_.errorWrite);
        fsmc_.read32(control + 0x2000); // an address beyond the 64 slots
        EXPECT_GE(b_.errors, 3u);
    }

    void hungSlaveEndsInAnError() {
        b_.slave.hung = true;
        fsmc_.read16(at(33));
        EXPECT_EQ(b_.errors, 1u);
        EXPECT_EQ(b_.errorAddr, 33u);
        b_.slave.hung = false;
        fsmc_.write32(at(34), 0x12345678);
        EXPECT_EQ(fsmc_.read32(at(34)), 0x12345678u);
        EXPECT_EQ(b_.errors, 1u);
    }

    // Checks that a read ends in an error if the memory does not answer. Afterwards the memory
    // still does not answer; call memoryWorksAgain().
    void readOfAHungMemoryEndsInAnError() {
        b_.memory.setByte(0x40, 0x77);
        b_.memory.hold(true);
        fsmc_.read16(ddr + 0x40);
        EXPECT_EQ(b_.errors, 1u);
        EXPECT_EQ(b_.errorAddr, 0x3FFu);
        EXPECT_FALSE(b_.errorWrite);
    }
    void memoryWorksAgain() {
        b_.memory.hold(false);
        EXPECT_EQ(fsmc_.read16(ddr + 0x40), 0x77)
            << "a late answer must not be used for a later request";
        EXPECT_EQ(fsmc_.read16(ddr + 0x80), 0);
    }

    BridgeBench<Model> b_{testSeed()};
    FsmcMaster& fsmc_ = b_.master;
};
