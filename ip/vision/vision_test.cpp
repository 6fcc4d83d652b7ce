// SPDX-License-Identifier: MIT
//
// vision_test: compares the core, as converted to Verilog, with its model, while the memory stalls.

#include "Vvision_slot.h"
#include "bench.h"
#include "bus_master.h"
#include "npi_memory.h"
#include "picture_test.h"
#include "vision_model.h"
#include "vision_regs.h"
#include <gtest/gtest.h>

namespace {

class VisionTest : public ::testing::Test {
protected:
    void SetUp() override {
        bench_.reset();
        bus_.write(VISION_MASK, 3);
        Random random(testSeed());
        place(random);
    }
    // Places the buffers at random addresses, at least 1 MiB apart.
    void place(Random& random) {
        do {
            frameBase_ = random.next() & ~(127u);
            resultBase_ = random.next() & ~(127u);
        } while (frameBase_ - resultBase_ + 0x100000 < 0x200000);
    }
    void load(const std::vector<uint8_t>& pixels) { memory_.store(frameBase_, pixels); }
    void start(int width, int height, int threshold, uint32_t most = 65535) {
        bus_.write(VISION_THRESHOLD, static_cast<uint32_t>(threshold));
        bus_.write(VISION_FRAME_BASE, frameBase_);
        bus_.write(VISION_FRAME_SIZE, static_cast<uint32_t>(height << 16 | width));
        bus_.write(VISION_RESULT_BASE, resultBase_);
        bus_.write(VISION_RESULT_MAX, most);
        bus_.write(VISION_CONTROL, VISION_CONTROL_START_MASK);
    }
    uint32_t finish(uint64_t limit = 4'000'000) {
        bench_.waitFor([&] { return bench_.top().irq_o; }, "the core's interrupt", limit);
        return bus_.takeEvents();
    }
    std::vector<Feature> results() {
        std::vector<Feature> list;
        for (uint32_t i = 0; i < bus_.read(VISION_STORED); ++i) {
            uint32_t at = resultBase_ + 8 * i;
            auto half = [&](uint32_t o) {
                return memory_.byte(at + o) | memory_.byte(at + o + 1) << 8;
            };
            list.push_back({half(0), half(2), half(4)});
        }
        return list;
    }

    uint32_t frameBase_ = 0, resultBase_ = 0;
    Bench<Vvision_slot> bench_;
    BusMaster<Vvision_slot> bus_{bench_};
    NpiMemory<Vvision_slot> memory_{bench_, 0.2, testSeed()};
};

TEST_F(VisionTest, EqualsTheModelForManySizesAndThresholds) {
    Random random(testSeed());
    const int sizes[][2] = {{8, 8}, {16, 8}, {8, 30}, {64, 48}, {128, 33}, {1024, 9}, {40, 64}};
    for (auto& size : sizes)
        for (int threshold : {0, 10, 40, 255}) {
            place(random);
            auto pixels = picture(size[0], size[1], random);
            load(pixels);
            start(size[0], size[1], threshold);
            EXPECT_EQ(finish(), VISION_EVENT_DONE_MASK);
            auto want = detectCorners(pixels.data(), size[0], size[1], threshold);
            EXPECT_EQ(bus_.read(VISION_FOUND), want.size());
            EXPECT_TRUE(results() == want)
                << size[0] << " x " << size[1] << ", threshold " << threshold;
        }
}

TEST_F(VisionTest, ProcessesOnePixelPerClockIfTheMemoryKeepsUp) {
    Random random(testSeed());
    memory_.setStall(0);
    load(picture(128, 64, random));
    start(128, 64, 60);
    finish();
    double perPixel = bus_.read(VISION_CYCLES) / (128.0 * 64);
    std::printf("%.3f clocks a pixel\n", perPixel);
    EXPECT_LT(perPixel, 1.2);
}

TEST_F(VisionTest, StoresAtMostTheSetNumberOfCorners) {
    Random random(testSeed());
    auto pixels = picture(64, 48, random);
    load(pixels);
    start(64, 48, 10, 5);
    finish();
    auto want = detectCorners(pixels.data(), 64, 48, 10);
    ASSERT_GT(want.size(), 5u);
    EXPECT_EQ(bus_.read(VISION_FOUND), want.size());
    EXPECT_EQ(bus_.read(VISION_STORED), 5u);
    want.resize(5);
    EXPECT_TRUE(results() == want);
    EXPECT_EQ(memory_.byte(resultBase_ + 40), 0) << "the core wrote beyond the fifth corner";
}

TEST_F(VisionTest, SettingsWrittenWhileBusyApplyToTheNextFrame) {
    Random random(testSeed());
    auto pixels = picture(64, 48, random);
    load(pixels);
    start(64, 48, 20);
    bench_.tick(900);
    bus_.write(VISION_THRESHOLD, 90);
    bus_.write(VISION_FRAME_SIZE, 16u << 16 | 16u);
    bus_.write(VISION_RESULT_MAX, 1);
    bus_.write(VISION_FRAME_BASE, 0);
    EXPECT_EQ(finish(), VISION_EVENT_DONE_MASK);
    EXPECT_TRUE(results() == detectCorners(pixels.data(), 64, 48, 20));
    EXPECT_EQ(bus_.read(VISION_THRESHOLD), 90u);
}

TEST_F(VisionTest, RefusesInvalidSettings) {
    for (auto [width, height] : {std::pair{12, 16}, {0, 16}, {1032, 16}, {16, 7}}) {
        start(width, height, 10);
        EXPECT_EQ(finish(), VISION_EVENT_REFUSED_MASK) << width << " x " << height;
        EXPECT_EQ(bus_.read(VISION_STATUS), 0u);
    }
    bus_.write(VISION_FRAME_SIZE, 16u << 16 | 16u);
    bus_.write(VISION_FRAME_BASE, frameBase_ + 8);
    bus_.write(VISION_CONTROL, VISION_CONTROL_START_MASK);
    EXPECT_EQ(finish(), VISION_EVENT_REFUSED_MASK);
}

TEST_F(VisionTest, AnAbortEndsAFrameAndTheNextIsCorrect) {
    Random random(testSeed());
    auto pixels = picture(64, 48, random);
    load(pixels);
    start(64, 48, 20);
    bench_.tick(700);
    bus_.write(VISION_CONTROL, VISION_CONTROL_ABORT_MASK);
    EXPECT_EQ(finish(2000), VISION_EVENT_DONE_MASK);
    EXPECT_EQ(bus_.read(VISION_STATUS), VISION_STATUS_ABORTED_MASK);
    start(64, 48, 20);
    EXPECT_EQ(finish(), VISION_EVENT_DONE_MASK);
    EXPECT_TRUE(results() == detectCorners(pixels.data(), 64, 48, 20));
}

TEST_F(VisionTest, ProcessesFramesOfAnotherCore) {
    Random random(testSeed());
    constexpr uint32_t stride = 64 * 48;
    auto& top = bench_.top();
    start(64, 48, 25);
    finish();
    bus_.write(VISION_FRAME_STRIDE, stride);
    bus_.write(VISION_MODE, VISION_MODE_FOLLOW_MASK);
    for (uint32_t buffer : {1u, 2u, 3u, 2u}) {
        auto pixels = picture(64, 48, random);
        memory_.store(frameBase_ + (buffer - 1) * stride, pixels);
        top.frame_index_i = static_cast<uint8_t>(buffer);
        top.frame_valid_i = 1;
        bench_.waitFor([&] { return top.frame_take_o; }, "the frame to be taken", 5);
        bench_.tick();
        EXPECT_FALSE(top.frame_take_o) << "the frame is taken only once";
        bench_.waitFor([&] { return top.irq_o; }, "the core's interrupt", 100000);
        // the next frame is offered, but it must not start, because the results of the current
        // frame have not been read
        for (int i = 0; i < 50; ++i) {
            EXPECT_FALSE(top.frame_take_o);
            bench_.tick();
        }
        top.frame_valid_i = 0;
        EXPECT_EQ(bus_.read(VISION_FRAME), buffer);
        EXPECT_TRUE(results() == detectCorners(pixels.data(), 64, 48, 25)) << "buffer " << buffer;
        EXPECT_EQ(finish(), VISION_EVENT_DONE_MASK);
    }
    bus_.write(VISION_FRAME_STRIDE, stride + 8);
    top.frame_valid_i = 1;
    EXPECT_EQ(finish(), VISION_EVENT_REFUSED_MASK);
    EXPECT_EQ(bus_.read(VISION_MODE), 0u);
}

TEST_F(VisionTest, IdentifiesItselfAndHasAllRegisters) {
    EXPECT_EQ(bus_.read(VISION_ID), VISION_ID_VALUE);
    for (unsigned word = 0; word < 16; ++word)
        EXPECT_FALSE(bus_.transfer(false, word, 0).error) << word;
}

} // namespace
