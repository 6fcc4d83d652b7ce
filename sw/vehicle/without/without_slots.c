/* SPDX-License-Identifier: MIT
 *
 * without_slots: functions for firmware without updates (ICESOC_UPDATE=OFF). The FPGA loads its
 * bitstream without help of the processor.
 */
#include "firmware_slots.h"

void Firmware_useSlots(void) {}
