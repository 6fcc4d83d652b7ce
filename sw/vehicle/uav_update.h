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

/* An image that can be updated. `slots`: the flash with its slots; 0 (the initial value) means that
 * this image is not updated over the air. `running`: slot in use. `product`: kind of vehicle. */
typedef struct UAV_Update {
    const Slots_Port* slots;
    U32 running, product;
} UAV_Update;
extern UAV_Update uav_update[UAV_UPDATABLES];

/* For each image that has slots, adds the servant that receives new images. Does nothing in
 * firmware without the update package. */
void UAV_startUpdate(Ice_ObjectAdapterPtr adapter);

/* Restarts the processor. */
extern void (*uav_restart)(void);
