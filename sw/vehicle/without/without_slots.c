/* SPDX-License-Identifier: MIT
 *
 * without_slots: firmware without updates (ICESOC_UPDATE=OFF). The FPGA loads its bitstream by
 * itself.
 */
#include "firmware_slots.h"

void Firmware_useSlots(void) {}
