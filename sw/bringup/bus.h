/* SPDX-License-Identifier: MIT
 *
 * bus: tests the FSMC bus, the DDR3 memory, the interrupt and the modem, with the FPGA loaded with
 * the chip. Until the bus timing itself is tested, accesses are slow and do not use NWAIT, so that
 * none can hang.
 */
#pragma once

#include "base.h"

/* Switches the lines to the FSMC with slow timing. Returns 1 if the chip's system slot answers. */
int Bus_start(void);

/* The steps. */
void Bus_testWrites(void); /* writes at several HCLK: the edge of NWE */
void Bus_testData(void);   /* a register: each data line, each address line of registers */
int Bus_testMemory(void);  /* DDR3; returns 1 if it works */
void Bus_testTiming(void); /* NOE, NE1, NE2, NWAIT: margins in ns; needs the memory */
void Bus_testInterrupt(void);
void Bus_testModem(void);

/* Accesses; shared by the files of these steps. */
typedef struct Bus_Timing {
    U32 addset, datast; /* HCLK cycles */
    int isModeA;        /* NOE falls after the address phase */
    int waits;          /* the access waits for NWAIT */
} Bus_Timing;

void Bus_set(U32 bank, const Bus_Timing* timing);
void Bus_setSlow(void); /* both banks */
U32 Bus_read(U32 slot, U32 word);
void Bus_write(U32 slot, U32 word, U32 value);
/* Halfwords of DDR3 by their byte address. */
U16 Bus_load(U32 address);
void Bus_store(U32 address, U16 value);
void Bus_storeByte(U32 address, U8 value);
