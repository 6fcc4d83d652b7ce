/* SPDX-License-Identifier: MIT
 *
 * fsmc_bank: the FSMC's other modes by name, for bridges that are built for them: contents of a
 * bank's BCR, BTR and BWTR (RM0033, 31.5.6). FSMC_init needs none of this.
 */
#pragma once

#include "fsmc.h"

typedef enum FSMC_Mode {
    FSMC_MODE_1, /* SRAM: read and write alike */
    FSMC_MODE_2, /* NOR: read and write alike */
    FSMC_MODE_A, /* A to D: EXTMOD, writes have a mode and times of their own */
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
    FSMC_Mode writeMode;     /* in modes A to D */
    U8 psram;                /* MTYP of modes 1 and A: 1 PSRAM, 0 SRAM */
    U8 muxed;                /* MUXEN: address bits 15..0 on the data pins (the bridge's MUXED) */
    U8 wait;                 /* ASYNCWAIT: asynchronous accesses look at NWAIT */
    U8 waitHigh;             /* WAITPOL: NWAIT is active high (WAIT_HIGH) */
    U8 busturn;              /* BUSTURN, HCLK, 1..15 */
    FSMC_Timing read, write; /* modes 1 and 2: only `read`, for both */
} FSMC_Bank;

/* Does what FSMC_init does, with these settings of NE1 and NE2. Returns FSMC_BAD_SETTING, and
 * writes nothing, where a setting is reserved or out of range.
 * Streams (FSMC_streamRead, FSMC_streamWrite) are for the plain bridge and FSMC_init's settings
 * only. */
FSMC_Status FSMC_initBanks(const FSMC_Port* port, void* context, const FSMC_Bank banks[2]);
