/* SPDX-License-Identifier: MIT
 *
 * fpga: the FPGA's configuration flash, which it shares with the processor, and its pins PROGRAM_B
 * and DONE (docs/update.md).
 */
#ifndef FPGA_H
#define FPGA_H

#include "slots.h"

#define FPGA_PRODUCT 0x31475046UL /* "FPG1" */

/* Returns the slots of bitstreams, with the checks of the firmware's; 0: there is no such flash.
 * Before that it has the FPGA load a bitstream that is new, or the golden one in place of one that
 * was not confirmed, and waits for DONE. `running` becomes the slot of what the FPGA should run. */
const Slots_Port* Fpga_slots(const Slots_Port* firmware, U32* running);

#endif
