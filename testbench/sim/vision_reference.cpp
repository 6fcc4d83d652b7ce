// SPDX-License-Identifier: MIT
//
// vision-reference: computes the corners in a picture with the model of the vision core, and prints
// the answer that the UAV must give, as JSON. Usage: vision-reference PICTURE THRESHOLD

#include "camera.h"
#include "vision_model.h"
#include "vision_regs.h"
#include <cstdio>
#include <cstdlib>
#include <iostream>

int main(int argc, char** argv) {
    if (argc != 3) {
        std::cerr << "usage: vision-reference picture threshold\n";
        return 2;
    }
    try {
        Frame frame = loadFrame(argv[1], 1024, 4096);
        auto corners =
            detectCorners(frame.pixels.data(), frame.width, frame.height, std::atoi(argv[2]));
        // the core counts and stores at most this number of corners
        if (corners.size() > VISION_RECORDS)
            corners.resize(VISION_RECORDS);
        std::printf("{\"found\": %zu, \"best\": [", corners.size());
        const char* separator = "";
        for (const Feature& f : strongest(corners, 64)) {
            std::printf("%s[%d, %d, %d]", separator, f.x, f.y, f.score);
            separator = ", ";
        }
        std::printf("]}\n");
    } catch (const std::exception& e) {
        std::cerr << "vision-reference: error: " << e.what() << "\n";
        return 1;
    }
    return 0;
}
