// SPDX-License-Identifier: MIT
//
// start_test: runs the ARM binaries on the model of the STM32, from a flash as a programmer writes
// it. The boot loader starts the firmware, and the firmware makes the FPGA load a bitstream. The
// test sees which addresses the FPGA reads from its SPI flash.

#include "stm32f2.h"
#include <algorithm>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <sys/stat.h>
#include <unistd.h>

extern "C" {
#include "backup.h"
#include "loader.h"
#include "slots.h"
}

namespace {

using Bytes = std::vector<uint8_t>;
constexpr uint32_t flashBase = 0x08000000;

// A folder for pack_update that belongs to one test, because tests run in parallel.
struct VehicleFolder {
    VehicleFolder() { std::filesystem::create_directories(path); }
    ~VehicleFolder() { std::filesystem::remove_all(path); }
    int pack(const std::string& words) const {
        return std::system(("cd " + path + " && " PACK_UPDATE " " + words + " >said 2>&1").c_str());
    }
    Bytes read(const std::string& name) const {
        std::ifstream in(path + "/" + name, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }
    void save(const std::string& name, const Bytes& bytes) const {
        std::ofstream(path + "/" + name, std::ios::binary)
            .write(reinterpret_cast<const char*>(bytes.data()),
                   static_cast<std::streamsize>(bytes.size()));
    }
    std::string said() const {
        const Bytes text = read("said");
        return {text.begin(), text.end()};
    }
    std::string path = FOLDER + std::to_string(getpid());
};

class StartingVehicle : public ::testing::Test {
protected:
    void fill(const std::string& more = "") {
        ASSERT_EQ(
            folder.pack("vehicle " FIRMWARE "loader.elf " FIRMWARE "uav.elf 7 key flash" + more), 0)
            << folder.said();
        chip.cpu().loadFlash(flashBase, folder.read("flash"));
    }
    uint64_t now() const { return fsmc.hclks() * 25 / 3; } // ns

    VehicleFolder folder;
    FsmcPins pins;
    FsmcMaster fsmc{
        pins,
        {[] {}, [] {}, [](uint64_t clocks, uint64_t ns) { return std::min(clocks, ns / 10); }}};
    Stm32F2 chip{fsmc, [this] { return now(); }, {}};
};

class Loader : public StartingVehicle {
protected:
    // Writes a complete update to the second slot.
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
    // Switches the power on. Returns the slot of the firmware that starts, or -1 if none starts.
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

    uint64_t cycles = 0;
};

TEST_F(Loader, StartsTheFirmwareOfANewVehicle) {
    fill();
    EXPECT_EQ(boot(), 0);
    EXPECT_EQ(vectorTable(), flashBase + Slots_at(&slots_firmware, 0) + SLOTS_IMAGE_AT);
    EXPECT_EQ(chip.cpu().reg(CortexM3::Sp), chip.cpu().word(vectorTable()));
    EXPECT_LT(cycles, 60'000'000u); // number of cycles in half a second
    RecordProperty("cycles", static_cast<int>(cycles));
}

TEST_F(Loader, TriesANewImageOnceAndReturnsToThePrevious) {
    fill();
    receive(8);
    EXPECT_EQ(boot(), 1);
    EXPECT_EQ(boot(), 0);
    EXPECT_EQ(boot(), 0);
}

// If the second key has signed the firmware, one signature more must be checked.
TEST_F(Loader, StartsImagesOfBothKeysUntilAKeyIsRevoked) {
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
    receive(9, "key");    // overwrites the confirmed firmware
    EXPECT_EQ(boot(), 1); // the list of keys is not valid yet, because it is not complete
    receive(9, "key");
    chip.cpu().writeMemory(at + offsetof(Slots_Keys, isComplete), &isTrue, 4);
    EXPECT_EQ(boot(), -1);
    receive(9, "spare");
    EXPECT_EQ(boot(), 1);
}

TEST_F(Loader, TriesNoImageInFlight) {
    fill();
    receive(8);
    chip.backup()[BACKUP_AT(vehicle.flight)] = BACKUP_FLYING;
    EXPECT_EQ(boot(), 0);
    chip.backup()[BACKUP_AT(vehicle.flight)] = 0;
    EXPECT_EQ(boot(), 1);
}

TEST_F(Loader, RefusesOlderAndForeignImages) {
    fill();
    receive(6);
    EXPECT_EQ(boot(), 0);
    receive(8, "foreignKey");
    EXPECT_EQ(boot(), 0);
    receive(8, "key", " --board 2");
    EXPECT_EQ(boot(), 0);
}

TEST_F(Loader, AnEmptyChipStartsNoImage) {
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

TEST(PackUpdate, ReportsInvalidArguments) {
    VehicleFolder folder;
    auto refuses = [&](const std::string& words, const char* why) {
        EXPECT_NE(folder.pack(words), 0);
        EXPECT_NE(folder.said().find(why), std::string::npos) << folder.said();
    };
    refuses("image /dev/null 2 key update", "/dev/null");
    refuses("image " FIRMWARE "uav.elf 0 key update", "expected 1 to 4294967294");
    refuses("image " FIRMWARE "loader.elf 2 key update", "--emit-relocs");
    EXPECT_EQ(folder.pack("image " FIRMWARE "uav.elf 2 key update"), 0);
    struct stat key{};
    EXPECT_EQ(stat((folder.path + "/key").c_str(), &key), 0);
    EXPECT_EQ(key.st_mode & 0777, 0600u);
    ::chmod((folder.path + "/key").c_str(), 0644);
    refuses("image " FIRMWARE "uav.elf 2 key update", "chmod 600");
    refuses("keys 2 other said list", "expected a public key");
}

constexpr uint32_t frameWords = 2000;
const uint32_t slot = Slots_at(&slots_fpga, 1), multiBoot = slot + SLOTS_IMAGE_AT,
               golden = Slots_at(&slots_fpga, 0) + SLOTS_IMAGE_AT;

class FpgaStart : public StartingVehicle {
protected:
    FpgaStart() {
        folder.save("golden.bin", standInBitstream(1, frameWords));
        fill();
        EXPECT_EQ(folder.pack("fpga golden.bin 1 key fpga"), 0) << folder.said();
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
    // Writes to the FPGA's flash all data that a complete update would write.
    void receive(const Bytes& bits, const std::string& more = "") {
        folder.save("new.bin", bits);
        ASSERT_EQ(folder.pack("bitstream new.bin 2 key update" + more), 0) << folder.said();
        const auto package = folder.read("update");
        const auto image = package.begin() + sizeof(Slots_Header);
        std::copy(package.begin(), image, at(slot));
        std::copy(image, package.end(), at(multiBoot));
        const uint8_t sync[] = {0xAA, 0x99, 0x55, 0x66};
        std::copy(std::begin(sync), std::end(sync), at(multiBoot + SLOTS_SYNC_AT));
    }
    Bytes::iterator at(uint32_t offset) { return flash.memory.begin() + offset; }
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
    // Switches the power on. Returns the slot of the bitstream that runs, which must be the same
    // for the firmware and for the FPGA.
    uint32_t start() {
        chip.powerOn();
        limit = chip.cpu().cycles() + 3'000'000'000;
        EXPECT_EQ(chip.run(), CortexM3::Stop::Breakpoint);
        EXPECT_EQ(chip.fpga.boot().running.value_or(0),
                  chip.cpu().word(running) ? multiBoot : golden);
        EXPECT_TRUE(chip.fpga.isDone());
        return chip.cpu().word(running);
    }

    SpiFlash flash{[this] { return now(); }};
    uint32_t running = 0;
    uint64_t limit = 0;
};

TEST_F(FpgaStart, ANewBitstreamIsTriedAndDroppedUnlessConfirmed) {
    EXPECT_EQ(start(), 0u);
    receive(standInBitstream(2, frameWords));
    EXPECT_EQ(start(), 1u);
    EXPECT_TRUE(is(SLOTS_TRIED));
    EXPECT_EQ(start(), 0u);
    EXPECT_FALSE(is(SLOTS_REFUSED));
}

// An attacker has written to the flash. The FPGA would accept the data, because the CRC is valid.
TEST_F(FpgaStart, AnUnsignedBitstreamNeverRuns) {
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

TEST_F(FpgaStart, InFlightNoBitstreamIsTriedButARefusedOneIsDropped) {
    receive(standInBitstream(2, frameWords));
    chip.backup()[BACKUP_AT(vehicle.flight)] = BACKUP_FLYING;
    *at(multiBoot + 1000) ^= 8;
    EXPECT_EQ(start(), 0u);
    EXPECT_TRUE(is(SLOTS_REFUSED));
    receive(standInBitstream(2, frameWords));
    std::fill(at(slot + SLOTS_READY), at(multiBoot), uint8_t{0xFF});
    (void)start();
    EXPECT_FALSE(is(SLOTS_TRIED));
    chip.backup()[BACKUP_AT(vehicle.flight)] = 0;
    EXPECT_EQ(start(), 1u);
    EXPECT_TRUE(is(SLOTS_TRIED));
}

TEST_F(FpgaStart, ABitstreamForAnotherDeviceIsReportedAsNotRunning) {
    receive(standInBitstream(2, frameWords, 0x04001093)); // an XC6SLX9
    EXPECT_EQ(start(), 0u);
    EXPECT_TRUE(is(SLOTS_REFUSED));
    EXPECT_EQ(start(), 0u);
}

TEST_F(FpgaStart, ACorruptedConfirmedBitstreamIsReportedAsNotRunning) {
    receive(standInBitstream(2, frameWords));
    confirm();
    EXPECT_EQ(start(), 1u);
    *at(multiBoot + 1000) ^= 8;
    EXPECT_EQ(start(), 0u);
    EXPECT_TRUE(is(SLOTS_REFUSED));
}

TEST_F(FpgaStart, ABitstreamThatHangsTheFpgaIsDroppedAtOnce) {
    auto bits = standInBitstream(2, frameWords);
    bits[SLOTS_SYNC_AT + 4] = 0; // no packet
    receive(bits, " --unchecked");
    confirm();
    EXPECT_EQ(start(), 0u);
    EXPECT_TRUE(is(SLOTS_REFUSED));
}

// Without DONE, the firmware would need four tries (16 s) to find out whether the FPGA hangs. Here
// the firmware knows the result earlier, because it sees that the FPGA no longer reads its flash.
TEST_F(FpgaStart, ABoardWithoutTheDonePinStarts) {
    chip.fpga.isDoneWired = false;
    chip.powerOn();
    limit = chip.cpu().cycles() + 3'000'000'000;
    EXPECT_EQ(chip.run(), CortexM3::Stop::Breakpoint);
    EXPECT_EQ(chip.fpga.boot().running.value_or(0), golden);
    EXPECT_LT(now(), 1'500'000'000u);
}

// ---- pack_update rejects invalid input before it signs anything ----

class Packing : public ::testing::Test {
protected:
    // Checks that pack_update rejects these arguments with this reason and writes nothing.
    void refuses(const std::string& words, const std::string& why) {
        EXPECT_NE(folder.pack(words + " out"), 0) << words;
        EXPECT_NE(folder.said().find(why), std::string::npos) << words << ": " << folder.said();
        EXPECT_TRUE(folder.read("out").empty()) << words;
    }
    // Returns a bitstream in the format of BitGen's .bit files: a header with the length, then the
    // bitstream.
    static Bytes bitFile(const Bytes& bits) {
        Bytes file = {0, 9, 0x0F, 0xF0, 0x0F, 0xF0, 0x0F, 0xF0, 0x0F, 0xF0, 0, 0, 1};
        for (const char field : {'a', 'b', 'c', 'd'})
            file.insert(file.end(), {uint8_t(field), 0, 2, 'x', 0});
        file.push_back('e');
        for (int shift = 24; shift >= 0; shift -= 8)
            file.push_back(static_cast<uint8_t>(bits.size() >> shift));
        file.insert(file.end(), bits.begin(), bits.end());
        return file;
    }
    VehicleFolder folder;
    const Bytes whole = standInBitstream(2, 2000);
};

TEST_F(Packing, ATruncatedOrExtendedBitstreamIsNotSigned) {
    for (const bool isBit : {false, true}) {
        const auto file = [&](const Bytes& bits) { return isBit ? bitFile(bits) : bits; };
        folder.save("whole", file(whole));
        EXPECT_EQ(folder.pack("bitstream whole 5 key good"), 0) << folder.said();
        for (const size_t size : {size_t{30}, size_t{1000}, whole.size() / 2, whole.size() - 40}) {
            folder.save("cut", file({whole.begin(), whole.begin() + std::ptrdiff_t(size)}));
            refuses("bitstream cut 5 key", "DESYNC");
            refuses("fpga cut 5 key", "DESYNC");
        }
        Bytes more = whole;
        more.resize(more.size() + 1001, 0x5A);
        folder.save("more", file(more));
        refuses("bitstream more 5 key", "1001 bytes after the end of the bitstream");
    }
    Bytes cut = bitFile(whole); // the header still contains the length of the whole bitstream
    cut.resize(cut.size() - 4);
    folder.save("short", cut);
    refuses("bitstream short 5 key", "as its header states");
}

TEST_F(Packing, AnUnreadableFileIsReportedWithTheReason) {
    std::filesystem::create_directory(folder.path + "/other");
    refuses("image other 5 key", "cannot read firmware 'other': it is a folder");
    refuses("bitstream other 5 key", "cannot read bitstream 'other': it is a folder");
    refuses("bitstream missing 5 key", "cannot read bitstream 'missing': No such file");
}

TEST_F(Packing, AVersionConsistsOfDigits) {
    folder.save("whole", whole);
    for (const char* version : {"-1", "+1", "-18446744073709551615", "0", "4294967295", "1x",
                                "' 1'", "0x10", "99999999999999999999", "''"})
        refuses("bitstream whole " + std::string(version) + " key",
                std::string(version)[0] == '-' ? "" : "version");
    EXPECT_EQ(folder.pack("bitstream whole 4294967294 key good"), 0) << folder.said();
}

TEST_F(Packing, APrivateKeyIsReadableOnlyByItsOwner) {
    folder.save("whole", whole);
    ASSERT_EQ(std::system(("cd " + folder.path +
                           " && mkfifo pipe && mkdir folder && touch empty && head -c 32 "
                           "/dev/zero >open && head -c 33 /dev/zero >long && chmod 600 empty long "
                           "pipe && chmod 644 open && ln -s nowhere/key dangling")
                              .c_str()),
              0);
    refuses("bitstream whole 5 pipe", "expected a regular file");
    refuses("bitstream whole 5 folder", "expected a regular file");
    refuses("bitstream whole 5 /dev/zero", "expected a regular file");
    refuses("bitstream whole 5 empty", "expected 32 bytes, got 0");
    refuses("bitstream whole 5 long", "expected 32 bytes, got 33");
    refuses("bitstream whole 5 open", "chmod 600");
    refuses("bitstream whole 5 dangling", "cannot write the private key");
}

TEST_F(Packing, AnOutputMustDifferFromTheInputs) {
    folder.save("whole", whole);
    ASSERT_EQ(folder.pack("public key open.pub"), 0) << folder.said();
    const Bytes key = folder.read("key");
    ASSERT_EQ(std::system(("cd " + folder.path + " && ln key other && mkfifo pipe").c_str()), 0);
    for (const char* words : {"public key key", "public key ./key", "public key other",
                              "bitstream whole 5 key key", "bitstream whole 5 key whole",
                              "keys 2 key open.pub open.pub", "public new.key new.key"}) {
        EXPECT_NE(folder.pack(words), 0) << words;
        EXPECT_NE(folder.said().find("not also an input"), std::string::npos) << folder.said();
    }
    EXPECT_EQ(folder.read("key"), key);
    EXPECT_EQ(folder.read("whole"), whole);
    refuses("keys 2 key pipe", "not a regular file");
}

TEST_F(Packing, SimultaneousCommandsCreateOneKey) {
    ASSERT_EQ(std::system(("cd " + folder.path +
                           " && for i in 1 2 3 4 5 6 7 8; do " PACK_UPDATE
                           " public new.key $i.pub & done; wait")
                              .c_str()),
              0);
    for (int i = 1; i <= 8; ++i)
        EXPECT_EQ(folder.read(std::to_string(i) + ".pub"), folder.read("1.pub")) << i;
    EXPECT_EQ(folder.read("1.pub").size(), 65u);
}

} // namespace
