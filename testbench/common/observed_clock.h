// SPDX-License-Identifier: MIT
//
// observed_clock: the clock of the model that ran last, for failed assertions.

#ifndef OBSERVED_CLOCK_H
#define OBSERVED_CLOCK_H

#include <cstdint>

inline uint64_t observedClock = 0;

#endif
