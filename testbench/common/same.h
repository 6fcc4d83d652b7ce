// SPDX-License-Identifier: MIT
//
// same: compares two sequences in a test. If they differ, the message shows only the first
// different element, not the sequences: "filter(list) differs at [40]: expected -3, got 7".

#pragma once

#include <algorithm>
#include <gtest/gtest.h>

// Compares a sequence with its expected value.
#define EXPECT_SAME(got, expected) EXPECT_PRED_FORMAT2(compareSequences, got, expected)
#define ASSERT_SAME(got, expected) ASSERT_PRED_FORMAT2(compareSequences, got, expected)

template <class Got, class Expected>
::testing::AssertionResult compareSequences(const char* name, const char*, const Got& got,
                                            const Expected& expected) {
    const auto [a, b] = std::mismatch(got.begin(), got.end(), expected.begin(), expected.end());
    if (a == got.end() && b == expected.end())
        return ::testing::AssertionSuccess();
    const auto text = [](const auto& sequence, auto at) {
        return at == sequence.end() ? "its end" : ::testing::PrintToString(*at);
    };
    auto failure = ::testing::AssertionFailure();
    failure << name << " differs at [" << a - got.begin() << "]: expected " << text(expected, b)
            << ", got " << text(got, a);
    if (got.size() != expected.size())
        failure << " (expected " << expected.size() << " elements, got " << got.size() << ")";
    return failure;
}
