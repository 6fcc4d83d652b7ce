// SPDX-License-Identifier: MIT
//
// picture: reads a PNG, JPEG or PNM file as grey levels, 0 to 255, and turns the picture upright.

#pragma once

#include <cstdint>
#include <string>
#include <vector>

struct Picture {
    int width = 0, height = 0;
    std::vector<uint8_t> grey; // grey levels, row by row

    uint8_t at(int x, int y) const { return grey[static_cast<size_t>(y) * width + x]; }
};

// Reads a picture. If the file cannot be read or is not a picture, throws std::runtime_error with
// the reason.
Picture readPicture(const std::string& path);
