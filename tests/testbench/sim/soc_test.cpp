// SPDX-License-Identifier: MIT
//
// soc_test: tests the whole chip through its FSMC pins: registers, memory, and errors.

#include "driver_port.h"
#include "map_regs.h"
#include "modem_regs.h"
#include "pin_delays.h"
#include "random.h"
#include "soc_model.h"
#include "system_regs.h"
#include <cstring>
#include <gtest/gtest.h>
#include <map>
#include <vector>

namespace {

constexpr uint32_t ddr = MAP_DDR_WINDOW, control = MAP_CONTROL_WINDOW;

class Soc : public ::testing::Test {
protected:
    void SetUp() override {
        soc_.reset();
        // the driver's settings depend on the bridge of the chip (BRIDGE)
        ASSERT_EQ(FSMC_init(&driverPort, &fsmc_), FSMC_OK);
    }
    static uint32_t at(uint32_t slot, uint32_t word) { return control + 64 * slot + 4 * word; }
    uint32_t read(uint32_t slot, uint32_t word) { return fsmc_.read32(at(slot, word)); }
    void write(uint32_t slot, uint32_t word, uint32_t value) {
        fsmc_.write32(at(slot, word), value);
    }

    RfChannel air_{testSeed()};
    SocModel soc_{air_, {}};
    FsmcMaster& fsmc_ = soc_.fsmc();
};

TEST_F(Soc, SlotsIdentifyTheirCores) {
    EXPECT_EQ(read(MAP_SLOT_SYSTEM, SYSTEM_ID), SYSTEM_ID_VALUE);
    EXPECT_EQ(read(MAP_SLOT_MODEM, MODEM_ID), MODEM_ID_VALUE);
    EXPECT_EQ(read(MAP_SLOT_SYSTEM, SYSTEM_SLOTS), MAP_SLOT_COUNT);
    EXPECT_EQ(read(MAP_SLOT_SYSTEM, SYSTEM_CLK_HZ), SocModel::clkHz);
}

TEST_F(Soc, AnUnmappedRegisterIsReportedAndTheSystemContinues) {
    write(MAP_SLOT_SYSTEM, SYSTEM_MASK, 1);
    const uint32_t places[][2] = {{62, 5}, {63, 15}, {MAP_SLOT_SYSTEM, 13}};
    for (auto& place : places) {
        EXPECT_EQ(read(place[0], place[1]), 0u);
        EXPECT_TRUE(soc_.irq());
        EXPECT_EQ(read(MAP_SLOT_SYSTEM, SYSTEM_EVENT), SYSTEM_EVENT_BUS_ERROR_MASK);
        EXPECT_EQ(read(MAP_SLOT_SYSTEM, SYSTEM_ERROR_ADDR), place[0] * 16 + place[1]);
        write(MAP_SLOT_SYSTEM, SYSTEM_EVENT, SYSTEM_EVENT_BUS_ERROR_MASK);
        EXPECT_EQ(read(MAP_SLOT_SYSTEM, SYSTEM_EVENT), 0u);
        EXPECT_FALSE(soc_.irq());
    }
    write(40, 3, 7);
    EXPECT_EQ(read(MAP_SLOT_SYSTEM, SYSTEM_ERROR_ADDR), 1u << 16 | (40u * 16 + 3));
    write(MAP_SLOT_SYSTEM, SYSTEM_SCRATCH, 99);
    EXPECT_EQ(read(MAP_SLOT_SYSTEM, SYSTEM_SCRATCH), 99u);
}

TEST_F(Soc, ThePageRegisterSelectsTheUpperHalf) {
    write(MAP_SLOT_SYSTEM, SYSTEM_PAGE, 1);
    fsmc_.write16(ddr + 0x40, 0x5A5A);
    write(MAP_SLOT_SYSTEM, SYSTEM_PAGE, 0);
    // this read waits until the posted write has been done
    EXPECT_EQ(read(MAP_SLOT_SYSTEM, SYSTEM_PAGE), 0u);
    EXPECT_EQ(soc_.memory().data()[0x04000040], 0x5A);
    EXPECT_EQ(fsmc_.read16(ddr + 0x40), 0);
}

// Sets each address line by itself, and each data line to both levels. This detects a line that is
// cut, or connected to another line. The memory has 128 MiB.
TEST_F(Soc, EveryLineToTheMemoryIsConnected) {
    uint32_t page = 0;
    auto place = [&](uint32_t address) {
        if (address >> 26 != page) {
            page = address >> 26;
            write(MAP_SLOT_SYSTEM, SYSTEM_PAGE, page);
            read(MAP_SLOT_SYSTEM, SYSTEM_PAGE); // waits, because writes to registers are posted
        }
        return ddr + (address & 0x03FFFFFF);
    };
    std::map<uint32_t, uint16_t> expected;
    for (int round = 0; round < 2; ++round) {
        for (unsigned bit = 1; bit < 27; ++bit) {
            uint32_t address = round ? 0x07FFFFFE & ~(1u << bit) : 1u << bit;
            uint16_t value = static_cast<uint16_t>(bit % 2 ? 1u << bit % 16 : ~(1u << bit % 16));
            fsmc_.write16(place(address), value);
            expected[address] = value;
        }
    }
    for (auto [address, value] : expected)
        EXPECT_EQ(fsmc_.read16(place(address)), value) << std::hex << address;
    // the page register also stores bits for addresses beyond the memory
    for (unsigned bit = 0; bit < 6; ++bit) {
        write(MAP_SLOT_SYSTEM, SYSTEM_PAGE, 1u << bit);
        EXPECT_EQ(read(MAP_SLOT_SYSTEM, SYSTEM_PAGE), 1u << bit);
    }
}

// Writes words with a single bit set to the writable registers of all slots, and reads them back.
TEST_F(Soc, EveryLineToTheSlotsIsConnected) {
    for (unsigned bit = 0; bit < 32; ++bit) {
        write(MAP_SLOT_SYSTEM, SYSTEM_SCRATCH, 1u << bit);
        EXPECT_EQ(read(MAP_SLOT_SYSTEM, SYSTEM_SCRATCH), 1u << bit);
        uint32_t address = 1u << bit & 0xFFFFF800; // rings of the modem begin at multiples of 2048
        write(MAP_SLOT_MODEM, MODEM_TX_BASE, address);
        EXPECT_EQ(read(MAP_SLOT_MODEM, MODEM_TX_BASE), address);
    }
    // every slot must answer; a slot that is empty answers with an error
    for (unsigned slot = 0; slot < 64; ++slot)
        read(slot, 0);
}

// The processor starts before the DDR3 is ready, as on a board. Nothing may hang, early accesses
// must be reported, and posted writes must be kept.
TEST_F(Soc, AnAccessDuringMemoryStartIsReported) {
    soc_.reset(true);
    fsmc_.write16(ddr + 0x100, 0x1234);
    (void)fsmc_.read16(ddr);
    EXPECT_TRUE(read(MAP_SLOT_SYSTEM, SYSTEM_EVENT) & SYSTEM_EVENT_BUS_ERROR_MASK);
    EXPECT_EQ(read(MAP_SLOT_SYSTEM, SYSTEM_ERROR_ADDR) & 0x3FF, 0x3FFu);
    EXPECT_LT(soc_.cycles(), 30'000u);
    while (soc_.cycles() < 2 * McbModel::startClocks)
        soc_.tick();
    write(MAP_SLOT_SYSTEM, SYSTEM_EVENT, SYSTEM_EVENT_BUS_ERROR_MASK | SYSTEM_EVENT_LATE_MASK);
    EXPECT_EQ(fsmc_.read16(ddr + 0x100), 0x1234);
    EXPECT_EQ(read(MAP_SLOT_SYSTEM, SYSTEM_EVENT), 0u);
}

// Accesses registers and memory of the chip, or of its netlist, through wires with real delays, in
// each corner.
TEST(SocCorners, NoAccessIsLostInAnyCorner) {
    for (unsigned index = 0; index < std::size(fsmcCorners); ++index)
        for (unsigned hclk : {60u, 100u, 120u})
            for (bool looksTwice : {false, true}) {
                const FsmcCorner corner = cornerOf(index);
                SCOPED_TRACE(std::string(corner.name) + ", HCLK " + std::to_string(hclk) +
                             " MHz, looks " + (looksTwice ? "twice" : "once"));
                RfChannel air(testSeed());
                SocModel soc(air, {}, hclk, 100);
                FsmcMaster& m = soc.fsmc();
                soc.reset();
                soc.delay(corner, testSeed() + hclk, looksTwice);
                ASSERT_EQ(FSMC_init(&driverPort, &m), FSMC_OK);
                Random random(testSeed() + hclk);
                std::vector<uint8_t> memory(256);
                for (int i = 0; i < 100; ++i) {
                    const uint32_t v = random.next(), place = random.below(64) * 4;
                    const uint32_t scratch = control + 64 * MAP_SLOT_SYSTEM + 4 * SYSTEM_SCRATCH;
                    m.write32(ddr + place, v);
                    std::memcpy(&memory[place], &v, 4);
                    m.write8(ddr + (v & 0xFF), memory[v & 0xFF] = static_cast<uint8_t>(i));
                    m.write32(scratch, ~v);
                    EXPECT_EQ(m.read32(scratch), ~v);
                    uint16_t half;
                    std::memcpy(&half, &memory[v & 0xFE], 2);
                    EXPECT_EQ(m.read16(ddr + (v & 0xFE)), half);
                }
                EXPECT_EQ(m.read32(control + 64 * MAP_SLOT_SYSTEM + 4 * SYSTEM_EVENT) &
                              SYSTEM_EVENT_BUS_ERROR_MASK,
                          0u);
                if (HasFailure())
                    return;
            }
}

} // namespace
