/* SPDX-License-Identifier: MIT
 *
 * hw_instance: the table of the chip's cores and their servants, which is generated from
 * ip/cores.list (soc_cores.c).
 */
#pragma once

#include "Registers.h"
#include "hw_core.h"
#include "map_regs.h"

typedef struct Hw_Instance {
    const char* identity; /* 0 marks the end of the table */
    U32 slot;             /* 2..63 */
    Ice_ObjectPtr servant;
    Hw_Status (*start)(const Hw_Port* port, void* context);
    void (*interrupt)(void);
    /* Replies to calls that have ended or timed out. Returns the time until this function must
     * be called again even if no event has occurred, ms; HW_NEVER if no call is in
     * progress. */
    U32 (*poll)(U32 nowMs);
} Hw_Instance;

extern const Hw_Instance hw_instances[];

/* Hashes of the registers for which the firmware was built, one entry per slot. The member `chip`
 * of each entry is 0. */
extern const Hw_Contract hw_contracts[MAP_CONTRACTS];
