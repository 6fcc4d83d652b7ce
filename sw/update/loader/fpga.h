/* SPDX-License-Identifier: MIT
 *
 * fpga: the FPGA's configuration flash, which it shares with the processor, and its pins PROGRAM_B
 * and DONE (docs/firmware.md).
 */
#pragma once

#include "slots.h"

/* Returns the slots of bitstreams, or 0 without such a flash. Before that, the FPGA loads a
 * new bitstream (with `mayTry`), or the golden one if the new one was not confirmed or not
 * accepted, and DONE is awaited. With `mustLoad` the FPGA loads its bitstream again, so that its
 * reads are received. Before each load the FPGA is held empty until the bitstream was found signed
 * and complete. Another one is refused; if the golden one is refused, the FPGA stays empty.
 * `running` is set to the slot of the bitstream that the FPGA runs. */
const Slots_Port* Fpga_slots(const Slots_Port* firmware, int mustLoad, int mayTry, U32* running);
