// SPDX-License-Identifier: MIT
//
// loader_test: the boot loader's ARM binary, which starts the firmware that it should, from flash
// as a programmer fills it.

#include "stm32f2.h"
#include "vehicle_folder.h"
#include <gtest/gtest.h>
#include <sys/stat.h>

extern "C" {
#include "loader.h"
#include "uav_keys.h"
}

namespace {

using Bytes = VehicleFolder::Bytes;
constexpr uint32_t flashBase = 0x08000000;

class Loader : public ::testing::Test {
protected:
    void fill(const std::string& more = "") {
        ASSERT_EQ(
            folder.pack("vehicle " FIRMWARE "loader.elf " FIRMWARE "uav.elf 7 key flash" + more), 0)
            << folder.said();
        chip.cpu().loadFlash(flashBase, folder.read("flash"));
    }
    // Leaves a complete update in the second slot.
    void receive(int version, const char* key = "key", const char* more = "") {
        ASSERT_EQ(folder.pack("image " FIRMWARE "uav.elf " + std::to_string(version) + " " + key +
                              " update" + more),
                  0)
            << folder.said();
        const Bytes package = folder.read("update");
        const auto half = package.begin() + static_cast<std::ptrdiff_t>(package.size() / 2);
        const auto image = half + sizeof(Slots_Header);
        const uint32_t at = flashBase + Slots_at(&slots_firmware, 1);
        chip.cpu().loadFlash(at, Bytes(SLOTS_IMAGE_AT, 0xFF));
        chip.cpu().loadFlash(at, {half, image});
        chip.cpu().loadFlash(at + SLOTS_IMAGE_AT, {image, package.end()});
        const uint32_t isTrue = SLOTS_TRUE;
        chip.cpu().writeMemory(at + SLOTS_READY, &isTrue, 4);
    }
    // Power comes; returns the slot whose firmware's first instruction is reached, -1: none is.
    int boot() {
        chip.powerOn();
        const uint64_t begun = chip.cpu().cycles();
        chip.cpu().breakpoints.clear();
        for (uint32_t slot = 0; slot < SLOTS_COUNT; ++slot)
            chip.cpu().breakpoints.insert(entry(slot));
        chip.onTime([&] {
            if (chip.cpu().cycles() - begun > 100'000'000)
                chip.cpu().stop();
            return uint64_t(0);
        });
        const auto why = chip.run();
        cycles = chip.cpu().cycles() - begun;
        if (why != CortexM3::Stop::Breakpoint)
            return -1;
        return chip.cpu().reg(CortexM3::Pc) == entry(0) ? 0 : 1;
    }
    uint32_t entry(uint32_t slot) {
        return chip.cpu().word(flashBase + Slots_at(&slots_firmware, slot) + SLOTS_IMAGE_AT + 4) &
               ~1u;
    }
    uint32_t vectorTable() {
        uint32_t vtor = 0;
        chip.cpu().debugRead(0xE000ED08, &vtor, 4);
        return vtor;
    }

    VehicleFolder folder;
    uint64_t cycles = 0;
    FsmcPins pins;
    FsmcMaster fsmc{pins, {[] {}, [] {}, [](uint64_t clocks, uint64_t) { return clocks; }}};
    Stm32F2 chip{fsmc, [this] { return fsmc.hclks() * 25 / 3; }, {}};
};

TEST_F(Loader, StartsTheFirmwareOfANewVehicle) {
    fill();
    EXPECT_EQ(boot(), 0);
    EXPECT_EQ(vectorTable(), flashBase + Slots_at(&slots_firmware, 0) + SLOTS_IMAGE_AT);
    EXPECT_EQ(chip.cpu().reg(CortexM3::Sp), chip.cpu().word(vectorTable()));
    EXPECT_LT(cycles, 60'000'000u); // half a second
    RecordProperty("cycles", static_cast<int>(cycles));
}

TEST_F(Loader, TriesANewOneOnceAndGoesBack) {
    fill();
    receive(8);
    EXPECT_EQ(boot(), 1);
    EXPECT_EQ(boot(), 0);
    EXPECT_EQ(boot(), 0);
}

// The time for one that the second key has signed is one more check of a signature.
TEST_F(Loader, StartsOneOfEitherKeyUntilItIsWithdrawn) {
    ASSERT_EQ(folder.pack("public spare spare.pub"), 0) << folder.said();
    fill(" --second spare.pub");
    EXPECT_EQ(boot(), 0);
    const uint64_t before = cycles;
    receive(8, "spare");
    EXPECT_EQ(boot(), 1);
    EXPECT_LT(cycles, before * 2);
    RecordProperty("cycles", static_cast<int>(cycles));
    const uint32_t isTrue = SLOTS_TRUE;
    chip.cpu().writeMemory(flashBase + Slots_at(&slots_firmware, 1) + SLOTS_CONFIRMED, &isTrue, 4);
    ASSERT_EQ(folder.pack("keys 2 spare spare.pub list"), 0) << folder.said();
    const uint32_t at = flashBase + SLOTS_KEYS_AT + sizeof(Slots_Keys);
    chip.cpu().loadFlash(at, folder.read("list"));
    receive(9, "key");    // over the one that is confirmed
    EXPECT_EQ(boot(), 1); // the list does not count yet
    receive(9, "key");
    chip.cpu().writeMemory(at + offsetof(Slots_Keys, isComplete), &isTrue, 4);
    EXPECT_EQ(boot(), -1);
    receive(9, "spare");
    EXPECT_EQ(boot(), 1);
}

TEST_F(Loader, TriesNothingInFlight) {
    fill();
    receive(8);
    chip.backup()[UAV_FLIGHT_WORD] = UAV_FLYING;
    EXPECT_EQ(boot(), 0);
    chip.backup()[UAV_FLIGHT_WORD] = 0;
    EXPECT_EQ(boot(), 1);
}

TEST_F(Loader, StartsNoneThatIsOlderOrOfAnotherKeyOrForAnotherBoard) {
    fill();
    receive(6);
    EXPECT_EQ(boot(), 0);
    receive(8, "foreignKey");
    EXPECT_EQ(boot(), 0);
    receive(8, "key", " --board 2");
    EXPECT_EQ(boot(), 0);
}

TEST_F(Loader, OfAnEmptyChipStartsNothing) {
    const ElfImage loader(FIRMWARE "loader.elf");
    chip.cpu().loadFlash(flashBase, Bytes(Stm32Flash::bytes, 0xFF));
    for (const ElfImage::Segment& s : loader.segments())
        chip.cpu().loadFlash(s.address, s.bytes);
    EXPECT_EQ(boot(), -1);
    EXPECT_GT(chip.cpu().sleepingCycles(), 1'000'000u);
}

TEST_F(Loader, OffersItsChecksToTheFirmware) {
    fill();
    const Loader_Services* services = LOADER_SERVICES;
    const auto at = static_cast<uint32_t>(reinterpret_cast<uintptr_t>(services));
    EXPECT_EQ(chip.cpu().word(at), LOADER_MAGIC);
    const ElfImage loader(FIRMWARE "loader.elf");
    EXPECT_EQ(chip.cpu().word(at + 4), loader.symbol("Signature_isGood") | 1);
    EXPECT_EQ(chip.cpu().word(at + 8), loader.symbol("Signature_digest") | 1);
}

TEST(PackUpdate, SaysWhatIsWrong) {
    VehicleFolder folder;
    auto refuses = [&](const std::string& words, const char* why) {
        EXPECT_NE(folder.pack(words), 0);
        EXPECT_NE(folder.said().find(why), std::string::npos) << folder.said();
    };
    refuses("image /dev/null 2 key update", "/dev/null");
    refuses("image " FIRMWARE "uav.elf 0 key update", "give 1 to 4294967294");
    refuses("image " FIRMWARE "loader.elf 2 key update", "--emit-relocs");
    EXPECT_EQ(folder.pack("image " FIRMWARE "uav.elf 2 key update"), 0);
    struct stat key{};
    EXPECT_EQ(stat((folder.path + "/key").c_str(), &key), 0);
    EXPECT_EQ(key.st_mode & 0777, 0600u);
    ::chmod((folder.path + "/key").c_str(), 0644);
    refuses("image " FIRMWARE "uav.elf 2 key update", "chmod 600");
    refuses("keys 2 other said list", "no public key");
}

} // namespace
