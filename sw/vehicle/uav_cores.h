/* SPDX-License-Identifier: MIT
 *
 * uav_cores: the servants of the FPGA's cores, and the task that completes calls that take time.
 */
#pragma once

#include "icec.h"

void UAV_initCores(void);
void UAV_startCores(Ice_ObjectAdapterPtr adapter);
void UAV_coresTask(void* argument);

/* Handles interrupts of the cores. `lines` has one bit for each slot with a pending interrupt:
 * slots 0..31, then slots 32..63. */
void UAV_coresInterrupt(const U32 lines[2]);

/* Waits until the vision core has processed a frame. Returns the number of frames processed so far,
 * and sets `corners` to the total number of their corners. */
U32 UAV_waitFrame(U32* corners);
