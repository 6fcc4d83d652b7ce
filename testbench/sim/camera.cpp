// SPDX-License-Identifier: MIT
//
// camera: reduces and crops a picture to the size of the camera's frame.

#include "camera.h"
#include "picture.h"
#include <algorithm>
#include <cstdio>
#include <fstream>
#include <stdexcept>

#define STB_IMAGE_WRITE_IMPLEMENTATION
#include <stb/stb_image_write.h>

namespace {
constexpr int leastSide = 8; // smallest width and height that the vision core supports
}

Frame loadFrame(const std::string& path, int width, int height) {
    const Picture picture = readPicture(path);
    const int w = picture.width, h = picture.height;
    int factor = std::max(1, std::min(w / width, h / height));
    Frame frame;
    frame.width = std::min(width, w / factor) / 8 * 8;
    frame.height = std::min(height, h / factor);
    if (frame.width < leastSide || frame.height < leastSide)
        throw std::runtime_error("'" + path + "' is " + std::to_string(w) + " x " +
                                 std::to_string(h) + " pixels: expected at least 8 x 8");
    int left = (w - frame.width * factor) / 2, top = (h - frame.height * factor) / 2;
    for (int y = 0; y < frame.height; ++y)
        for (int x = 0; x < frame.width; ++x) {
            int sum = 0;
            for (int dy = 0; dy < factor; ++dy)
                for (int dx = 0; dx < factor; ++dx)
                    sum += picture.at(left + x * factor + dx, top + y * factor + dy);
            frame.pixels.push_back(static_cast<uint8_t>(sum / (factor * factor)));
        }
    return frame;
}

Frame movedBy(Frame frame, int columns) {
    for (auto row = frame.pixels.begin(); row != frame.pixels.end(); row += frame.width)
        std::rotate(row, row + columns, row + frame.width);
    return frame;
}

void savePng(const std::string& path, const Frame& frame) {
    const std::string temporary = path + ".new";
    std::ofstream file(temporary, std::ios::binary);
    auto put = [](void* to, void* bytes, int size) {
        static_cast<std::ofstream*>(to)->write(static_cast<const char*>(bytes), size);
    };
    stbi_write_png_to_func(put, &file, frame.width, frame.height, 1, frame.pixels.data(),
                           frame.width);
    file.close();
    if (!file || std::rename(temporary.c_str(), path.c_str()) != 0) {
        std::remove(temporary.c_str());
        throw std::runtime_error("cannot write '" + path +
                                 "': is the disk full, or the folder read-only?");
    }
}
