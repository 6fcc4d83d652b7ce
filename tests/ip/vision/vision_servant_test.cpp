// SPDX-License-Identifier: MIT
//
// vision_servant_test: HwProcessingEngine by the core, through the FSMC driver; the application's
// part (uav.h) is here.

#include "VVision.h"
#include "core_slot.h"
#include "picture.h"
#include "vision_model.h"
#include <utility>
extern "C" {
#include "uav.h"
#include "vision_regs.h"
#include "vision_servant.h"
}

namespace {
Uav_Frames frames;
U32 busErrors, busErrorsOfRead, cornersTold;
} // namespace

extern "C" U32 UAV_busErrors(void) {
    return busErrors += busErrorsOfRead;
}
extern "C" const Uav_Frames* UAV_frames(void) {
    return &frames;
}
extern "C" void UAV_frameDone(U32 corners) {
    cornersTold = corners;
}

namespace {

// As the application waits: one semaphore for all events.
int waitForAny(void* context, U32, U32 ms) {
    auto& slot = *static_cast<CoreSlot<VVision>*>(context);
    for (U32 i = 0; i < ms * coreClocksOfMs && !slot.posted_; ++i)
        slot.tick();
    return std::exchange(slot.posted_, 0u) != 0;
}
const Hw_Seam seam = {waitForAny, CoreSlot<VVision>::post, CoreSlot<VVision>::nowMs};

constexpr int width = 64, height = 48, threshold = 5; // more corners than a result has room for

class VisionServant : public ::testing::Test {
protected:
    VisionServant() {
        frames = {};
        busErrorsOfRead = cornersTold = 0;
        EXPECT_EQ(Vision_Core_init(&core_, coreSlot, 0, &seam, &slot_), HW_OK);
        slot_.interrupt_ = [this] { Vision_Core_interrupt(&core_); };
        EXPECT_EQ(Autopilot_HwProcessingEngine_setParameterA(&core_.servant, threshold, nullptr),
                  ICE_OK);
    }
    void load(uint32_t at) {
        pixels_ = picture(width, height, random_);
        for (size_t i = 0; i < pixels_.size(); ++i)
            slot_.memory_.setByte(at + static_cast<uint32_t>(i), pixels_[i]);
    }
    void header(uint32_t w, uint32_t h) {
        for (uint32_t i = 0; i < 4; ++i) {
            slot_.memory_.setByte(UAV_FRAME_HEADER + i, static_cast<uint8_t>(w >> 8 * i));
            slot_.memory_.setByte(UAV_FRAME_HEADER + 4 + i, static_cast<uint8_t>(h >> 8 * i));
        }
    }
    void loadAtHeader() {
        header(width, height);
        load(UAV_FRAME);
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
    CoreSlot<VVision> slot_;
    Vision_Core core_{};
    Autopilot_ResultType result_{};
    std::vector<uint8_t> pixels_;
};

TEST_F(VisionServant, GivesTheStrongestCornersOfThePicture) {
    for (int i = 0; i < 4; ++i) {
        loadAtHeader();
        ASSERT_EQ(start(), ICE_OK);
        ASSERT_EQ(result(), ICE_OK);
        EXPECT_GT(result_.found, VISION_BEST);
        expectCorners();
    }
    EXPECT_EQ(result(), ICE_OK);
    expectCorners(); // once more
    EXPECT_EQ(Vision_Core_poll(&core_, 0), HW_NEVER);
    for (int value : {-1, 256})
        EXPECT_EQ(Autopilot_HwProcessingEngine_setParameterA(
                      &core_.servant, static_cast<Ice_Short>(value), nullptr),
                  ICE_UNKNOWN_EXCEPTION);
}

TEST_F(VisionServant, TakesTheCamerasFramesWhereThereIsOne) {
    frames = {0x01000000, 0x1000, width, height};
    auto& top = slot_.bench_.top();
    for (uint32_t buffer : {1u, 3u, 2u}) {
        load(frames.base + (buffer - 1) * frames.stride);
        ASSERT_EQ(start(), ICE_OK);
        top.frame_index_i = static_cast<uint8_t>(buffer);
        top.frame_valid_i = 1;
        ASSERT_EQ(result(), ICE_OK); // another one is offered: one frame for each start
        expectCorners();
    }
}

TEST_F(VisionServant, AFrameThatTheCoreRefusesIsAnError) {
    header(12, height);
    ASSERT_EQ(start(), ICE_OK);
    EXPECT_EQ(result(), ICE_UNKNOWN_EXCEPTION);
    loadAtHeader();
    busErrorsOfRead = 1;
    ASSERT_EQ(start(), ICE_OK);
    EXPECT_EQ(result(), ICE_UNKNOWN_EXCEPTION) << "its registers did not answer";
    busErrorsOfRead = 0;
    ASSERT_EQ(start(), ICE_OK);
    ASSERT_EQ(result(), ICE_OK);
    expectCorners();
}

TEST_F(VisionServant, AFrameThatWasGivenUpHasNoResult) {
    loadAtHeader();
    ASSERT_EQ(start(), ICE_OK);
    for (int i = 0; i < 1500; ++i)
        slot_.tick();
    slot_.memory_.hold(true);
    EXPECT_EQ(result(), ICE_TIMEOUT);
    slot_.memory_.hold(false);
    EXPECT_EQ(result(), ICE_UNKNOWN_EXCEPTION) << "half of it";
    ASSERT_EQ(start(), ICE_OK);
    ASSERT_EQ(result(), ICE_OK);
    expectCorners();
}

TEST_F(VisionServant, ACameraThatSendsNoFrameIsNotWaitedForAgain) {
    frames = {0x01000000, 0x1000, width, height};
    ASSERT_EQ(start(), ICE_OK);
    EXPECT_EQ(result(), ICE_TIMEOUT);
    frames = {};
    loadAtHeader();
    ASSERT_EQ(start(), ICE_OK);
    ASSERT_EQ(result(), ICE_OK);
    expectCorners();
}

} // namespace
