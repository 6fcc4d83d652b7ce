// SPDX-License-Identifier: MIT
//
// never_quiet: a QuietSpan that never skips a clock, for simulations of a netlist. In a netlist,
// the counters that quiet_span.cpp reads have other names.

#include "quiet_span.h"

QuietSpan::QuietSpan(VSoc& top) : top_(top) {}

void QuietSpan::sample() {}

QuietSpan::Clocks QuietSpan::look(Clocks) {
    return {};
}

bool QuietSpan::stirs() const {
    return true;
}

void QuietSpan::rest(bool) {}

void QuietSpan::refuseCamera() {}

void QuietSpan::replaced() {}

uint64_t QuietSpan::untilCarry(uint64_t) const {
    return 0;
}

uint64_t QuietSpan::pass(uint64_t clocks) {
    return clocks;
}

std::string QuietSpan::mover() const {
    return {};
}
