// SPDX-License-Identifier: MIT
//
// random_block: registers and the time of a number.

#include "random_block.h"

namespace {

constexpr uint32_t enable = 1u << 2, ready = 1, noClockNow = 1u << 1, noClock = 1u << 5,
                   badSeedNow = 1u << 2, badSeed = 1u << 6;
constexpr uint64_t numberNs = 40 * 1000 / 48;

} // namespace

uint32_t RandomBlock::read(uint32_t offset, uint64_t nowNs, bool hasClock) {
    if ((control_ & enable) && !hasClock)
        errors_ |= noClock;
    const bool isReady =
        (control_ & enable) && hasClock && !(errors_ & badSeedNow) && nowNs >= readyNs_;
    if (offset == 0)
        return control_;
    if (offset == 4)
        return errors_ | (isReady ? ready : 0) | (hasClock ? 0 : noClockNow);
    if (!isReady)
        return 0;
    readyNs_ = nowNs + numberNs;
    return next(state_);
}

void RandomBlock::write(uint32_t offset, uint32_t value, uint64_t nowNs) {
    if (offset == 4)
        errors_ &= value | badSeedNow;
    if (offset != 0)
        return;
    if (!(control_ & enable) && (value & enable)) {
        readyNs_ = nowNs + numberNs;
        errors_ &= ~badSeedNow;
    }
    control_ = value & (enable | 8);
}
