// SPDX-License-Identifier: MIT
//
// fir_model: computes the results of the FIR filter on the host, exact to the bit, directly from
// the filter's definition (ip/fir/README.md).

#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <deque>

class FirModel {
public:
    static constexpr size_t taps = 16;

    // coefficients of 18 bits; index 0 belongs to the newest sample
    std::array<int32_t, taps> coefficients{};
    unsigned shift = 0; // 0..31
    unsigned saturations = 0;

    void clear() { history_.clear(); }
    int16_t step(int16_t sample) {
        history_.push_front({sample, coefficients});
        if (history_.size() > taps)
            history_.pop_back();
        int64_t sum = 0;
        for (size_t k = 0; k < history_.size(); ++k)
            sum += int64_t(history_[k].coefficients[k]) * history_[k].sample;
        // floor((sum + half) / 2^shift): rounds to nearest, halves up.
        int64_t unit = int64_t(1) << shift, value = sum + unit / 2;
        value = value >= 0 ? value / unit : -((-value + unit - 1) / unit);
        if (value > INT16_MAX || value < INT16_MIN) {
            ++saturations;
            value = value > 0 ? INT16_MAX : INT16_MIN;
        }
        return static_cast<int16_t>(value);
    }

private:
    struct Past {
        int16_t sample;
        // the coefficients that were set when the sample arrived
        std::array<int32_t, taps> coefficients;
    };
    std::deque<Past> history_; // newest first
};
