/* SPDX-License-Identifier: MIT
 *
 * bus: tests the FSMC bus, the DDR3 memory, the interrupt and the modem, after the chip was loaded
 * into the FPGA. Until the timing of the bus has been tested, accesses are slow and do not use
 * NWAIT, so no access can hang.
 */
#pragma once

#include "base.h"

/* Connects the pins to the FSMC with slow timing. Returns 1 if the chip's system slot answers. */
int Bus_start(void);

/* Returns 1 if each read returns the halfword that the previous read should have returned. */
int Bus_isShifted(void);

/* The steps. */
void Bus_testWrites(void); /* tests writes and the edge of NWE at several frequencies of HCLK */
/* tests each data line at a register, and each address line of the registers */
void Bus_testData(void);
int Bus_testMemory(void); /* tests the DDR3 memory; returns 1 if it works */
/* measures the margins of NOE, NE1, NE2 and NWAIT, ns; needs the memory */
void Bus_testTiming(void);
void Bus_testInterrupt(void);
void Bus_testModem(void);

/* Functions for bus accesses, used by all files that contain these steps. */
typedef struct Bus_Timing {
    U32 addset, datast; /* HCLK cycles */
    int isModeA;        /* 1 if NOE falls after the address phase */
    int waits;          /* 1 if the access waits for NWAIT */
    U32 addhld;         /* HCLK cycles, at least 1; only used with BOARD_MUXED */
} Bus_Timing;

void Bus_set(U32 bank, const Bus_Timing* timing);
void Bus_setSlow(void); /* both banks */
U32 Bus_read(U32 slot, U32 word);
void Bus_write(U32 slot, U32 word, U32 value);
/* Read and write a halfword or a byte of the DDR3 memory. `address` is its byte address. */
U16 Bus_load(U32 address);
void Bus_store(U32 address, U16 value);
void Bus_storeByte(U32 address, U8 value);
