// SPDX-License-Identifier: MIT
//
// vision_vectors: writes a random picture and the records that the model computes, for the VHDL
// test bench. Usage: vision_vectors FOLDER SEED. Writes FOLDER/picture.txt (one pixel per line) and
// FOLDER/records.txt (one line "x y score" per record).

#include "random.h"
#include "vision_model.h"
#include <cstdlib>
#include <fstream>
#include <string>

int main(int argc, char** argv) {
    if (argc != 3)
        return 2;
    constexpr int width = 64, height = 40, threshold = 20;
    Random random(std::strtoull(argv[2], nullptr, 0));
    std::vector<uint8_t> pixels(width * height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x)
            pixels[static_cast<size_t>(y * width + x)] =
                static_cast<uint8_t>(((x / 7 + y / 9) % 2 ? 180 : 60) + random.below(40));
    std::ofstream picture(std::string(argv[1]) + "/picture.txt"),
        records(std::string(argv[1]) + "/records.txt");
    for (uint8_t p : pixels)
        picture << int(p) << "\n";
    for (const Feature& f : detectCorners(pixels.data(), width, height, threshold))
        records << f.x << " " << f.y << " " << f.score << "\n";
    return picture && records ? 0 : 1;
}
