/* SPDX-License-Identifier: MIT
 *
 * vision_servant: implements HwProcessingEngine with the registers of the vision core, which it
 * accesses through the FSMC.
 */
#include "vision_servant.h"
#include "fsmc.h"
#include "vision_regs.h"

#define FRAME_TIMEOUT_MS                                                     \
    5000U /* ten times the duration of a frame; a core that takes longer has \
           * hung */

enum { DONE, REFUSED }; /* events */

static U32 get(const Vision_Core* self, U32 word) {
    return FSMC_read(self->core.slot, word);
}

static void set(const Vision_Core* self, U32 word, U32 value) {
    FSMC_write(self->core.slot, word, value);
}

Hw_Status Vision_Core_init(Vision_Core* self, U32 slot, U32 memory, const Hw_Port* port,
                           void* context) {
    Hw_Status status = Hw_Core_init(&self->core, slot, VISION_ID_VALUE, port, context);
    self->busy = 0;
    self->core.memory = memory;
    if (status != HW_OK)
        return status;
    Autopilot_HwProcessingEngine_init(&self->servant);
    set(self, VISION_RESULT_BASE, memory);
    set(self, VISION_RESULT_MAX, VISION_RECORDS);
    set(self, VISION_THRESHOLD, 24);
    return HW_OK;
}

void Vision_Core_interrupt(Vision_Core* self) {
    set(self, VISION_MODE,
        /* Stops following the camera after one frame, because a further frame would overwrite these
         * records. */
        0);
    Hw_Core_interrupt(&self->core);
}

U32 Vision_Core_poll(Vision_Core* self, U32 nowMs) {
    (void)self;
    (void)nowMs;
    return HW_NEVER;
}

/* Inserts a corner into the list, which is sorted by strength, strongest first. Corners of equal
 * strength stay in scan order. */
static void insert(Vision_Core* self, const Autopilot_Feature* f) {
    Ice_Int at = self->bestCount;
    if (at == VISION_BEST) {
        if (f->score <= self->best[VISION_BEST - 1].score)
            return;
        at = VISION_BEST - 1;
    } else {
        ++self->bestCount;
    }
    for (; at > 0 && self->best[at - 1].score < f->score; --at)
        self->best[at] = self->best[at - 1];
    self->best[at] = *f;
}

static void readResults(Vision_Core* self) {
    U32 stored = get(self, VISION_STORED);
    U32 i;
    self->found = (Ice_Int)get(self, VISION_FOUND);
    self->cycles = (Ice_Int)get(self, VISION_CYCLES);
    self->bestCount = 0;
    for (i = 0; i < stored; ++i) {
        U8 record[VISION_RECORD_BYTES];
        Autopilot_Feature f;
        FSMC_readMemory(self->core.memory + i * VISION_RECORD_BYTES, record, VISION_RECORD_BYTES);
        f.x = (Ice_Short)(record[0] | (U32)record[1] << 8);
        f.y = (Ice_Short)(record[2] | (U32)record[3] << 8);
        f.score = (Ice_Int)(record[4] | (U32)record[5] << 8);
        insert(self, &f);
    }
}

/* Waits until the frame that is being processed has ended, if there is such a frame. */
static Ice_Status finishFrame(Vision_Core* self) {
    const Hw_Port* port = self->core.port;
    U32 errorsBefore = port->busErrors(self->core.context);
    if (!self->busy)
        return ICE_OK;
    while (!self->core.done[DONE] && !self->core.done[REFUSED])
        if (!port->wait(self->core.context, DONE, FRAME_TIMEOUT_MS) && !self->core.done[DONE] &&
            !self->core.done[REFUSED]) {
            set(self, VISION_MODE, 0);
            set(self, VISION_CONTROL, VISION_CONTROL_ABORT_MASK);
            /* If the core hangs, it stays busy. If it only waits for a frame of the camera, the
             * abort makes it idle. */
            self->busy = (get(self, VISION_STATUS) & VISION_STATUS_BUSY_MASK) != 0;
            return ICE_TIMEOUT;
        }
    self->busy = 0;
    if (self->core.done[REFUSED] || (get(self, VISION_STATUS) & VISION_STATUS_ABORTED_MASK))
        return ICE_UNKNOWN_EXCEPTION;
    readResults(self);
    if (port->busErrors(self->core.context) != errorsBefore)
        return ICE_UNKNOWN_EXCEPTION; /* the core hangs, so the result is invalid */
    port->frames->processed((U32)self->found);
    return ICE_OK;
}

Ice_Status Autopilot_HwProcessingEngine_setParameterA(Autopilot_HwProcessingEnginePtr servant,
                                                      Ice_Short value, const Ice_Current* current) {
    if (value < 0 || value > 255)
        return Ice_Current_refuse(current, "value: expected 0 to 255");
    set((Vision_Core*)servant, VISION_THRESHOLD, (U32)value);
    return ICE_OK;
}

Ice_Status Autopilot_HwProcessingEngine_startProcessing(Autopilot_HwProcessingEnginePtr servant,
                                                        const Ice_Current* current) {
    Vision_Core* self = (Vision_Core*)servant;
    const Hw_Frames* frames = self->core.port->frames;
    Ice_Status status = finishFrame(self);
    (void)current;
    if (status == ICE_TIMEOUT)
        return status;
    self->busy = 1;
    self->core.done[DONE] = 0;
    self->core.done[REFUSED] = 0;
    if (frames->width != 0U) {
        set(self, VISION_FRAME_SIZE, frames->height << 16 | frames->width);
        set(self, VISION_FRAME_BASE, frames->base);
        set(self, VISION_FRAME_STRIDE, frames->stride);
        set(self, VISION_MODE, VISION_MODE_FOLLOW_MASK);
    } else {
        U8 size[8];
        FSMC_readMemory(frames->pictureSize, size, sizeof size);
        set(self, VISION_FRAME_SIZE,
            (U32)size[0] | (U32)size[1] << 8 | (U32)size[4] << 16 | (U32)size[5] << 24);
        set(self, VISION_FRAME_BASE, frames->picture);
        set(self, VISION_CONTROL, VISION_CONTROL_START_MASK);
    }
    return ICE_OK;
}

Ice_Status Autopilot_HwProcessingEngine_getResult(Autopilot_HwProcessingEnginePtr servant,
                                                  Autopilot_ResultType* res,
                                                  const Ice_Current* current) {
    Vision_Core* self = (Vision_Core*)servant;
    Ice_Status status = finishFrame(self);
    (void)current;
    if (status != ICE_OK)
        return status;
    res->found = self->found;
    res->cycles = self->cycles;
    res->best.size = self->bestCount;
    res->best.data = self->best;
    return ICE_OK;
}
