/* SPDX-License-Identifier: MIT
 *
 * fsmc: driver of the STM32F2's FSMC (RM0033, chapter 31), which connects the microcontroller to
 * the FPGA. The FPGA is at the select lines NE1 and NE2 of bank 1.
 *
 * NE1 is a 64 MiB window into DDR3. NE2 is the control space, with 64 slots of 16 words of 32 bits
 * (bus/map.regs.json). Data is 16 bits wide; a 32-bit word is two accesses, low half first.
 *
 *     if (FSMC_init(&port, 0) == FSMC_OK) {        (the chip answers)
 *         FSMC_write(slot, word, 42);
 *         value = FSMC_read(slot, word);
 *         FSMC_writeMemory(0x1000, bytes, 100);    (DDR3, any address)
 *         FSMC_readMemory(0x1000, bytes, 100);
 *     }
 *
 * Register accesses are re-entrant. Memory accesses are re-entrant as long as all of them stay in
 * one page of 64 MiB. For an address in another page the driver changes the page register; callers
 * must then use a lock.
 */
#pragma once

#include "base.h"

/* Functions with which the driver makes loads and stores. On the target they make volatile
 * accesses; on the host they access the model of the FSMC peripheral, which drives the pins of the
 * simulated FPGA. Addresses are as on the Cortex-M3: FSMC registers at 0xA0000000 (32 bits only),
 * NE1 at 0x60000000, NE2 at 0x64000000. The FSMC splits a 32-bit access to a window into two 16-bit
 * accesses, low half first, and no interrupt can occur between them. FSMC_read and FSMC_write make
 * one 32-bit access each, so tasks and interrupt routines may both use them. An 8-bit access uses
 * one byte lane. */
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
    FSMC_NO_DEVICE, /* slot 0 does not contain the system slot's ID */
    /* an access since the last check failed: its address has no target, or the target did not
     * answer in time */
    FSMC_BUS_ERROR,
    FSMC_BAD_SETTING /* invalid setting of a bank (FSMC_initBanks) */
} FSMC_Status;

/* Programs BCRx and BTRx of both banks (asynchronous mode 1, 16 bits, NWAIT) and checks the ID of
 * the system slot. `port` must stay valid. Returns FSMC_OK or FSMC_NO_DEVICE. */
FSMC_Status FSMC_init(const FSMC_Port* port, void* context);

/* Read and write a register: 32 bits, in one atomic access. slot: 0..63; word: 0..15. */
U32 FSMC_read(U32 slot, U32 word);
void FSMC_write(U32 slot, U32 word, U32 value);

/* Copy from and to DDR3: any byte address of the DDR3 chip, any length. The driver sets the page
 * register. */
void FSMC_readMemory(U32 address, U8* data, U32 bytes);
void FSMC_writeMemory(U32 address, const U8* data, U32 bytes);

/* Copy at the bridge's full speed, 24 to 30 million halfwords per second, without NWAIT. `address`
 * must be even. The copy is made in parts. After each part the driver checks the bridge's LATE
 * event; if an access was too early, the driver repeats the part with NWAIT. Returns the number of
 * halfwords in repeated parts, which is 0 unless other ports keep the memory very busy. The caller
 * must lock the DDR3 window: no other code, not even an interrupt routine, may use the window
 * during the copy. Call FSMC_setHclk first, with HCLK in Hz, at most 120 million; otherwise copying
 * is slow. */
void FSMC_setHclk(U32 hz);
U32 FSMC_streamWrite(U32 address, const U16* data, U32 halfwords);
U32 FSMC_streamRead(U32 address, U16* data, U32 halfwords);

/* Reads and clears the bridge's error event. Returns FSMC_OK, or FSMC_BUS_ERROR after an error.
 * After an error, *where (unless `where` is 0) is slot * 16 + word of the last access that failed,
 * with bit 16 set for a write. */
FSMC_Status FSMC_checkError(U32* where);

/* Settings for bridges that are built for another FSMC mode: contents of a bank's BCR, BTR and BWTR
 * (RM0033, 31.5.6). Not needed with FSMC_init. */
typedef enum FSMC_Mode {
    FSMC_MODE_1, /* SRAM mode; the same timing for reads and writes */
    FSMC_MODE_2, /* NOR mode; the same timing for reads and writes */
    FSMC_MODE_A, /* modes A to D: EXTMOD, with a separate mode and timing for writes */
    FSMC_MODE_B,
    FSMC_MODE_C,
    FSMC_MODE_D
} FSMC_Mode;

/* Timing of an access, in HCLK cycles: ADDSET 0..15, ADDHLD 1..15 (mode D and multiplexed),
 * DATAST 1..255 (at least 4 with NWAIT). */
typedef struct FSMC_Timing {
    U8 addset, addhld, datast;
} FSMC_Timing;

typedef struct FSMC_Bank {
    FSMC_Mode mode;
    FSMC_Mode writeMode; /* mode of writes, for modes A to D */
    U8 psram;            /* MTYP for modes 1 and A: 1 PSRAM, 0 SRAM */
    /* MUXEN: address bits 15..0 also use the data pins (parameter MUXED of the bridge) */
    U8 muxed;
    U8 wait;     /* ASYNCWAIT: asynchronous accesses wait for NWAIT */
    U8 waitHigh; /* WAITPOL: NWAIT is active high (parameter WAIT_HIGH of the bridge) */
    U8 busturn;  /* BUSTURN, HCLK cycles, 1..15 */
    /* timings of reads and of writes; with mode 1 or 2, `read` is used for both */
    FSMC_Timing read, write;
} FSMC_Bank;

/* Initialises the FSMC as FSMC_init does, but with these settings of NE1 and NE2. If a setting is
 * reserved or out of range, returns FSMC_BAD_SETTING without writing a register. Streams
 * (FSMC_streamRead, FSMC_streamWrite) only work with a bridge of default parameters and with the
 * settings of FSMC_init. */
FSMC_Status FSMC_initBanks(const FSMC_Port* port, void* context, const FSMC_Bank banks[2]);
