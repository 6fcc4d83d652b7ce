// SPDX-License-Identifier: MIT
//
// picture: generates grey-scale frames with corners, for tests.

#pragma once

#include "random.h"
#include <algorithm>
#include <vector>

// Returns a frame with noise, flat areas, and bright and dark squares; the squares have corners of
// every kind.
inline std::vector<uint8_t> picture(int width, int height, Random& random) {
    std::vector<uint8_t> pixels(static_cast<size_t>(width * height));
    for (auto& p : pixels)
        p = static_cast<uint8_t>(100 + random.below(20));
    for (int n = 0; n < width * height / 150 + 2; ++n) {
        int x0 = static_cast<int>(random.below(static_cast<uint32_t>(width)));
        int y0 = static_cast<int>(random.below(static_cast<uint32_t>(height)));
        int size = static_cast<int>(1 + random.below(12));
        uint8_t grey = static_cast<uint8_t>(random.next());
        for (int y = y0; y < std::min(height, y0 + size); ++y)
            for (int x = x0; x < std::min(width, x0 + size); ++x)
                pixels[static_cast<size_t>(y * width + x)] = grey;
    }
    return pixels;
}
