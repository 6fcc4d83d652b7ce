// SPDX-License-Identifier: MIT
//
// camera: reads a grey-scale frame from a picture file (PNG, JPEG, PGM and others of stb_image).

#pragma once

#include <cstdint>
#include <string>
#include <vector>

struct Frame {
    int width = 0, height = 0;
    std::vector<uint8_t> pixels;
};

// Returns the middle of the picture, reduced by a whole factor where it is at least twice the
// wanted size. The width becomes a multiple of 8. Throws std::runtime_error with the reason.
Frame loadFrame(const std::string& path, int width, int height);
// Returns the picture from another place: its columns moved to the left, round its end.
Frame movedBy(Frame frame, int columns);
void savePng(const std::string& path, const Frame& frame);
