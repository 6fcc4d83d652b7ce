/* SPDX-License-Identifier: MIT
 *
 * uav_update: the functions of the board for new firmware and bitstreams over the air.
 */
#pragma once

#include "icec.h"
#include "slots.h"

/* The images that can be updated: the firmware (object "update") and the bitstream (object
 * "fpga"). */
typedef enum UAV_Updatable { UAV_FIRMWARE, UAV_BITSTREAM, UAV_UPDATABLES } UAV_Updatable;

/* An image that can be updated. `slots` is its flash; 0 (initially) means that it is not updated
 * over the air. `running` is the slot in use, `product` the kind of vehicle. */
typedef struct UAV_Update {
    const Slots_Port* slots;
    U32 running, product;
} UAV_Update;
extern UAV_Update uav_update[UAV_UPDATABLES];

/* Adds the servants that receive new images, for each image that has slots. Does nothing in
 * firmware without the update package. */
void UAV_startUpdate(Ice_ObjectAdapterPtr adapter);

/* Resets the processor. */
extern void (*uav_restart)(void);
