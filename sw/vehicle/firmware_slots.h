/* SPDX-License-Identifier: MIT
 *
 * firmware_slots: the flash slots of firmware and bitstream. Firmware without updates over the air
 * has without/without_slots.c in place of firmware_slots.c.
 */
#pragma once

/* Finds the slots, gives them to uav_update, and has the FPGA load its bitstream. */
void Firmware_useSlots(void);
