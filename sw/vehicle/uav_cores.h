/* SPDX-License-Identifier: MIT
 *
 * uav_cores: the servants of the FPGA's cores, and the task that answers calls which take time.
 */
#pragma once

#include "icec.h"

void UAV_initCores(void);
void UAV_startCores(Ice_ObjectAdapterPtr adapter);
void UAV_coresTask(void* argument);

/* Handles interrupts of the cores; `lines`: interrupt lines of slots 0..31 and 32..63. */
void UAV_coresInterrupt(const U32 lines[2]);

/* Waits for a processed frame. Returns the number of frames, and the sum of their corners. */
U32 UAV_waitFrame(U32* corners);
