// SPDX-License-Identifier: MIT
//
// camera: reads a grey-scale frame from a picture file in a format that stb_image can read (PNG,
// JPEG, PGM and others).

#pragma once

#include <cstdint>
#include <string>
#include <vector>

struct Frame {
    int width = 0, height = 0;
    std::vector<uint8_t> pixels;
};

// Returns the middle of the picture. If the picture is at least twice as large as requested, it is
// first reduced by an integer factor. The width is rounded to a multiple of 8. Throws
// std::runtime_error with the reason if this fails.
Frame loadFrame(const std::string& path, int width, int height);
// Returns the picture as seen by a camera that has moved: the columns are rotated to the left.
Frame movedBy(Frame frame, int columns);
void savePng(const std::string& path, const Frame& frame);
