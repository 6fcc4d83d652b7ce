// SPDX-License-Identifier: MIT
//
// follow_test: in the whole chip the camera fills DDR3 and the vision core takes its frames,
// without the processor.

#include "camera_regs.h"
#include "map_regs.h"
#include "random.h"
#include "sensor_model.h"
#include "soc_model.h"
#include "vision_model.h"
#include "vision_regs.h"
#include <gtest/gtest.h>

namespace {

constexpr int width = 64, height = 40;
constexpr uint32_t base = 0x200000, stride = 0x1000, results = 0x300000;

TEST(Follow, EachFrameOfTheSensorBecomesCorners) {
    Random random(testSeed());
    RfChannel air(testSeed());
    SocModel soc(air, {});
    soc.reset();
    FsmcMaster& fsmc = soc.fsmc();
    for (uint32_t bank : {0u, 1u}) {
        fsmc.write32(0xA0000004 + 8 * bank, 0x00010402);
        fsmc.write32(0xA0000000 + 8 * bank, 0x00009091);
    }
    auto write = [&](uint32_t slot, uint32_t word, uint32_t value) {
        fsmc.write32(MAP_CONTROL_WINDOW + 64 * slot + 4 * word, value);
    };
    auto read = [&](uint32_t slot, uint32_t word) {
        return fsmc.read32(MAP_CONTROL_WINDOW + 64 * slot + 4 * word);
    };
    write(MAP_SLOT_CAMERA, CAMERA_SIZE, height << 16 | width);
    write(MAP_SLOT_CAMERA, CAMERA_BASE, base);
    write(MAP_SLOT_CAMERA, CAMERA_STRIDE, stride);
    write(MAP_SLOT_CAMERA, CAMERA_CONTROL, CAMERA_CONTROL_START_MASK);
    write(MAP_SLOT_VISION, VISION_FRAME_SIZE, height << 16 | width);
    write(MAP_SLOT_VISION, VISION_FRAME_BASE, base);
    write(MAP_SLOT_VISION, VISION_FRAME_STRIDE, stride);
    write(MAP_SLOT_VISION, VISION_RESULT_BASE, results);
    write(MAP_SLOT_VISION, VISION_RESULT_MAX, 1000);
    write(MAP_SLOT_VISION, VISION_THRESHOLD, 25);
    write(MAP_SLOT_VISION, VISION_MODE, VISION_MODE_FOLLOW_MASK);

    SensorModel sensor({200, 9});
    SensorModel::Pins pins;
    bool clock = false;
    auto tick = [&] { // the pixel clock is a third of the fabric's, and a little uneven
        if (random.below(3) < 2) {
            clock = !clock;
            if (!clock)
                pins = sensor.next();
        }
        soc.setCorePins(uint32_t(clock) << MAP_PIN_CAMERA_PCLK_I |
                        uint32_t(pins.vsync) << MAP_PIN_CAMERA_VSYNC_I |
                        uint32_t(pins.href) << MAP_PIN_CAMERA_HREF_I |
                        uint32_t(pins.data) << MAP_PIN_CAMERA_DATA_I);
        soc.tick();
    };
    for (int frame = 0; frame < 5; ++frame) {
        std::vector<uint8_t> pixels(width * height);
        for (size_t i = 0; i < pixels.size(); ++i)
            pixels[i] = static_cast<uint8_t>((i / 9 % 3 + i / 450 % 2) * 70 + random.below(30));
        sensor.addFrame(pixels, width, height);
        for (int i = 0; i < 40000; ++i) // nobody on the bus
            tick();
        ASSERT_EQ(read(MAP_SLOT_VISION, VISION_EVENT), VISION_EVENT_DONE_MASK) << "frame " << frame;
        EXPECT_EQ(read(MAP_SLOT_VISION, VISION_FRAME), read(MAP_SLOT_CAMERA, CAMERA_LATEST) & 3);
        auto want = detectCorners(pixels.data(), width, height, 25);
        ASSERT_GT(want.size(), 5u);
        EXPECT_EQ(read(MAP_SLOT_VISION, VISION_FOUND), want.size());
        const uint8_t* record = soc.memory().data() + results;
        for (size_t i = 0; i < want.size(); ++i, record += VISION_RECORD_BYTES) {
            Feature got{record[0] | record[1] << 8, record[2] | record[3] << 8,
                        record[4] | record[5] << 8};
            ASSERT_TRUE(got == want[i]) << "corner " << i << " of frame " << frame;
        }
        write(MAP_SLOT_VISION, VISION_EVENT, VISION_EVENT_DONE_MASK);
    }
    EXPECT_EQ(read(MAP_SLOT_CAMERA, CAMERA_FRAMES), 5u);
    EXPECT_EQ(read(MAP_SLOT_CAMERA, CAMERA_DROPPED), 0u);
}

} // namespace
