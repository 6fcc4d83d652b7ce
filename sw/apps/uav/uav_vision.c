/* SPDX-License-Identifier: MIT
 *
 * uav_vision: the servant of HwProcessingEngine: registers of the vision core through the FSMC.
 */
#include "uav_private.h"
#include "uav.h"
#include "map_regs.h"
#include "vision_regs.h"

#include <string.h>

#define FRAME_TIMEOUT_MS 5000U /* a frame takes a tenth of that; a core that takes longer hangs */

static OS_EVENT *frameDone;
static struct {
    U8 busy, refused;
    U32 frames, corners;
    Autopilot_Feature best[UAV_BEST];
    Ice_Int bestCount;
    Ice_Int found, cycles;
} vision;

static U32 get(U32 word) {
    return FSMC_read(MAP_SLOT_VISION, word);
}

static void set(U32 word, U32 value) {
    FSMC_write(MAP_SLOT_VISION, word, value);
}

void UAV_initVision(void) {
    frameDone = OSSemCreate(0);
    set(VISION_FRAME_BASE, UAV_FRAME);
    set(VISION_RESULT_BASE, UAV_RESULT);
    set(VISION_RESULT_MAX, UAV_RESULT_MAX);
    set(VISION_THRESHOLD, 24);
    set(VISION_EVENT, 0xFFFFFFFFU);
    set(VISION_MASK, VISION_MASK_DONE_MASK | VISION_MASK_REFUSED_MASK);
}

void UAV_visionInterrupt(void) {
    U32 events = get(VISION_EVENT);
    set(VISION_EVENT, events);
    vision.refused = (events & VISION_EVENT_REFUSED_MASK) != 0;
    (void)OSSemPost(frameDone);
}

U32 UAV_framesProcessed(void) {
    return vision.frames;
}

U32 UAV_cornersFound(void) {
    return vision.corners;
}

/* Strongest first; of equal ones the first in scan order first. */
static void insert(const Autopilot_Feature *f) {
    Ice_Int at = vision.bestCount;
    if (at == UAV_BEST) {
        if (f->score <= vision.best[UAV_BEST - 1].score)
            return;
        at = UAV_BEST - 1;
    } else {
        ++vision.bestCount;
    }
    for (; at > 0 && vision.best[at - 1].score < f->score; --at)
        vision.best[at] = vision.best[at - 1];
    vision.best[at] = *f;
}

static void readResults(void) {
    U32 stored = get(VISION_STORED);
    U32 i;
    vision.found = (Ice_Int)get(VISION_FOUND);
    vision.cycles = (Ice_Int)get(VISION_CYCLES);
    vision.bestCount = 0;
    for (i = 0; i < stored; ++i) {
        U8 record[VISION_RECORD_BYTES];
        Autopilot_Feature f;
        FSMC_readMemory(UAV_RESULT + i * VISION_RECORD_BYTES, record, VISION_RECORD_BYTES);
        f.x = (Ice_Short)(record[0] | (U32)record[1] << 8);
        f.y = (Ice_Short)(record[2] | (U32)record[3] << 8);
        f.score = (Ice_Int)(record[4] | (U32)record[5] << 8);
        insert(&f);
    }
    ++vision.frames;
    vision.corners += (U32)vision.found;
}

/* Waits for the frame under way, if there is one. */
static Ice_Status finishFrame(void) {
    INT8U error;
    U32 errorsBefore = UAV_busErrors();
    if (!vision.busy)
        return ICE_OK;
    OSSemPend(frameDone, FRAME_TIMEOUT_MS * OS_TICKS_PER_SEC / 1000U, &error);
    if (error != OS_ERR_NONE) {
        set(VISION_CONTROL, VISION_CONTROL_ABORT_MASK);
        return ICE_TIMEOUT;
    }
    vision.busy = 0;
    if (vision.refused)
        return ICE_UNKNOWN_EXCEPTION;
    readResults();
    if (UAV_busErrors() != errorsBefore)
        return ICE_UNKNOWN_EXCEPTION; /* the core hangs: what was read is nothing */
    (void)OSSemPost(uav_report);
    return ICE_OK;
}

Ice_Status Autopilot_HwProcessingEngine_setParameterA(Autopilot_HwProcessingEnginePtr self, Ice_Short value,
                                                      const Ice_Current *current) {
    (void)self;
    (void)current;
    if (value < 0 || value > 255)
        return ICE_UNKNOWN_EXCEPTION;
    set(VISION_THRESHOLD, (U32)value);
    return ICE_OK;
}

Ice_Status Autopilot_HwProcessingEngine_startProcessing(Autopilot_HwProcessingEnginePtr self,
                                                        const Ice_Current *current) {
    U8 size[8];
    Ice_Status status = finishFrame();
    (void)self;
    (void)current;
    if (status == ICE_TIMEOUT)
        return status;
    FSMC_readMemory(UAV_FRAME_HEADER, size, sizeof size);
    set(VISION_FRAME_SIZE, (U32)size[0] | (U32)size[1] << 8 | (U32)size[4] << 16 | (U32)size[5] << 24);
    vision.busy = 1;
    set(VISION_CONTROL, VISION_CONTROL_START_MASK);
    return ICE_OK;
}

Ice_Status Autopilot_HwProcessingEngine_getResult(Autopilot_HwProcessingEnginePtr self,
                                                  Autopilot_ResultType *res, const Ice_Current *current) {
    Ice_Status status = finishFrame();
    (void)self;
    (void)current;
    if (status != ICE_OK)
        return status;
    res->found = vision.found;
    res->cycles = vision.cycles;
    res->best.size = vision.bestCount;
    res->best.data = vision.best;
    return ICE_OK;
}
