/* SPDX-License-Identifier: MIT
 *
 * vision_servant: implements HwProcessingEngine (sw/vehicle/Autopilot.ice) with the vision core in
 * a slot. It offers the same functions as a generated servant (docs/hw-mapping.md).
 */
#pragma once

#include "Autopilot.h"
#include "hw_core.h"

#define VISION_BEST 64 /* largest number of features in a result, as in Autopilot.ice */

typedef struct Vision_Core {
    Autopilot_HwProcessingEngine servant;
    Hw_Core core;
    U8 busy; /* 1 if a frame was started and its result has not been read */
    Ice_Int found, cycles, bestCount;
    Autopilot_Feature best[VISION_BEST];
} Vision_Core;

Hw_Status Vision_Core_init(Vision_Core* self, U32 slot, U32 memory, const Hw_Port* port,
                           void* context);
void Vision_Core_interrupt(Vision_Core* self);
U32 Vision_Core_poll(Vision_Core* self, U32 nowMs);
