/* SPDX-License-Identifier: MIT
 *
 * without_slots: the firmware without updates (ICESOC_UPDATE=OFF): the FPGA loads its bitstream by
 * itself.
 */
#include "firmware_slots.h"

void Firmware_useSlots(void) {}
