// SPDX-License-Identifier: MIT
//
// sensor_model: models the parallel port of an image sensor: computes the levels of its pins at
// each pixel clock, and damages frames on request.

#pragma once

#include <cstdint>
#include <deque>
#include <vector>

class SensorModel {
public:
    struct Pins {
        bool vsync = true, href = false;
        uint8_t data = 0;
    };
    // Blanking before each frame and after each line, pixel clocks.
    struct Blanking {
        int frame = 60, line = 9;
    };
    struct Defect {
        int line = -1; // current line
        // number of additional pixels in the damaged line; a negative number means missing pixels
        int pixels = 0;
        // number of additional lines in the frame; a negative number means missing lines
        int lines = 0;
    };

    explicit SensorModel(Blanking blanking) : blanking_(blanking) {}

    void addFrame(const std::vector<uint8_t>& pixels, int width, int height) {
        addFrame(pixels, width, height, Defect());
    }
    void addFrame(const std::vector<uint8_t>& pixels, int width, int height, Defect defect) {
        for (int i = 0; i < blanking_.frame; ++i)
            pins_.push_back({true, false, 0xEE});
        rest(blanking_.line);
        for (int y = 0; y < height + defect.lines; ++y) {
            int wide = width + (y == defect.line ? defect.pixels : 0);
            for (int x = 0; x < wide; ++x)
                pins_.push_back({false, true,
                                 x < width && y < height
                                     ? pixels[static_cast<size_t>(y * width + x)]
                                     : uint8_t(0x99)});
            rest(blanking_.line);
        }
    }
    bool isIdle() const { return pins_.empty(); }
    // Returns the levels of the pins at the next pixel clock. After the last frame the pins are
    // idle.
    Pins next() {
        if (pins_.empty())
            return {};
        Pins pins = pins_.front();
        pins_.pop_front();
        return pins;
    }

private:
    void rest(int clocks) {
        for (int i = 0; i < clocks; ++i)
            pins_.push_back({false, false, 0xDD});
    }
    Blanking blanking_;
    std::deque<Pins> pins_;
};
