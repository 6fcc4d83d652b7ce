// SPDX-License-Identifier: MIT
//
// flash_test: checks that the model of the STM32F2's flash memory behaves as PM0059 describes.

#include "stm32_flash.h"
#include <algorithm>
#include <gtest/gtest.h>
#include <vector>

namespace {

class Flash : public ::testing::Test {
protected:
    static constexpr uint32_t X32 = 2 << 8; // PSIZE

    void unlock() {
        flash.write(Stm32Flash::Keyr, 0x45670123);
        flash.write(Stm32Flash::Keyr, 0xCDEF89AB);
    }
    void wait() { now += flash.busyNs(); }
    uint32_t status() { return flash.read(Stm32Flash::Sr); }
    void erase(unsigned sector) {
        flash.write(Stm32Flash::Cr, X32 | Stm32Flash::Ser | sector << 3 | Stm32Flash::Strt);
    }
    void program(uint32_t offset, uint32_t value) {
        flash.write(Stm32Flash::Cr, X32 | Stm32Flash::Pg);
        flash.store(offset, 4, value);
        wait();
        (void)status();
    }
    uint32_t word(uint32_t offset) const {
        uint32_t value = 0;
        for (unsigned i = 0; i < 4; ++i)
            value |= uint32_t(memory[offset + i]) << 8 * i;
        return value;
    }

    uint64_t now = 0;
    std::vector<uint8_t> memory = std::vector<uint8_t>(Stm32Flash::bytes, 0xFF);
    Stm32Flash flash{memory.data(), [this] { return now; }};
};

TEST_F(Flash, HasSectorsOf16And64And128KiB) {
    uint32_t at = 0;
    for (unsigned n = 0; n < Stm32Flash::sectors; ++n) {
        EXPECT_EQ(Stm32Flash::sectorAt(n), at);
        at += Stm32Flash::sectorBytes(n);
        EXPECT_EQ(Stm32Flash::sectorOf(at - 1), n);
        EXPECT_EQ(Stm32Flash::sectorOf(Stm32Flash::sectorAt(n)), n);
    }
    EXPECT_EQ(at, Stm32Flash::bytes);
}

TEST_F(Flash, IsLockedUntilBothKeysAreWrittenInOrder) {
    program(0, 0);
    EXPECT_EQ(word(0), 0xFFFFFFFFu);
    EXPECT_EQ(status(), uint32_t(Stm32Flash::Pgserr));
    unlock();
    program(0, 0x12345678);
    EXPECT_EQ(word(0), 0x12345678u);
    flash.write(Stm32Flash::Cr, Stm32Flash::Lock);
    flash.write(Stm32Flash::Cr, Stm32Flash::Pg);
    EXPECT_EQ(flash.read(Stm32Flash::Cr), uint32_t(Stm32Flash::Lock));
}

TEST_F(Flash, AWrongKeyLocksItUntilAReset) {
    EXPECT_THROW(flash.write(Stm32Flash::Keyr, 1), Stm32Flash::WrongKey);
    EXPECT_THROW(unlock(), Stm32Flash::WrongKey);
    flash.reset();
    unlock();
    EXPECT_EQ(flash.read(Stm32Flash::Cr), 0u);
}

TEST_F(Flash, ProgrammingOnlyClearsBits) {
    unlock();
    program(8, 0xFFFF0000);
    program(8, 0x00FFFF00);
    EXPECT_EQ(word(8), 0x00FF0000u);
}

TEST_F(Flash, TheTimeOfAnEraseDependsOnTheSectorSize) {
    unlock();
    const std::pair<unsigned, uint64_t> times[] = {{0, 250}, {4, 550}, {5, 1000}, {11, 1000}};
    for (auto [sector, ms] : times) {
        const uint32_t at = Stm32Flash::sectorAt(sector), size = Stm32Flash::sectorBytes(sector);
        program(at, 0), program(at + size - 4, 0);
        const uint64_t begun = now;
        erase(sector);
        EXPECT_EQ(status() & Stm32Flash::Bsy, uint32_t(Stm32Flash::Bsy));
        wait();
        EXPECT_EQ(now - begun, ms * 1'000'000);
        EXPECT_EQ(status(), 0u);
        EXPECT_EQ(word(at), 0xFFFFFFFFu);
        EXPECT_EQ(word(at + size - 4), 0xFFFFFFFFu);
    }
}

TEST_F(Flash, AnEraseDoesNotChangeOtherSectors) {
    unlock();
    program(0x1FFFC, 1), program(0x40000, 2);
    erase(5);
    wait();
    (void)status();
    EXPECT_EQ(word(0x1FFFC), 1u);
    EXPECT_EQ(word(0x40000), 2u);
}

TEST_F(Flash, AStoreOfAnotherWidthThanPsizeIsRefused) {
    unlock();
    flash.write(Stm32Flash::Cr, X32 | Stm32Flash::Pg);
    flash.store(0, 2, 0);
    EXPECT_EQ(status(), uint32_t(Stm32Flash::Pgperr));
    flash.write(Stm32Flash::Sr, Stm32Flash::Pgperr);
    flash.store(14, 4, 0); // this store goes beyond the end of a row of 128 bits
    EXPECT_EQ(status(), uint32_t(Stm32Flash::Pgaerr));
    EXPECT_EQ(word(12), 0xFFFFFFFFu);
}

TEST_F(Flash, AResetDuringAWriteLeavesSomeBitsUnwritten) {
    unsigned partial = 0;
    for (int i = 0; i < 32; ++i) {
        flash.reset();
        unlock();
        flash.write(Stm32Flash::Cr, X32 | Stm32Flash::Pg);
        flash.store(4u * i, 4, 0x0000FFFF);
        flash.reset();
        EXPECT_EQ(word(4u * i) & 0xFFFF, 0xFFFFu); // bits that need not become 0 stay 1
        partial += word(4u * i) != 0x0000FFFF && word(4u * i) != 0xFFFFFFFF;
    }
    EXPECT_GT(partial, 16u);
}

TEST_F(Flash, AResetDuringAnEraseLeavesRandomBits) {
    auto left = [](uint64_t seed) {
        std::vector<uint8_t> bytes(Stm32Flash::bytes, 0x5A);
        uint64_t time = 0;
        Stm32Flash chip(bytes.data(), [&] { return time; }, seed);
        chip.write(Stm32Flash::Keyr, 0x45670123);
        chip.write(Stm32Flash::Keyr, 0xCDEF89AB);
        chip.write(Stm32Flash::Cr, X32 | Stm32Flash::Ser | Stm32Flash::Strt);
        time += chip.busyNs() / 2;
        chip.reset();
        EXPECT_EQ(bytes[0x4000], 0x5A);
        bytes.resize(0x4000);
        return bytes;
    };
    const std::vector<uint8_t> one = left(1);
    for (int kind : {0x00, 0x5A, 0xFF})
        EXPECT_GT(std::count(one.begin(), one.end(), kind), 1000);
    EXPECT_EQ(left(1), one);
    EXPECT_NE(left(2), one);
}

} // namespace
