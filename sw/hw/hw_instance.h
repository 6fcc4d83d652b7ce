/* SPDX-License-Identifier: MIT
 *
 * hw_instance: the chip's cores with their servants; the table is generated from ip/cores.list
 * (soc_cores.c).
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
    /* Answers calls that are done or late. Returns the time to the next call without an event, ms,
     * or HW_NEVER. */
    U32 (*poll)(U32 nowMs);
} Hw_Instance;

extern const Hw_Instance hw_instances[];

/* The hashes of the registers that the firmware was built with, a line a slot; `chip` is 0. */
extern const Hw_Contract hw_contracts[MAP_CONTRACTS];
