// SPDX-License-Identifier: MIT
//
// slices_test: the slice estimate against published reports of ISE's map, and against its own
// rules.

#include "slices.h"

#include <cmath>
#include <gtest/gtest.h>

namespace {

// "Number of Slice LUTs", "Number of Slice Registers", "Number of occupied Slices" of Spartan-6
// designs whose map report is published, in chips with room.
struct Reported {
    const char* design;
    double luts, flipFlops, occupied;
};
const Reported reports[] = {
    {"J1 processor, registers in the fabric (LX16)", 341, 259, 94},
    {"MiniCPU of the anycpu challenge (LX4)", 276, 164, 75},
    {"Mojo tutorial: serial port and greeter (LX9)", 144, 90, 48},
    {"one channel of a motion controller (LX9)", 2315, 1395, 712},
    {"Next186 personal computer (LX25)", 8127, 3361, 2666},
    {"Table I of the paper (LX16)", 1728, 1537, 772},
};

TEST(Slices, EstimateIsWithinAThirdOfEveryReportOfMap) {
    double sum = 0;
    for (const Reported& r : reports) {
        const double error = occupiedSlices(r.luts, r.flipFlops, usualShare) / r.occupied - 1;
        EXPECT_LT(std::abs(error), 0.33) << r.design << ": " << error;
        sum += std::abs(error);
    }
    EXPECT_LT(sum / std::size(reports), 0.18) << "mean error";
}

// "Number used as logic": sites of one function, of two.
TEST(Slices, FunctionsShareSitesAsInTheReportsOfMap) {
    const struct {
        const char* design;
        double one, two;
    } told[] = {
        {"A stack for the J1 processor (LX16)", 93 + 11, 5},
        {"The same in flip-flops (LX16)", 325 + 11, 4},
        {"MiniCPU of the anycpu challenge (LX4)", 184 + 19, 29},
        {"Mojo tutorial: hello, YOUR_NAME (LX9)", 123 + 12, 22},
        {"The same with a block RAM (LX9)", 107 + 12, 21},
        {"one channel of a motion controller (LX9)", 1690 + 122, 491},
        {"minispartan6-audio, a RISC-V that plays MP3 (LX9)", 3958 + 261, 923},
    };
    double sum = 0;
    for (const auto& d : told) {
        const double saved = d.two / (d.one + 2 * d.two);
        EXPECT_GE(saved, 0.01) << d.design;
        EXPECT_LE(saved, 0.18) << d.design;
        sum += saved;
    }
    EXPECT_NEAR(sum / std::size(told), usualPairing, 0.005);
}

TEST(Slices, TheErrorThatIsStatedIsThatOfAReportLeftOutOfTheCalibration) {
    double sum = 0;
    for (const Reported& left : reports) {
        double best = 1e9, share = 0;
        for (int s = 0; s <= 1000; ++s) {
            double error = 0;
            for (const Reported& r : reports)
                if (&r != &left)
                    error +=
                        std::abs(occupiedSlices(r.luts, r.flipFlops, s / 1000.0) / r.occupied - 1);
            if (error < best)
                best = error, share = s / 1000.0;
        }
        sum += std::abs(occupiedSlices(left.luts, left.flipFlops, share) / left.occupied - 1);
    }
    EXPECT_NEAR(sum / std::size(reports), slicesError, 0.005);
}

TEST(Slices, BoundsHoldEveryReportOfMap) {
    for (const Reported& r : reports) {
        EXPECT_LE(occupiedSlices(r.luts, r.flipFlops, leastShare), r.occupied + 1) << r.design;
        EXPECT_GE(occupiedSlices(r.luts, r.flipFlops, mostShare), r.occupied - 1) << r.design;
    }
}

Cell flipFlop(int clock, int enable, int reset, int d, int q) {
    return {"ff",
            "FDRE",
            false,
            {},
            {{"C", false, {clock}},
             {"CE", false, {enable}},
             {"R", false, {reset}},
             {"D", false, {d}},
             {"Q", true, {q}}}};
}
Cell lut(const std::vector<int>& inputs, int output) {
    Cell c{"lut", "LUT" + std::to_string(inputs.size()), false, {}, {{"O", true, {output}}}};
    for (size_t i = 0; i < inputs.size(); i++)
        c.pins.push_back({"I" + std::to_string(i), false, {inputs[i]}});
    return c;
}

TEST(Slices, EightFlipFlopsOfOneControlSetAreOneSliceAndOfTwoAreTwo) {
    Netlist n;
    for (int i = 0; i < 8; i++)
        n.cells.push_back(flipFlop(2, 3, bitZero, 10 + i, 30 + i));
    EXPECT_EQ(slicesOf(n).low, 1);
    n.cells[7] = flipFlop(2, 4, bitZero, 17, 37);
    EXPECT_EQ(slicesOf(n).low, 2);
    EXPECT_EQ(slicesOf(n).controlSets, 2);
}

TEST(Slices, LutsOfFiveCommonInputsShareASiteAndThoseOfSixDoNot) {
    Netlist n;
    n.cells = {lut({2, 3, 4, 5, 6}, 20), lut({2, 3, 4, 5}, 21)};
    EXPECT_EQ(slicesOf(n).sites, 1);
    n.cells[1] = lut({2, 3, 4, 5, 6, 7}, 21);
    EXPECT_EQ(slicesOf(n).sites, 2);
    n.cells = {lut({2, 3, 4, 5, 6}, 20), lut({2, 3, 4, 7}, 21)}; // six inputs together
    EXPECT_EQ(slicesOf(n).sites, 2);
}

TEST(Slices, ALutRamTakesASliceOfItsOwnKind) {
    Netlist n;
    for (int i = 0; i < 3; i++)
        n.cells.push_back({"ram", "RAM32M", false, {}, {}});
    EXPECT_EQ(slicesOf(n).slicem, 3);
    EXPECT_EQ(slicesOf(n).low, 3);
}

} // namespace
