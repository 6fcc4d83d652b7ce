/* SPDX-License-Identifier: MIT
 *
 * firmware_slots: finds the flash slots of firmware and bitstream. In firmware without updates over
 * the air, without/without_slots.c replaces firmware_slots.c.
 */
#pragma once

/* Finds the slots, passes them to uav_update, and makes the FPGA load its bitstream. */
void Firmware_useSlots(void);
