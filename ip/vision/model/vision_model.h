// SPDX-License-Identifier: MIT
//
// vision_model: computes the results of the vision core on the host, exact to the bit
// (ip/vision/README.md): FAST-9 and non-maximum suppression. It is written for clarity, not for
// speed.

#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

struct Feature {
    int x, y;
    int score;
    bool operator==(const Feature& o) const { return x == o.x && y == o.y && score == o.score; }
};

inline constexpr int circle[16][2] = {{0, -3}, {1, -3},  {2, -2},  {3, -1}, {3, 0},  {3, 1},
                                      {2, 2},  {1, 3},   {0, 3},   {-1, 3}, {-2, 2}, {-3, 1},
                                      {-3, 0}, {-3, -1}, {-2, -2}, {-1, -3}};

inline int scoreAt(const uint8_t* pixels, int width, int x, int y, int threshold) {
    int centre = pixels[y * width + x];
    int excess[16], kind[16];
    for (int i = 0; i < 16; ++i) {
        int p = pixels[(y + circle[i][1]) * width + x + circle[i][0]];
        kind[i] = p > centre + threshold ? 1 : p < centre - threshold ? -1 : 0;
        excess[i] = kind[i] > 0 ? p - centre - threshold : kind[i] < 0 ? centre - threshold - p : 0;
    }
    for (int wanted : {1, -1}) {
        int run = 0, longest = 0, sum = 0;
        for (int i = 0; i < 32; ++i) {
            run = kind[i % 16] == wanted ? run + 1 : 0;
            longest = std::max(longest, run);
            if (i < 16 && kind[i] == wanted)
                sum += excess[i];
        }
        if (longest >= 9)
            return sum;
    }
    return 0;
}

// Returns the corners in scan order. `pixels` contains width * height bytes, line by line.
inline std::vector<Feature> detectCorners(const uint8_t* pixels, int width, int height,
                                          int threshold) {
    std::vector<int> scores(static_cast<size_t>(width * height));
    auto at = [&](int x, int y) -> int& { return scores[static_cast<size_t>(y * width + x)]; };
    for (int y = 3; y < height - 3; ++y)
        for (int x = 3; x < width - 3; ++x)
            at(x, y) = scoreAt(pixels, width, x, y, threshold);
    std::vector<Feature> found;
    for (int y = 3; y < height - 3; ++y)
        for (int x = 3; x < width - 3; ++x) {
            int s = at(x, y);
            bool kept = s > 0;
            for (int dy = -1; dy <= 1; ++dy)
                for (int dx = -1; dx <= 1; ++dx) {
                    bool earlier = dy < 0 || (dy == 0 && dx < 0);
                    if (dx || dy)
                        kept = kept && (earlier ? s > at(x + dx, y + dy) : s >= at(x + dx, y + dy));
                }
            if (kept)
                found.push_back({x, y, s});
        }
    return found;
}

// Returns the `count` strongest features, strongest first; features of equal strength stay in scan
// order.
inline std::vector<Feature> strongest(std::vector<Feature> features, size_t count) {
    std::stable_sort(features.begin(), features.end(),
                     [](const Feature& a, const Feature& b) { return a.score > b.score; });
    if (features.size() > count)
        features.resize(count);
    return features;
}
