/* SPDX-License-Identifier: MIT
 *
 * ascon_servant: implements Cores::Ascon (Ascon.ice) with the core in a slot. The processor's part
 * is to fill buffers in DDR3, to access registers, and to wait.
 */
#pragma once

#include "Ascon.h"
#include "hw_core.h"

#define ASCON_LIMIT 1024 /* largest length of a message, and of its associated data, bytes */

typedef struct Ascon_Core {
    Cores_Ascon servant;
    Hw_Core core;
    U32 memory; /* byte address of the buffers in DDR3 */
    U8 result[ASCON_LIMIT], tag[16];
} Ascon_Core;

Hw_Status Ascon_Core_init(Ascon_Core* self, U32 slot, U32 memory, const Hw_Port* port,
                          void* context);
