// SPDX-License-Identifier: MIT
//
// ddr3_timing_test: the device's times against sums of data-sheet figures, worked out by hand.

#include "ddr3_timing.h"
#include <gtest/gtest.h>

namespace {

constexpr uint32_t bankStep = 2048, rowStep = 8 * 2048; // x16: a page is 2 KiB, eight banks

TEST(Ddr3Timing, TheFirstReadOpensItsRow) {
    Ddr3Timing device(mt41j64m16);
    EXPECT_EQ(device.access(100, true, 0), 100u + 6) << "tRCD";
    EXPECT_EQ(device.rowMisses, 1u);
}

TEST(Ddr3Timing, BurstsInAnOpenRowFollowEachOtherByTccd) {
    Ddr3Timing device(mt41j64m16);
    uint64_t first = device.access(100, true, 0);
    for (unsigned i = 1; i < 128; ++i)
        EXPECT_EQ(device.access(0, true, 16 * i), first + 4 * i);
    EXPECT_EQ(device.rowHits, 127u);
}

TEST(Ddr3Timing, AnotherRowOfTheBankWaitsForPrechargeAndActivate) {
    Ddr3Timing device(mt41j64m16);
    uint64_t first = device.access(100, true, 0); // activated at 100
    // tRAS is longer than tRCD + tRTP: 100 + 15, then tRP 6, tRCD 6
    EXPECT_EQ(device.access(first + 1, true, rowStep), 100u + 15 + 6 + 6);
}

TEST(Ddr3Timing, AWriteHoldsItsRowForWriteRecovery) {
    Ddr3Timing device(mt41j64m16);
    uint64_t cas = device.access(100, false, 0);
    // CWL 5, burst 4, tWR 6; tRP 6, tRCD 6
    EXPECT_EQ(device.access(cas + 1, false, rowStep), cas + 5 + 4 + 6 + 6 + 6);
}

TEST(Ddr3Timing, TurnaroundsKeepTheDataBusFree) {
    Ddr3Timing device(mt41j64m16);
    uint64_t read = device.access(100, true, 0);
    uint64_t write = device.access(0, false, 16);
    EXPECT_EQ(write, read + 6 + 4 + 2 - 5) << "CL + tCCD + 2 - CWL";
    EXPECT_EQ(device.access(0, true, 32), write + 5 + 4 + 4) << "CWL + burst + tWTR";
    EXPECT_EQ(device.turnarounds, 2u);
}

TEST(Ddr3Timing, ActivatesOfBanksAreSpacedByTrrdAndTfaw) {
    Ddr3Timing device(mt41j64m16);
    uint64_t act[6];
    for (unsigned bank = 0; bank < 6; ++bank)
        act[bank] = device.access(100, true, bank * bankStep) - 6;
    EXPECT_EQ(act[0], 100u);
    EXPECT_EQ(act[1], 104u) << "tRRD";
    EXPECT_EQ(act[3], 112u);
    EXPECT_EQ(act[4], 120u) << "tFAW: 50 ns after the first of the four before";
    EXPECT_EQ(act[5], 124u);
}

TEST(Ddr3Timing, RefreshComesEveryTrefiAndTakesTrfc) {
    Ddr3Timing device(mt41j64m16);
    device.access(100, true, 0);
    // due at 3120: precharge all (tRP 6), refresh (tRFC 44), activate, tRCD 6
    EXPECT_EQ(device.access(3120, true, 0), 3120u + 6 + 44 + 6);
    EXPECT_EQ(device.refreshes, 1u);
    device.access(4'000'000, true, 0); // 10 ms: 1282 intervals of 7.8 us
    EXPECT_EQ(device.refreshes, 1282u);
}

TEST(Ddr3Timing, AControllerMayRefreshLater) {
    Ddr3Timing device(mt41j64m16, 2);
    device.access(100, true, 0);
    EXPECT_EQ(device.access(3120, true, 0), 3120u + 6 + 2 + 44 + 6);
}

TEST(Ddr3Timing, AClosedBankNeedsNoPrecharge) {
    Ddr3Timing device(mt41j64m16);
    uint64_t cas = device.access(100, true, 0);
    device.autoPrecharge(0);
    EXPECT_EQ(device.access(cas + 100, true, rowStep), cas + 100 + 6);
}

} // namespace
