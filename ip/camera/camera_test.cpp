// SPDX-License-Identifier: MIT
//
// camera_test: tests the core with a sensor that has an independent clock with jitter, with a
// memory that stalls, and with all kinds of damaged frames.

#include "Vcamera_slot.h"
#include "bench.h"
#include "bus_master.h"
#include "camera_regs.h"
#include "model/sensor_model.h"
#include "npi_memory.h"
#include <gtest/gtest.h>

namespace {

constexpr int width = 40, height = 12;

class CameraTest : public ::testing::Test {
protected:
    CameraTest() {
        // Time advances in half periods of the fabric clock. Edges of the pixel clock are 1 to 3
        // half periods apart. They do not coincide with edges of the fabric clock.
        bench_.addModel([this] { edge(); }, [this] { edge(); });
        bench_.reset();
        bus_.write(CAMERA_MASK, 0x7F);
        place();
        configure(width, height);
    }
    // Places the buffers at random addresses, at least 64 KiB apart.
    void place() {
        auto isFar = [](uint32_t distance) { return distance + 0x10000 >= 0x20000; };
        do
            stride_ = random_.next() & ~(CAMERA_ALIGNMENT - 1u);
        while (!isFar(stride_) || !isFar(2 * stride_));
        base_ = random_.next() & ~(CAMERA_ALIGNMENT - 1u);
    }
    void configure(uint32_t w, uint32_t h) {
        bus_.write(CAMERA_SIZE, h << 16 | w);
        bus_.write(CAMERA_BASE, base_);
        bus_.write(CAMERA_STRIDE, stride_);
    }
    void edge() {
        if (--wait_ > 0)
            return;
        wait_ = 1 + static_cast<int>(random_.below(slowest_));
        auto& top = bench_.top();
        top.pclk_i = !top.pclk_i;
        if (!top.pclk_i) { // a sensor changes its pins at the falling edge of the pixel clock
            auto pins = sensor_.next();
            top.vsync_i = pins.vsync;
            top.href_i = pins.href;
            top.data_i = pins.data;
        }
    }
    std::vector<uint8_t> picture() { return random_.items<uint8_t>(width * height); }
    // Waits until the sensor has sent all its frames and the core has processed them. Returns the
    // events.
    uint32_t drain() {
        for (int i = 0; i < 200000 && !sensor_.isIdle(); ++i)
            bench_.tick();
        bench_.tick(400);
        return bus_.takeEvents();
    }
    uint32_t latest() {
        uint32_t value = bus_.read(CAMERA_LATEST);
        EXPECT_TRUE(value & CAMERA_LATEST_VALID_MASK);
        return base_ + ((value & CAMERA_LATEST_BUFFER_MASK) - 1) * stride_;
    }
    void expectAt(uint32_t at, const std::vector<uint8_t>& pixels) {
        ASSERT_EQ(memory_.bytes(at, pixels.size()), pixels);
    }
    void start() { bus_.write(CAMERA_CONTROL, CAMERA_CONTROL_START_MASK); }
    void stop() {
        bus_.write(CAMERA_CONTROL, CAMERA_CONTROL_STOP_MASK);
        bench_.waitFor([&] { return !(bus_.read(CAMERA_STATUS) & CAMERA_STATUS_ACTIVE_MASK); },
                       "the core to stop", 500);
    }

    uint32_t base_ = 0, stride_ = 0;
    Random random_{testSeed()};
    uint32_t slowest_ = 3;
    int wait_ = 1;
    SensorModel sensor_{{60, 9}};
    Bench<Vcamera_slot> bench_;
    BusMaster<Vcamera_slot> bus_{bench_};
    NpiMemory<Vcamera_slot> memory_{bench_, 0.2, testSeed()};
};

TEST_F(CameraTest, EveryFrameIsInMemoryAsTheSensorSentIt) {
    for (int placed = 0; placed < 12; ++placed) {
        place();
        configure(width, height);
        start();
        for (uint32_t i = 1; i <= 4; ++i) {
            // Settings written while the core is active take effect at the next START.
            for (unsigned word : {CAMERA_SIZE, CAMERA_BASE, CAMERA_STRIDE}) {
                uint32_t value = random_.next();
                bus_.write(word, value);
                ASSERT_EQ(bus_.read(word), value) << "word " << word;
            }
            auto pixels = picture();
            sensor_.addFrame(pixels, width, height);
            ASSERT_EQ(drain(), CAMERA_EVENT_FRAME_MASK);
            expectAt(latest(), pixels);
            EXPECT_EQ(bus_.read(CAMERA_FRAMES), i);
        }
        EXPECT_EQ(bus_.read(CAMERA_DROPPED), 0u);
        for (uint32_t i = 0; i < 3; ++i)
            EXPECT_EQ(memory_.byte(base_ + i * stride_ + width * height), 0)
                << "the camera wrote beyond a frame";
        stop();
    }
}

TEST_F(CameraTest, FramesMayHaveTheLargestSizeOfTheRegisters) {
    sensor_ = SensorModel({60, 1});
    for (auto [wide, lines] : {std::pair{8, 4095}, {2048, 1}, {2040, 2}, {8, 1}}) {
        configure(static_cast<uint32_t>(wide), static_cast<uint32_t>(lines));
        start();
        const auto pixels = random_.items<uint8_t>(static_cast<size_t>(wide * lines));
        sensor_.addFrame(pixels, wide, lines);
        EXPECT_EQ(drain(), CAMERA_EVENT_FRAME_MASK) << wide << " x " << lines;
        expectAt(latest(), pixels);
        stop();
    }
}

TEST_F(CameraTest, FramesAreCountedModulo65536) {
    // The frames follow each other as fast as the core can discard them: no frame has a line, and
    // each frame ends when the next frame starts.
    slowest_ = 1;
    sensor_ = SensorModel({4, 2});
    start();
    for (uint32_t begun = 0; begun < 0x10003; begun += 0x1001) {
        for (int i = 0; i < 0x1001; ++i)
            sensor_.addFrame({}, width, 0);
        EXPECT_EQ(drain(), CAMERA_EVENT_SHORT_FRAME_MASK);
        EXPECT_EQ(bus_.read(CAMERA_DROPPED), (begun + 0x1000) & 0xFFFF);
    }
    EXPECT_EQ(bus_.read(CAMERA_FRAMES), 0u);
    stop();
    // Complete frames follow each other as closely as bursts to memory and the FIFO allow.
    configure(8, 1);
    sensor_ = SensorModel({16, 1});
    memory_.setStall(0);
    start();
    for (uint32_t whole = 0; whole < 0x10001;) {
        for (int i = 0; i < 0x1001; ++i, ++whole)
            sensor_.addFrame(std::vector<uint8_t>(8, static_cast<uint8_t>(i)), 8, 1);
        EXPECT_EQ(drain(), CAMERA_EVENT_FRAME_MASK);
        EXPECT_EQ(bus_.read(CAMERA_FRAMES), whole & 0xFFFF);
    }
}

TEST_F(CameraTest, FramesWithShortGapsAreAllCaptured) {
    sensor_ = SensorModel({70, 3});
    start();
    std::vector<uint8_t> last;
    for (int i = 0; i < 8; ++i)
        sensor_.addFrame(last = picture(), width, height);
    EXPECT_EQ(drain(), CAMERA_EVENT_FRAME_MASK);
    EXPECT_EQ(bus_.read(CAMERA_FRAMES), 8u);
    expectAt(latest(), last);
}

TEST_F(CameraTest, BrokenFramesAreReportedAndNeverPassedOn) {
    start();
    auto good = picture();
    sensor_.addFrame(good, width, height);
    drain();
    const struct {
        SensorModel::Defect defect;
        uint32_t event;
    } cases[] = {{{3, -1, 0}, CAMERA_EVENT_SHORT_LINE_MASK},
                 {{height - 1, -8, 0}, CAMERA_EVENT_SHORT_LINE_MASK},
                 {{0, 1, 0}, CAMERA_EVENT_LONG_LINE_MASK},
                 {{5, 30, 0}, CAMERA_EVENT_LONG_LINE_MASK},
                 {{-1, 0, -1}, CAMERA_EVENT_SHORT_FRAME_MASK},
                 {{-1, 0, -height + 1}, CAMERA_EVENT_SHORT_FRAME_MASK}};
    uint32_t dropped = 0;
    for (auto& c : cases) {
        uint32_t before = latest();
        sensor_.addFrame(picture(), width, height, c.defect);
        sensor_.addFrame(good = picture(), width, height);
        EXPECT_EQ(drain(), c.event | CAMERA_EVENT_FRAME_MASK);
        EXPECT_EQ(bus_.read(CAMERA_DROPPED), ++dropped);
        EXPECT_NE(latest(), before);
        expectAt(latest(), good);
    }
    sensor_.addFrame(good = picture(), width, height, {-1, 0, 3});
    EXPECT_EQ(drain(), CAMERA_EVENT_LONG_FRAME_MASK | CAMERA_EVENT_FRAME_MASK);
    expectAt(latest(), good);
    EXPECT_EQ(bus_.read(CAMERA_DROPPED), dropped)
        << "a frame with too many lines is complete, and is not dropped";
}

TEST_F(CameraTest, ASlowMemoryIsReportedAndTheNextFrameIsCorrect) {
    start();
    memory_.hold(true);
    sensor_.addFrame(picture(), width, height);
    // the core sees the start of this frame, but cannot report yet that it is lost
    sensor_.addFrame(picture(), width, height);
    drain();
    memory_.hold(false);
    uint32_t events = drain();
    EXPECT_EQ(bus_.read(CAMERA_FRAMES), 0u) << events;
    auto pixels = picture();
    // the start of this frame ends the previous frame, which is incomplete because lines were lost
    sensor_.addFrame(picture(), width, height);
    sensor_.addFrame(pixels, width, height);
    events |= drain();
    EXPECT_TRUE(events & CAMERA_EVENT_OVERFLOW_MASK);
    EXPECT_EQ(bus_.read(CAMERA_DROPPED), 2u) << "the second dropped frame has no pixels";
    expectAt(latest(), pixels);
}

TEST_F(CameraTest, AFrameInUseByAnotherCoreIsNotOverwritten) {
    start();
    auto pixels = picture();
    sensor_.addFrame(pixels, width, height);
    drain();
    auto& top = bench_.top();
    for (int round = 0; round < 6; ++round) {
        ASSERT_TRUE(top.frame_valid_o);
        uint32_t at = base_ + (top.frame_index_o - 1u) * stride_;
        EXPECT_EQ(at, latest());
        top.frame_take_i = 1;
        bench_.tick();
        top.frame_take_i = 0;
        bench_.tick();
        EXPECT_FALSE(top.frame_valid_o) << "the frame is offered only once";
        std::vector<uint8_t> last;
        for (uint32_t i = 0; i < 1 + random_.below(4); ++i)
            sensor_.addFrame(last = picture(), width, height);
        drain();
        expectAt(at, pixels);
        expectAt(latest(), last);
        pixels = last;
    }
}

// In each run, the core completes the next frame in a different clock. The frame that the other
// core has taken must be complete, and must not change until the other core takes the next frame.
TEST_F(CameraTest, AnotherCoreMayClaimAFrameInAnyClock) {
    constexpr int w = 8, h = 1;
    slowest_ = 1;
    configure(w, h);
    start();
    auto& top = bench_.top();
    uint32_t held = 0; // address of the buffer that was taken
    std::vector<uint8_t> pixels;
    for (int frames = 0; frames < 1500; ++frames) {
        sensor_.addFrame(std::vector<uint8_t>(w * h, static_cast<uint8_t>(frames)), w, h);
        const uint32_t chosen = random_.below(150); // a frame takes about 150 clocks
        for (uint32_t clocks = 0; clocks < 150; ++clocks) {
            top.frame_take_i = clocks == chosen;
            top.eval();
            if (top.frame_take_i && top.frame_valid_o) {
                uint32_t at = base_ + (top.frame_index_o - 1u) * stride_;
                ASSERT_TRUE(pixels.empty() || at != held) << "the same frame is offered again";
                held = at;
                pixels.assign(w * h, memory_.byte(at));
            }
            bench_.tick();
        }
        expectAt(held, pixels);
    }
    top.frame_take_i = 0;
    EXPECT_GT(bus_.read(CAMERA_FRAMES), 1000u);
}

TEST_F(CameraTest, StopsAndStartsInTheMiddleOfAFrame) {
    start();
    for (int round = 0; round < 5; ++round) {
        sensor_.addFrame(picture(), width, height);
        bench_.tick(300 + random_.below(900));
        stop();
        EXPECT_FALSE(bench_.top().frame_valid_o);
        drain();
        start();
        auto pixels = picture();
        sensor_.addFrame(pixels, width, height);
        EXPECT_EQ(drain(), CAMERA_EVENT_FRAME_MASK);
        EXPECT_EQ(bus_.read(CAMERA_FRAMES), 1u);
        expectAt(latest(), pixels);
    }
}

TEST_F(CameraTest, RefusesInvalidSettings) {
    auto refused = [&] {
        start();
        // the settings are checked in the clock of START; REFUSED is set one clock later, and stays
        // set
        bench_.tick();
        bench_.tick();
        return bus_.takeEvents() == CAMERA_EVENT_REFUSED_MASK && bus_.read(CAMERA_STATUS) == 0;
    };
    for (auto [w, h] : {std::pair{17u, 8u},
                        {18u, 8u},
                        {20u, 8u},
                        {0u, 8u},
                        {2056u, 8u},
                        {4096u, 8u},
                        {8192u, 8u},
                        {16384u, 8u},
                        {32768u, 8u},
                        {16u, 0u},
                        {16u, 4096u},
                        {16u, 8192u},
                        {16u, 16384u},
                        {16u, 32768u}}) {
        configure(w, h);
        EXPECT_TRUE(refused()) << w << " x " << h;
    }
    for (uint32_t bit = 1; bit < CAMERA_ALIGNMENT; bit *= 2) {
        configure(16, 8);
        bus_.write(CAMERA_BASE, base_ + bit);
        EXPECT_TRUE(refused()) << bit;
        configure(16, 8);
        bus_.write(CAMERA_STRIDE, stride_ + bit);
        EXPECT_TRUE(refused()) << bit;
    }
    configure(16, 8);
    EXPECT_FALSE(refused());
    EXPECT_EQ(bus_.read(CAMERA_ID), CAMERA_ID_VALUE);
    EXPECT_TRUE(bus_.transfer(false, 11, 0).error);
}

TEST_F(CameraTest, StoresOnePixelPerClockIfTheMemoryKeepsUp) {
    constexpr uint32_t wide = 2048, lines = 6, words = wide / 8;
    memory_.setStall(0);
    configure(wide, lines);
    bus_.write(CAMERA_STRIDE, wide * lines);
    sensor_ = SensorModel({60, 1});
    // Counts, for each line that is sent to memory, the clocks from the first to the last word, and
    // the pixels of all words but the first.
    uint64_t first = 0, clocks = 0, seen = 0;
    bench_.addModel(
        [&] {
            if (!bench_.top().npi_wr_push_o)
                return;
            if (seen % words == 0)
                first = bench_.cycles();
            if (++seen % words == 0)
                clocks += bench_.cycles() - first;
        },
        [] {});
    auto pixelsPerClock = [&](uint32_t slowest) {
        slowest_ = slowest;
        clocks = seen = 0;
        start();
        std::vector<uint8_t> pixels;
        for (int i = 0; i < 3; ++i) {
            pixels = random_.items<uint8_t>(wide * lines);
            sensor_.addFrame(pixels, wide, lines);
        }
        EXPECT_EQ(drain(), CAMERA_EVENT_FRAME_MASK);
        EXPECT_EQ(bus_.read(CAMERA_FRAMES), 3u);
        EXPECT_EQ(seen, 3 * lines * words);
        uint32_t at =
            base_ + ((bus_.read(CAMERA_LATEST) & CAMERA_LATEST_BUFFER_MASK) - 1) * wide * lines;
        expectAt(at, pixels);
        bus_.write(CAMERA_CONTROL, CAMERA_CONTROL_STOP_MASK);
        bench_.tick(100);
        return static_cast<double>((words - 1) * 8 * 3 * lines) / static_cast<double>(clocks);
    };
    double rate = pixelsPerClock(1); // the pixel clock has the frequency of the fabric clock
    std::printf("%.3f pixels a clock, and none lost\n", rate);
    EXPECT_GE(rate, 0.999);
    // A slower pixel clock lowers the rate: its edges are 1 or 2 half periods apart.
    EXPECT_NEAR(pixelsPerClock(2), 2.0 / 3, 0.02);
}

} // namespace
