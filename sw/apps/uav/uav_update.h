/* SPDX-License-Identifier: MIT
 *
 * uav_update: what new firmware, and new bitstreams, over the air need of the board.
 */
#ifndef UAV_UPDATE_H
#define UAV_UPDATE_H

#include "slots.h"

/* The images that can be renewed: firmware, the object "update", and bitstream, "fpga". */
typedef enum UAV_Updatable { UAV_FIRMWARE, UAV_BITSTREAM, UAV_UPDATABLES } UAV_Updatable;

/* The flash of each, 0 as at first: it does not come over the air; which slot runs, and for which
 * kind of vehicle it is. */
typedef struct UAV_Update {
    const Slots_Port* slots;
    U32 running, product;
} UAV_Update;
extern UAV_Update uav_update[UAV_UPDATABLES];

/* Starts the processor anew. */
extern void (*uav_restart)(void);

#endif
