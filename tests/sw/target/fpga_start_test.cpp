// SPDX-License-Identifier: MIT
//
// fpga_start_test: the firmware's ARM binary, at its start, has the FPGA load a bitstream, hears
// the addresses of its reads in flash, and knows which one runs.

#include "stm32f2.h"
#include "vehicle_folder.h"
#include <algorithm>
#include <cstring>
#include <gtest/gtest.h>

extern "C" {
#include "slots.h"
#include "uav_keys.h"
}

namespace {

constexpr uint32_t flashBase = 0x08000000, frameWords = 2000;
const uint32_t slot = Slots_at(&slots_fpga, 1), multiBoot = slot + SLOTS_IMAGE_AT,
               golden = Slots_at(&slots_fpga, 0) + SLOTS_IMAGE_AT;

class FpgaStart : public ::testing::Test {
protected:
    FpgaStart() {
        folder.save("golden.bin", standInBitstream(1, frameWords));
        EXPECT_EQ(folder.pack("vehicle " FIRMWARE "loader.elf " FIRMWARE "uav.elf 7 key flash"), 0)
            << folder.said();
        EXPECT_EQ(folder.pack("fpga golden.bin 1 key fpga"), 0) << folder.said();
        chip.cpu().loadFlash(flashBase, folder.read("flash"));
        flash.memory = folder.read("fpga");
        chip.fpga.wire(flash);
        const ElfImage firmware(FIRMWARE "uav.elf");
        running = firmware.symbol("uav_update") + 16; // of UAV_BITSTREAM
        chip.cpu().breakpoints.insert((firmware.symbol("Provision_listen") & ~1u) +
                                      Slots_at(&slots_firmware, 0) + SLOTS_IMAGE_AT);
        chip.onTime([this] {
            if (chip.cpu().cycles() > limit)
                chip.cpu().stop();
            return now() + 1'000'000;
        });
    }
    uint64_t now() const { return fsmc.hclks() * 25 / 3; } // ns
    // Leaves in the FPGA's flash what a complete update does.
    void receive(const std::vector<uint8_t>& bits) {
        folder.save("new.bin", bits);
        ASSERT_EQ(folder.pack("bitstream new.bin 2 key update"), 0) << folder.said();
        const auto package = folder.read("update");
        const auto image = package.begin() + sizeof(Slots_Header);
        std::copy(package.begin(), image, at(slot));
        std::copy(image, package.end(), at(multiBoot));
        const uint8_t sync[] = {0xAA, 0x99, 0x55, 0x66};
        std::copy(std::begin(sync), std::end(sync), at(multiBoot + SLOTS_SYNC_AT));
    }
    std::vector<uint8_t>::iterator at(uint32_t offset) { return flash.memory.begin() + offset; }
    bool is(Slots_State state) {
        uint32_t word;
        std::memcpy(&word, &*at(slot + state), 4);
        return word == SLOTS_TRUE;
    }
    void confirm() {
        const uint32_t isTrue = SLOTS_TRUE;
        std::memcpy(&*at(slot + SLOTS_TRIED), &isTrue, 4);
        std::memcpy(&*at(slot + SLOTS_CONFIRMED), &isTrue, 4);
    }
    // Switches the power on. Returns the slot of the running bitstream, in the firmware's words and
    // the FPGA's.
    uint32_t start() {
        chip.powerOn();
        limit = chip.cpu().cycles() + 3'000'000'000;
        EXPECT_EQ(chip.run(), CortexM3::Stop::Breakpoint);
        EXPECT_EQ(chip.fpga.boot().running.value_or(0),
                  chip.cpu().word(running) ? multiBoot : golden);
        EXPECT_TRUE(chip.fpga.isDone());
        return chip.cpu().word(running);
    }

    VehicleFolder folder;
    FsmcPins pins;
    FsmcMaster fsmc{
        pins,
        {[] {}, [] {}, [](uint64_t clocks, uint64_t ns) { return std::min(clocks, ns / 10); }}};
    SpiFlash flash{[this] { return now(); }};
    Stm32F2 chip{fsmc, [this] { return now(); }, {}};
    uint32_t running = 0;
    uint64_t limit = 0;
};

TEST_F(FpgaStart, ANewBitstreamIsTriedAndOneNotConfirmedGoes) {
    EXPECT_EQ(start(), 0u);
    receive(standInBitstream(2, frameWords));
    EXPECT_EQ(start(), 1u);
    EXPECT_TRUE(is(SLOTS_TRIED));
    EXPECT_EQ(start(), 0u);
    EXPECT_FALSE(is(SLOTS_REFUSED));
}

// Somebody has written to the flash: what he wrote would run, its CRC is right.
TEST_F(FpgaStart, ABitstreamThatIsNotSignedNeverRuns) {
    receive(standInBitstream(2, frameWords));
    confirm();
    EXPECT_EQ(start(), 1u);
    const auto changed = standInBitstream(3, frameWords);
    std::copy(changed.begin(), changed.end(), at(multiBoot));
    EXPECT_EQ(start(), 0u);
    EXPECT_TRUE(is(SLOTS_REFUSED));
    std::copy(changed.begin(), changed.end(), at(golden));
    chip.powerOn();
    EXPECT_EQ(chip.run(), CortexM3::Stop::Breakpoint);
    EXPECT_FALSE(chip.fpga.isDone());
    EXPECT_FALSE(chip.fpga.boot().running.has_value());
}

TEST_F(FpgaStart, NoBitstreamIsTriedInFlightButOneThatIsRefusedGoes) {
    receive(standInBitstream(2, frameWords));
    chip.backup()[UAV_FLIGHT_WORD] = UAV_FLYING;
    *at(multiBoot + 1000) ^= 8;
    EXPECT_EQ(start(), 0u);
    EXPECT_TRUE(is(SLOTS_REFUSED));
    receive(standInBitstream(2, frameWords));
    std::fill(at(slot + SLOTS_READY), at(multiBoot), uint8_t{0xFF});
    (void)start();
    EXPECT_FALSE(is(SLOTS_TRIED));
    chip.backup()[UAV_FLIGHT_WORD] = 0;
    EXPECT_EQ(start(), 1u);
    EXPECT_TRUE(is(SLOTS_TRIED));
}

TEST_F(FpgaStart, ABitstreamForAnotherDeviceIsKnownNotToRun) {
    receive(standInBitstream(2, frameWords, 0x04001093)); // an XC6SLX9
    EXPECT_EQ(start(), 0u);
    EXPECT_TRUE(is(SLOTS_REFUSED));
    EXPECT_EQ(start(), 0u);
}

TEST_F(FpgaStart, AConfirmedBitstreamThatHasRottedIsKnownNotToRun) {
    receive(standInBitstream(2, frameWords));
    confirm();
    EXPECT_EQ(start(), 1u);
    *at(multiBoot + 1000) ^= 8;
    EXPECT_EQ(start(), 0u);
    EXPECT_TRUE(is(SLOTS_REFUSED));
}

TEST_F(FpgaStart, ABitstreamThatHangsTheFpgaGoesAtOnce) {
    auto bits = standInBitstream(2, frameWords);
    bits[SLOTS_SYNC_AT + 4] = 0; // no packet
    receive(bits);
    confirm();
    EXPECT_EQ(start(), 0u);
    EXPECT_TRUE(is(SLOTS_REFUSED));
}

// It would take four tries, 16 s, to know that the FPGA hangs; but this one reads no more.
TEST_F(FpgaStart, ABoardWithoutDoneStartsSoonAndItsFpgaRuns) {
    chip.fpga.isDoneWired = false;
    chip.powerOn();
    limit = chip.cpu().cycles() + 3'000'000'000;
    EXPECT_EQ(chip.run(), CortexM3::Stop::Breakpoint);
    EXPECT_EQ(chip.fpga.boot().running.value_or(0), golden);
    EXPECT_LT(now(), 1'500'000'000u);
}

} // namespace
