/* SPDX-License-Identifier: MIT
 *
 * firmware: the program: kernel, application, watchdog task, and the vehicle's keys. The
 * differences between kernels are in own_kernel.c and ucos2/.
 */
#pragma once

#include "uav_keys.h"
#include "ucos_ii.h"

/* Finds the slots of firmware and bitstream and gives them to uav_update; has the FPGA load its
 * bitstream. */
void Firmware_useSlots(void);

/* Returns at once without a break on the port. Otherwise reports whether read protection is off,
 * and waits ten seconds for a line: "key" and 32 hexadecimal digits, or "open", and the vehicle's
 * address as four digits (UAV_provide); or "ground" or "fellow", its address and, unless the
 * vehicle is open, its key (UAV_providePeer). If a key is set, append a present one's digits, or
 * connect PC2 to ground. "protect" sets read protection. */
void Provision_listen(void);

/* Random number generator, and the first words of the backup SRAM; the context is not used. */
extern const UAV_Board secrets_board;
/* Starts both; needs the clocks of Board_start. */
void Secrets_start(void);
