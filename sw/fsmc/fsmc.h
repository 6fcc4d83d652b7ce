/* SPDX-License-Identifier: MIT
 *
 * fsmc: driver of the STM32F2's FSMC (RM0033, chapter 31) for the FPGA on bank 1, NE1 and NE2.
 *
 * NE1 is a 64 MiB window into DDR3, NE2 the control space of 64 slots with 16 words of 32 bits
 * each (bus/map.regs.json). Data is 16 bits wide; a 32-bit word is two accesses, low half first.
 *
 *     if (FSMC_init(&port, 0) == FSMC_OK) {        (the chip answers)
 *         FSMC_write(slot, word, 42);
 *         value = FSMC_read(slot, word);
 *         FSMC_writeMemory(0x1000, bytes, 100);    (DDR3, any address)
 *         FSMC_readMemory(0x1000, bytes, 100);
 *     }
 *
 * Register accesses are re-entrant. Memory accesses are re-entrant as long as all of them stay in
 * one page of 64 MiB (the driver moves the page register where one does not): else the callers
 * lock.
 */
#pragma once

#include "base.h"

/* Loads and stores of the processor, which the driver needs. On the target they are volatile
 * accesses; on the host they go to the model of the FSMC peripheral and from there to the pins of
 * the RTL. Addresses are the Cortex-M3's: FSMC registers at 0xA0000000 (32 bits only), NE1 at
 * 0x60000000, NE2 at 0x64000000. The FSMC splits a 32-bit access to a window into two 16-bit
 * accesses, low half first, without an interrupt between them. FSMC_read and FSMC_write are one
 * such access each, so tasks and interrupt routines may both use them. An 8-bit access uses one
 * byte lane.
 */
typedef struct FSMC_Port {
    U8 (*read8)(void* context, U32 address);
    void (*write8)(void* context, U32 address, U8 value);
    U16 (*read16)(void* context, U32 address);
    void (*write16)(void* context, U32 address, U16 value);
    U32 (*read32)(void* context, U32 address);
    void (*write32)(void* context, U32 address, U32 value);
} FSMC_Port;

typedef enum FSMC_Status {
    FSMC_OK = 0,
    FSMC_NO_DEVICE,  /* slot 0 does not contain the system slot's ID */
    FSMC_BUS_ERROR,  /* an access since the last check had no target, or timed out */
    FSMC_BAD_SETTING /* invalid setting of a bank (FSMC_initBanks) */
} FSMC_Status;

/* Programs BCRx and BTRx of both banks (asynchronous mode 1, 16 bits, NWAIT) and looks for the
 * system slot. `port` must stay valid. Returns FSMC_OK or FSMC_NO_DEVICE. */
FSMC_Status FSMC_init(const FSMC_Port* port, void* context);

/* Read and write a register: 32 bits, atomic. slot 0..63, word 0..15. */
U32 FSMC_read(U32 slot, U32 word);
void FSMC_write(U32 slot, U32 word, U32 value);

/* Copy from and to DDR3: any byte address of the chip (the page register follows), any length. */
void FSMC_readMemory(U32 address, U8* data, U32 bytes);
void FSMC_writeMemory(U32 address, const U8* data, U32 bytes);

/* Copy at the bridge's full speed, 24 to 30 million halfwords per second, without NWAIT. `address`
 * is even. The bridge's LATE event checks each part, and a part that was too early is repeated with
 * NWAIT. Returns the number of repeated halfwords (0 unless others keep the memory very busy). The
 * caller must lock the DDR3 window: no other code may use it meanwhile, not even interrupt
 * routines. Call FSMC_setHclk first (otherwise copying is slow): HCLK in Hz, at most 120
 * million. */
void FSMC_setHclk(U32 hz);
U32 FSMC_streamWrite(U32 address, const U16* data, U32 halfwords);
U32 FSMC_streamRead(U32 address, U16* data, U32 halfwords);

/* Reads and clears the bridge's error event. Returns FSMC_OK, or FSMC_BUS_ERROR: then `where`, if
 * not 0, becomes slot * 16 + word of the last such access, with bit 16 set for a write. */
FSMC_Status FSMC_checkError(U32* where);

/* Other modes, for bridges that are built for them: contents of a bank's BCR, BTR and BWTR (RM0033,
 * 31.5.6). Not needed with FSMC_init. */
typedef enum FSMC_Mode {
    FSMC_MODE_1, /* SRAM: read and write alike */
    FSMC_MODE_2, /* NOR: read and write alike */
    FSMC_MODE_A, /* A to D: EXTMOD, with separate mode and times for writes */
    FSMC_MODE_B,
    FSMC_MODE_C,
    FSMC_MODE_D
} FSMC_Mode;

/* Times of an access in HCLK: ADDSET 0..15, ADDHLD 1..15 (mode D and multiplexed), DATAST 1..255 (4
 * at least with NWAIT). */
typedef struct FSMC_Timing {
    U8 addset, addhld, datast;
} FSMC_Timing;

typedef struct FSMC_Bank {
    FSMC_Mode mode;
    FSMC_Mode writeMode;     /* for modes A to D */
    U8 psram;                /* MTYP for modes 1 and A: 1 PSRAM, 0 SRAM */
    U8 muxed;                /* MUXEN: address bits 15..0 on the data pins (the bridge's MUXED) */
    U8 wait;                 /* ASYNCWAIT: asynchronous accesses look at NWAIT */
    U8 waitHigh;             /* WAITPOL: NWAIT is active high (WAIT_HIGH) */
    U8 busturn;              /* BUSTURN, HCLK, 1..15 */
    FSMC_Timing read, write; /* modes 1 and 2: only `read`, for both */
} FSMC_Bank;

/* Initialises like FSMC_init, but with these settings of NE1 and NE2. Returns FSMC_BAD_SETTING, and
 * writes nothing, if a setting is reserved or out of range. Streams (FSMC_streamRead,
 * FSMC_streamWrite) only work with the plain bridge and the settings of FSMC_init. */
FSMC_Status FSMC_initBanks(const FSMC_Port* port, void* context, const FSMC_Bank banks[2]);
