/* SPDX-License-Identifier: MIT
 *
 * hw_registers: implements the interface Hw::Registers (Registers.ice) with the registers of a core
 * in a slot. It has the same structure as the servants that slice2c generates (docs/hw-mapping.md).
 * The register table is <BLOCK>_TABLE of <block>_regs.h.
 */
#pragma once

#include "Registers.h"
#include "hw_core.h"

#define HW_REGISTERS_EVENTS 32

typedef struct Hw_Registers_Core {
    Hw_Registers servant;
    U32 slot; /* 0..63 */
    const Hw_Port* port;
    void* context;
    const Hw_Register* table;
    Ice_Int count;
    volatile U8 came;  /* 1 after an event of the slot; the interrupt routine sets it */
    volatile U8 waits; /* 1 while a call of `wait` has no reply yet */
    U32 deadline;      /* time at which the call of `wait` times out, ms */
    Ice_Reply reply;
    Ice_String events[HW_REGISTERS_EVENTS]; /* names of the events in the reply to `wait` */
    char reason[400];                       /* text of the last exception */
} Hw_Registers_Core;

/* Initialises a servant: clears and masks the events of the slot. `id` is the expected value of the
 * word ID; returns HW_WRONG_CORE if the word has another value. */
Hw_Status Hw_Registers_Core_init(Hw_Registers_Core* self, U32 slot, U32 id,
                                 const Hw_Register* table, Ice_Int count, const Hw_Port* port,
                                 void* context);
void Hw_Registers_Core_interrupt(Hw_Registers_Core* self);
U32 Hw_Registers_Core_poll(Hw_Registers_Core* self, U32 nowMs);

/* Compare the registers of the chip with those for which the firmware was built. One hash per slot
 * represents its registers; SYSTEM.CONTRACT returns the hash (docs/bus.md).
 * Hw_Contracts_read copies the `count` entries of `built` to `found` and adds the hashes of the
 * chip. Hw_Contracts_hold returns 1 if the slot is in the list and its two hashes are equal. */
void Hw_Contracts_read(Hw_Contract* found, const Hw_Contract* built, U32 count);
int Hw_Contracts_hold(const Hw_Contract* found, U32 count, U32 slot);
