// SPDX-License-Identifier: MIT
//
// observed_clock: the clock of the model that ran last, for failed assertions.

#pragma once

#include <cstdint>

inline uint64_t observedClock = 0;
