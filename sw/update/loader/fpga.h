/* SPDX-License-Identifier: MIT
 *
 * fpga: loads the FPGA from its configuration flash. The FPGA and the processor share this flash;
 * the pins PROGRAM_B and DONE control the load (docs/firmware.md).
 */
#pragma once

#include "slots.h"

/* Returns the slots of bitstreams in the flash, or 0 without such a flash. Before it returns, the
 * FPGA loads a bitstream, and its pin DONE is awaited. With `mayTry` this is a new bitstream, if
 * there is one; the golden bitstream is loaded if the new one was not confirmed or not accepted.
 * With `mustLoad` the FPGA loads its bitstream again, so that its reads of the flash can be
 * observed. The FPGA is kept empty until a bitstream is found complete and its signature correct;
 * others are refused. If the golden bitstream is refused, the FPGA stays empty. `running` is set to
 * the slot of the bitstream that the FPGA runs. */
const Slots_Port* Fpga_slots(const Slots_Port* firmware, int mustLoad, int mayTry, U32* running);
