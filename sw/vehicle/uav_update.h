/* SPDX-License-Identifier: MIT
 *
 * uav_update: the board's part in new firmware and bitstreams over the air.
 */
#pragma once

#include "icec.h"
#include "slots.h"

/* The images that can be renewed: firmware (object "update") and bitstream (object "fpga"). */
typedef enum UAV_Updatable { UAV_FIRMWARE, UAV_BITSTREAM, UAV_UPDATABLES } UAV_Updatable;

/* Flash of the firmware and of the FPGA; 0, the initial value: not updated over the air. `running`
 * is the slot that runs, `product` the kind of vehicle. */
typedef struct UAV_Update {
    const Slots_Port* slots;
    U32 running, product;
} UAV_Update;
extern UAV_Update uav_update[UAV_UPDATABLES];

/* Serves new images, if there are slots for them; none in firmware without updates. */
void UAV_startUpdate(Ice_ObjectAdapterPtr adapter);

/* Resets the processor. */
extern void (*uav_restart)(void);
