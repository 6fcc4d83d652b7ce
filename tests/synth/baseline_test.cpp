// SPDX-License-Identifier: MIT
//
// baseline_test: judgement of growth, the names that it gives, the content of the committed file.

#include "baseline.h"

#include <gmock/gmock.h>

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

namespace {

constexpr const char* yosys = "Yosys 0.23 (git sha1 7ce5011c24b)";

struct Fixture {
    Design design{"block", "block", "", "", {}, {}, false};
    ::Run run{&design, "xc6s", {}, {}, {}, false};
    Row row{&design, &run, {}};
    Baseline baseline{yosys, {}};

    Fixture() {
        run.figures.lut = 100;
        run.figures.ff = 50;
        run.figures.costs[{"u_part", "state"}] = {60, 0, 30, 0, 1.5, 2};
        run.figures.costs[{"", "count"}] = {40, 0, 20, 0};
        baseline.designs["block"] = acceptedFrom(run.figures);
    }
    void grow(int luts, int flipFlops) {
        run.figures.lut += luts;
        run.figures.ff += flipFlops;
        run.figures.costs[{"u_part", "state"}] += {luts, 0, flipFlops, 0};
    }
    void slow(double ns) { run.figures.timing.paths = {{"u_a.from", "u_b.to", "D", 7, ns, {}}}; }
    Verdict verdict() { return judge(row, baseline, yosys, 100); }
};

TEST(Baseline, GrowthWithinTheBudgetPasses) {
    Fixture f;
    f.grow(7, 2); // 3 % and 4; 1 % and 2
    EXPECT_THAT(f.verdict().failures, IsEmpty());
}

TEST(Baseline, GrowthBeyondTheBudgetNamesTheModuleAndTheSignal) {
    Fixture f;
    f.grow(8, 0);
    ASSERT_THAT(f.verdict().failures, SizeIs(1));
    EXPECT_THAT(f.verdict().failures[0], HasSubstr("108 LUT, 50 FF; accepted were 100 and 50"));
    EXPECT_THAT(f.verdict().failures[0], HasSubstr("modules that grew:\n      u_part +8 LUT"));
    EXPECT_THAT(f.verdict().failures[0],
                HasSubstr("signals that grew:\n      u_part.state +8 LUT"));
    EXPECT_THAT(f.verdict().failures[0], testing::Not(HasSubstr("count")));
}

TEST(Baseline, FlipFlopsAreJudgedToo) {
    Fixture f;
    f.grow(0, 3);
    EXPECT_THAT(f.verdict().failures, SizeIs(1));
}

TEST(Baseline, ShrinkingPasses) {
    Fixture f;
    f.grow(-50, -25);
    EXPECT_THAT(f.verdict().failures, IsEmpty());
}

TEST(Baseline, ALimitThatWasKeptMustBeKept) {
    Fixture f;
    f.design.limits = {{"lut", 102}};
    f.grow(3, 0); // within the budget of growth
    EXPECT_THAT(f.verdict().failures, ElementsAre(HasSubstr("103 lut, 1 above the limit of 102")));
}

TEST(Baseline, ALimitHoldsWhateverWasAccepted) {
    Fixture f;
    f.design.limits = {{"lut", 90}};
    EXPECT_THAT(f.verdict().failures, ElementsAre(HasSubstr("10 above the limit of 90")));
}

TEST(Baseline, FiguresOfAnotherYosysAreNotJudged) {
    Fixture f;
    f.grow(80, 30);
    EXPECT_THAT(judge(f.row, f.baseline, "Yosys 0.52", 100).failures, IsEmpty());
}

TEST(Baseline, ALimitThatAnotherYosysDoesNotKeepIsNoted) {
    Fixture f;
    f.design.limits = {{"lut", 102}};
    f.grow(3, 0);
    const Verdict v = judge(f.row, f.baseline, "Yosys 0.52", 100);
    EXPECT_THAT(v.failures, IsEmpty());
    EXPECT_THAT(v.notes, ElementsAre(HasSubstr("1 above the limit of 102 (by another Yosys")));
}

TEST(Baseline, AClockThatWasReachedMustBeReached) {
    Fixture f;
    f.slow(8.0); // 104 MHz at -2, 1.2 times as slow as -3
    f.baseline.designs["block"] = acceptedFrom(f.run.figures);
    EXPECT_THAT(f.verdict().failures, IsEmpty());
    f.slow(8.4);
    EXPECT_THAT(f.verdict().failures,
                ElementsAre(AllOf(HasSubstr("99 MHz; accepted were 104, the least is 100"),
                                  HasSubstr("u_a.from to u_b.to D, 7 levels"))));
}

TEST(Baseline, TheMedianOfAllOrdersIsJudged) {
    Fixture f;
    f.slow(8.0);
    f.baseline.designs["block"] = acceptedFrom(f.run.figures);
    f.slow(8.4); // 99 MHz
    f.run.figures.clocks = {103, 118, 96, 102};
    EXPECT_NEAR(f.run.figures.mhz(), 102, 0.01);
    EXPECT_EQ(f.run.figures.mhzRange(), std::pair(96.0, 118.0));
    EXPECT_THAT(f.verdict().failures, IsEmpty());
    f.run.figures.clocks = {98, 118, 96, 102};
    EXPECT_THAT(f.verdict().failures, SizeIs(1));
}

TEST(Baseline, AClockThatWasNotReachedMayLoseATenth) {
    Fixture f;
    f.slow(10.0);
    f.baseline.designs["block"] = acceptedFrom(f.run.figures);
    f.slow(10.9);
    EXPECT_THAT(f.verdict().failures, IsEmpty());
    f.slow(11.3);
    EXPECT_THAT(f.verdict().failures, SizeIs(1));
}

TEST(Baseline, AFailedSynthesisIsAFailure) {
    Fixture f;
    f.run.error = "syntax error";
    EXPECT_THAT(f.verdict().failures, SizeIs(1));
}

TEST(Baseline, AFailedSynthesisForAnotherChipIsAFailure) {
    Fixture f;
    ::Run other;
    other.family = "xc7";
    other.error = "no such thing";
    f.row.others.push_back(&other);
    EXPECT_THAT(f.verdict().failures, ElementsAre("block: synthesis for xc7 failed"));
}

TEST(Baseline, WhatIsWrittenIsReadAgain) {
    Fixture f;
    const Baseline again = readBaseline(written(f.baseline));
    EXPECT_EQ(again.yosys, f.baseline.yosys);
    const Accepted& a = again.designs.at("block");
    EXPECT_EQ(a.lut, 100);
    EXPECT_EQ(a.ff, 50);
    EXPECT_EQ(a.costs.at({"u_part", "state"}).ram, 1.5);
    EXPECT_EQ(a.costs.at({"u_part", "state"}).dsp, 2);
    EXPECT_THAT(changedSignals(a.costs, f.run.figures.costs), IsEmpty());
    EXPECT_EQ(written(again), written(f.baseline));
}

TEST(Baseline, AFileOfAnotherKindIsRefused) {
    EXPECT_ANY_THROW(readBaseline("{\"designs\": 3}"));
    EXPECT_ANY_THROW(readBaseline("not json"));
    EXPECT_TRUE(readBaseline("").designs.empty());
}

} // namespace
