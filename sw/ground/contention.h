// SPDX-License-Identifier: MIT
//
// contention: chooses the modem's RN, the least exponent of its random wait before the first try.
// Who talks alone does not wait (next to nothing where the modem encrypts). Two that talk at once
// wait at random, or they would begin together. So does who sends little where packets are lost: an
// interferer of a fixed period would meet all that is sent at fixed times.

#ifndef GROUND_CONTENTION_H
#define GROUND_CONTENTION_H

#include <cstddef>
#include <cstdint>

namespace XBeeAT {

// Times in microseconds, 32 bits that may wrap.
class Contention {
public:
    static constexpr uint8_t shared = 2; // RN

    // `encrypts`: EE is 1. A packet takes 16 ms instead of 10: one that an interferer of a fixed
    // period has hit once would be hit again and again without any wait (`bench_air`).
    explicit Contention(bool encrypts = false) : alone(encrypts) {}
    void heard(size_t bytes, uint32_t now) {
        roll(now);
        heard_ += bytes;
        isShared_ = isShared_ || heard_ >= manyBytes;
    }
    void sent(size_t bytes, uint32_t now) {
        roll(now);
        sent_ += bytes;
        isStream_ = isStream_ || sent_ >= manyBytes;
    }
    void lost(uint32_t now) {
        hasLost_ = true;
        lostAt_ = now;
    }
    // Returns whether RN must be set anew, to `exponent()`.
    bool changes(uint32_t now) {
        roll(now);
        const uint8_t wanted = isShared_ || (hasLost_ && !isStream_) ? shared : alone;
        const bool does = wanted != exponent_;
        exponent_ = wanted;
        return does;
    }
    uint8_t exponent() const { return exponent_; }

private:
    static constexpr uint32_t lossUs = 10000000; // in which a loss counts
    // The air carries some 5,000 bytes in a span; these many or few of them tell a stream.
    static constexpr uint32_t spanUs = 500000;
    static constexpr size_t manyBytes = 1000, fewBytes = 500;

    void roll(uint32_t now) {
        hasLost_ = hasLost_ && now - lostAt_ < lossUs;
        if (now - since_ < spanUs)
            return;
        const bool isLate = now - since_ >= 2 * spanUs;
        isShared_ = isShared_ && heard_ >= fewBytes && !isLate;
        isStream_ = isStream_ && sent_ >= fewBytes && !isLate;
        since_ = now;
        heard_ = sent_ = 0;
    }

    const uint8_t alone;
    uint8_t exponent_ = shared; // as set-up leaves it
    bool isShared_ = false, isStream_ = false, hasLost_ = false;
    uint32_t since_ = 0, lostAt_ = 0;
    size_t heard_ = 0, sent_ = 0; // bytes in this span
};

} // namespace XBeeAT

#endif
