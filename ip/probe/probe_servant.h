/* SPDX-License-Identifier: MIT
 *
 * probe_servant: implements Probes::Probe (Probe.ice) with the probe core in a slot.
 */
#pragma once

#include "Probe.h"
#include "hw_core.h"

#define PROBE_READ_BYTES 4096 /* largest number of bytes in a reply */

typedef struct Probe_Core {
    Probes_Probe servant;
    Hw_Core core;
    Ice_Byte bytes[PROBE_READ_BYTES];
} Probe_Core;

Hw_Status Probe_Core_init(Probe_Core* self, U32 slot, U32 memory, const Hw_Port* port,
                          void* context);
