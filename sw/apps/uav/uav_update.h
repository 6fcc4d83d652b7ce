/* SPDX-License-Identifier: MIT
 *
 * uav_update: what new firmware over the air needs of the board.
 */
#ifndef UAV_UPDATE_H
#define UAV_UPDATE_H

#include "slots.h"

/* The slots of firmware in flash, which of them runs, the kind of vehicle, and what starts the
 * processor anew; 0, as at first: new firmware does not come over the air. */
extern const Slots_Port* uav_slots;
extern U32 uav_slot, uav_product;
extern void (*uav_restart)(void);

#endif
