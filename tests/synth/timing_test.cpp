// SPDX-License-Identifier: MIT
//
// timing_test: the path estimate against paths that XST printed for Spartan-6, grade -3.

#include "timing.h"

#include <gtest/gtest.h>

namespace {

// A path of one-input LUTs between two flip-flops, each net with its fan-out.
Netlist chain(const std::vector<int>& fanouts, const char* endPin) {
    Netlist n;
    int bit = 10;
    const auto add = [&](Cell c) {
        const int index = static_cast<int>(n.cells.size());
        for (const Pin& p : c.pins)
            for (const int b : p.bits) {
                if (p.output)
                    n.driver[b] = index;
                else
                    n.readers[b].push_back(index);
            }
        n.cells.push_back(std::move(c));
    };
    add({"start", "FDRE", false, {}, {{"C", false, {2}}, {"Q", true, {bit}}}});
    for (size_t i = 0; i < fanouts.size(); i++) {
        for (int k = 1; k < fanouts[i]; k++)
            n.readers[bit].push_back(0); // others that read the net, of no interest
        if (i + 1 < fanouts.size())
            add({"lut", "LUT1", false, {}, {{"I0", false, {bit}}, {"O", true, {bit + 1}}}});
        bit++;
    }
    add({"end",
         "FDRE",
         false,
         {},
         {{"C", false, {2}}, {endPin, false, {bit - 1}}, {"Q", true, {100}}}});
    n.names[10] = {{"from", -1}};
    n.names[100] = {{"to", -1}};
    return n;
}

Path longest(const Netlist& n) {
    const Timing t = timingOf(n, std::vector<std::string>(n.cells.size()));
    return t.paths.empty() ? Path{} : t.paths.front();
}

TEST(Timing, APathOfSixLutsIsWithinATenthOfXst) {
    // A bus decoder's report: 9.068 ns, six levels, into an enable.
    const Path p = longest(chain({4, 1, 88, 26, 2, 5, 16}, "CE"));
    EXPECT_EQ(p.levels, 6);
    EXPECT_NEAR(p.ns, 9.068, 0.9);
    EXPECT_EQ(p.from, "from");
    EXPECT_EQ(p.to, "to");
    EXPECT_EQ(p.pin, "CE");
}

TEST(Timing, EachRegisterIsCountedOnceByItsLongestPath) {
    const Netlist n = chain({4, 1, 88, 26, 2, 5, 16}, "CE");
    const Timing t = timingOf(n, std::vector<std::string>(n.cells.size()));
    std::vector<int> ends(static_cast<size_t>(2 * slowGrade * t.paths.front().ns) + 1);
    ends.back() = 1; // nothing ends at the first register
    EXPECT_EQ(t.ends, ends);
}

TEST(Timing, AShortPathIntoTheFlipFlopBesideItIsWithinASeventhOfXst) {
    // A counter's report: 2.712 ns, two levels; the last net costs nothing.
    const Path p = longest(chain({7, 2, 1}, "D"));
    EXPECT_EQ(p.levels, 2);
    EXPECT_NEAR(p.ns, 2.712, 0.4);
    EXPECT_EQ(p.steps.back().net, 0);
}

TEST(Timing, MoreFanOutIsNeverFaster) {
    for (int fanout = 1; fanout < 150; fanout++)
        EXPECT_LE(netDelay(fanout), netDelay(fanout + 1)) << fanout;
}

TEST(Timing, ThroughAMemoryOnlyTheAddressOfThatOutputLeads) {
    const auto through = [](const char* address) {
        Netlist n = chain({1, 1}, "D");
        n.cells[1] = {"ram", "RAM32M", false, {}, {{address, false, {10}}, {"DOA", true, {11}}}};
        return longest(n);
    };
    EXPECT_EQ(through("ADDRA").levels, 1);
    EXPECT_EQ(through("ADDRA").from, "from");
    // The write port's address: the path from there ends, another begins at the memory.
    EXPECT_EQ(through("ADDRD").levels, 0);
    EXPECT_EQ(through("ADDRB").levels, 0) << "of DOB";
}

TEST(Timing, ALoopOfLogicEndsTheSearch) {
    Netlist n = chain({1, 1}, "D");
    n.cells[1].pins.push_back({"I1", false, {11}}); // the LUT reads itself
    n.readers[11].push_back(1);
    EXPECT_EQ(longest(n).levels, 1);
}

} // namespace
