/* SPDX-License-Identifier: MIT
 *
 * fpga: loads the FPGA from its configuration flash. The FPGA and the processor share this flash;
 * the pins PROGRAM_B and DONE control the load (docs/firmware.md).
 */
#pragma once

#include "slots.h"

/* Returns the slots of bitstreams in the FPGA's flash; 0 without such a flash. Makes the FPGA
 * load a bitstream and waits for DONE before it returns. With `mayTry`, a new bitstream is loaded
 * if there is one. If the new bitstream was tried before and not confirmed, or if the FPGA does not
 * accept it, the golden bitstream is loaded. With `mustLoad`, the FPGA loads its bitstream again,
 * so that its reads of the flash can be observed. The FPGA stays cleared until a bitstream was
 * found that is complete and correctly signed; other bitstreams are refused. If the golden
 * bitstream is refused as well, the FPGA remains empty. Sets `running` to the slot of the bitstream
 * in the FPGA. */
const Slots_Port* Fpga_slots(const Slots_Port* firmware, int mustLoad, int mayTry, U32* running);
