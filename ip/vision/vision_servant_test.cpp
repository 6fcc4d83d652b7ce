// SPDX-License-Identifier: MIT
//
// vision_servant_test: tests HwProcessingEngine through the FSMC driver; the core computes the
// results.

#include "Vvision_slot.h"
#include "core_slot.h"
#include "picture_test.h"
#include "vision_model.h"
#include <utility>
extern "C" {
#include "vision_regs.h"
#include "vision_servant.h"
}

namespace {
U32 busErrors, busErrorsOfRead, cornersTold;
constexpr U32 pictureAt = 0x00100000, sizeAt = 0x000FFF80;

U32 countBusErrors(void*) {
    return busErrors += busErrorsOfRead;
}
void frameProcessed(U32 corners) {
    cornersTold = corners;
}
Hw_Frames frames;

// Waits like the application, which uses one semaphore for all events.
int waitForAny(void* context, U32, U32 ms) {
    auto& slot = *static_cast<CoreSlot<Vvision_slot>*>(context);
    for (U32 i = 0; i < ms * coreClocksOfMs && !slot.posted_; ++i)
        slot.tick();
    return std::exchange(slot.posted_, 0u) != 0;
}
const Hw_Port port = {waitForAny, CoreSlot<Vvision_slot>::post, CoreSlot<Vvision_slot>::nowMs,
                      countBusErrors, &frames};

// the picture has more corners than fit into a result
constexpr int width = 64, height = 48, threshold = 5;

class VisionServant : public ::testing::Test {
protected:
    VisionServant() {
        frames = {0, 0, 0, 0, pictureAt, sizeAt, frameProcessed};
        busErrorsOfRead = cornersTold = 0;
        EXPECT_EQ(Vision_Core_init(&core_, coreSlot, coreMemory, &port, &slot_), HW_OK);
        slot_.interrupt_ = [this] { Vision_Core_interrupt(&core_); };
        EXPECT_EQ(Autopilot_HwProcessingEngine_setParameterA(&core_.servant, threshold, nullptr),
                  ICE_OK);
    }
    void load(uint32_t at) {
        pixels_ = picture(width, height, random_);
        slot_.memory_.store(at, pixels_);
    }
    void header(uint32_t w, uint32_t h) {
        for (uint32_t i = 0; i < 4; ++i) {
            slot_.memory_.setByte(sizeAt + i, static_cast<uint8_t>(w >> 8 * i));
            slot_.memory_.setByte(sizeAt + 4 + i, static_cast<uint8_t>(h >> 8 * i));
        }
    }
    void loadAtHeader() {
        header(width, height);
        load(pictureAt);
    }
    void useCamera() {
        frames.base = coreMemory + 0x100000;
        frames.stride = 0x1000;
        frames.width = width;
        frames.height = height;
    }
    Ice_Status start() {
        return Autopilot_HwProcessingEngine_startProcessing(&core_.servant, nullptr);
    }
    Ice_Status result() {
        return Autopilot_HwProcessingEngine_getResult(&core_.servant, &result_, nullptr);
    }
    void expectCorners() {
        auto want = detectCorners(pixels_.data(), width, height, threshold);
        EXPECT_EQ(result_.found, static_cast<Ice_Int>(want.size()));
        EXPECT_EQ(cornersTold, want.size());
        EXPECT_GT(result_.cycles, width * height - 1);
        std::vector<Feature> got;
        for (Ice_Int i = 0; i < result_.best.size; ++i)
            got.push_back(
                {result_.best.data[i].x, result_.best.data[i].y, result_.best.data[i].score});
        EXPECT_TRUE(got == strongest(want, VISION_BEST));
    }

    Random random_{testSeed()};
    CoreSlot<Vvision_slot> slot_;
    Vision_Core core_{};
    Autopilot_ResultType result_{};
    std::vector<uint8_t> pixels_;
};

TEST_F(VisionServant, ReturnsTheStrongestCornersOfThePicture) {
    for (int i = 0; i < 4; ++i) {
        loadAtHeader();
        ASSERT_EQ(start(), ICE_OK);
        ASSERT_EQ(result(), ICE_OK);
        EXPECT_GT(result_.found, VISION_BEST);
        expectCorners();
    }
    EXPECT_EQ(result(), ICE_OK);
    expectCorners(); // again
    EXPECT_EQ(Vision_Core_poll(&core_, 0), HW_NEVER);
    for (int value : {-1, 256}) {
        DirectCall call;
        EXPECT_EQ(Autopilot_HwProcessingEngine_setParameterA(
                      &core_.servant, static_cast<Ice_Short>(value), &call.current),
                  ICE_UNKNOWN_EXCEPTION);
        EXPECT_EQ(call.reason(), "value: expected 0 to 255");
    }
}

TEST_F(VisionServant, UsesTheFramesOfTheCameraIfThereIsOne) {
    useCamera();
    auto& top = slot_.bench_.top();
    for (uint32_t buffer : {1u, 3u, 2u}) {
        load(frames.base + (buffer - 1) * frames.stride);
        ASSERT_EQ(start(), ICE_OK);
        top.frame_index_i = static_cast<uint8_t>(buffer);
        top.frame_valid_i = 1;
        // the camera offers another frame, but each start processes only one frame
        ASSERT_EQ(result(), ICE_OK);
        expectCorners();
    }
}

TEST_F(VisionServant, AFrameRefusedByTheCoreIsAnError) {
    header(12, height);
    ASSERT_EQ(start(), ICE_OK);
    EXPECT_EQ(result(), ICE_UNKNOWN_EXCEPTION);
    loadAtHeader();
    busErrorsOfRead = 1;
    ASSERT_EQ(start(), ICE_OK);
    EXPECT_EQ(result(), ICE_UNKNOWN_EXCEPTION) << "the core's registers did not respond";
    busErrorsOfRead = 0;
    ASSERT_EQ(start(), ICE_OK);
    ASSERT_EQ(result(), ICE_OK);
    expectCorners();
}

TEST_F(VisionServant, AnAbortedFrameHasNoResult) {
    loadAtHeader();
    ASSERT_EQ(start(), ICE_OK);
    for (int i = 0; i < 1500; ++i)
        slot_.tick();
    slot_.memory_.hold(true);
    EXPECT_EQ(result(), ICE_TIMEOUT);
    slot_.memory_.hold(false);
    EXPECT_EQ(result(), ICE_UNKNOWN_EXCEPTION) << "the result is incomplete";
    ASSERT_EQ(start(), ICE_OK);
    ASSERT_EQ(result(), ICE_OK);
    expectCorners();
}

TEST_F(VisionServant, AMissingFrameOfTheCameraIsAwaitedOnlyOnce) {
    useCamera();
    ASSERT_EQ(start(), ICE_OK);
    EXPECT_EQ(result(), ICE_TIMEOUT);
    frames.width = 0;
    loadAtHeader();
    ASSERT_EQ(start(), ICE_OK);
    ASSERT_EQ(result(), ICE_OK);
    expectCorners();
}

} // namespace
