// SPDX-License-Identifier: MIT
//
// vision_model: the vision core's result, computed on the host, bit by bit (ip/vision/README.md).

#ifndef VISION_MODEL_H
#define VISION_MODEL_H

#include <cstddef>
#include <cstdint>
#include <vector>

struct Feature {
    int x, y;
    int score;
    bool operator==(const Feature& o) const { return x == o.x && y == o.y && score == o.score; }
};

// Corners in scan order. `pixels`: width * height bytes, line by line.
std::vector<Feature> detectCorners(const uint8_t* pixels, int width, int height, int threshold);

// The strongest `count`, strongest first; of equal ones the first in scan order first.
std::vector<Feature> strongest(std::vector<Feature> features, size_t count);

#endif
