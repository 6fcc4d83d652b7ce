/* SPDX-License-Identifier: MIT
 *
 * hw_registers: Hw::Registers (Registers.ice) by the registers of a core in a slot; shaped as
 * slice2c's servants are (docs/hw-mapping.md). The table is <BLOCK>_TABLE of <block>_regs.h.
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
    volatile U8 came;  /* set by the interrupt: the slot has an event */
    volatile U8 waits; /* a call of wait is pending */
    U32 deadline;      /* ms, of that call */
    Ice_Reply reply;
    Ice_String events[HW_REGISTERS_EVENTS]; /* names in the answer of `wait` */
    char reason[400];                       /* text of the last exception */
} Hw_Registers_Core;

/* Initialises a servant: clears and masks the slot's events. `id` is the expected value of word ID;
 * if it differs, returns HW_WRONG_CORE. */
Hw_Status Hw_Registers_Core_init(Hw_Registers_Core* self, U32 slot, U32 id,
                                 const Hw_Register* table, Ice_Int count, const Hw_Port* port,
                                 void* context);
void Hw_Registers_Core_interrupt(Hw_Registers_Core* self);
U32 Hw_Registers_Core_poll(Hw_Registers_Core* self, U32 nowMs);

/* Compare the chip registers with those that the firmware was built for, by each slot's hash,
 * SYSTEM.CONTRACT (docs/bus.md). read: fills `found` with the `count` lines of `built`, and with
 * the hashes from the chip. hold: returns 1 if the slot is in the list, and both hashes agree. */
void Hw_Contracts_read(Hw_Contract* found, const Hw_Contract* built, U32 count);
int Hw_Contracts_hold(const Hw_Contract* found, U32 count, U32 slot);
