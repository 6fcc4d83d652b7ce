// SPDX-License-Identifier: MIT
//
// biquad_model: the cascade's results on the host, bit by bit: the sum as the definition has it
// (ip/biquad/README.md).

#ifndef BIQUAD_MODEL_H
#define BIQUAD_MODEL_H

#include <array>
#include <cstddef>
#include <cstdint>

class BiquadModel {
public:
    static constexpr size_t sections = 4;
    struct Section {
        bool isUsed = false;                   // else it passes samples on
        std::array<int32_t, 5> coefficients{}; // b0 b1 b2 a1 a2 in 2^-16, 18 bits
        int64_t x1 = 0, x2 = 0, y1 = 0, y2 = 0;
    };

    std::array<Section, sections> cascade{};
    unsigned saturations = 0;

    void clear() {
        for (Section& s : cascade)
            s.x1 = s.x2 = s.y1 = s.y2 = 0;
    }
    int16_t step(int16_t sample) {
        int64_t value = int64_t(sample) * 64; // between sections: 16 bits and 6 behind the point
        for (Section& s : cascade) {
            if (!s.isUsed)
                continue;
            const auto& c = s.coefficients;
            int64_t sum = c[0] * value + c[1] * s.x1 + c[2] * s.x2 - c[3] * s.y1 - c[4] * s.y2;
            s.x2 = s.x1;
            s.x1 = value;
            s.y2 = s.y1;
            s.y1 = value = kept(nearest(sum, 65536), 23, saturations);
        }
        unsigned notCounted = 0;
        return static_cast<int16_t>(kept(nearest(value, 64), 15, notCounted));
    }

private:
    // Floor of (sum + half) / unit: to nearest, halves up.
    static int64_t nearest(int64_t sum, int64_t unit) {
        int64_t value = sum + unit / 2;
        return value >= 0 ? value / unit : -((-value + unit - 1) / unit);
    }
    static int64_t kept(int64_t value, unsigned bits, unsigned& count) {
        int64_t most = (int64_t(1) << bits) - 1, least = -most - 1;
        count += value > most || value < least;
        return value > most ? most : value < least ? least : value;
    }
};

#endif
