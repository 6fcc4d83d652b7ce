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
 * was not confirmed or that the FPGA did not take, and waits for DONE. `isPowerOn`: the FPGA loads
 * what it has once more, to be listened to. `running` becomes the slot of what the FPGA runs. */
const Slots_Port* Fpga_slots(const Slots_Port* firmware, int isPowerOn, U32* running);

#endif
