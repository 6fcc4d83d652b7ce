/* SPDX-License-Identifier: MIT
 *
 * ascon_servant: Cores::Ascon (Ascon.ice) by the core in a slot. It does the processor's part:
 * buffers in DDR3, registers, the wait.
 */
#pragma once

#include "Ascon.h"
#include "hw_core.h"

#define ASCON_LIMIT 1024 /* greatest length of a message and of its associated data, bytes */

typedef struct Ascon_Core {
    Cores_Ascon servant;
    Hw_Core core;
    U32 memory; /* DDR3 byte address of the buffers */
    U8 result[ASCON_LIMIT], tag[16];
} Ascon_Core;

Hw_Status Ascon_Core_init(Ascon_Core* self, U32 slot, U32 memory, const Hw_Port* port,
                          void* context);
