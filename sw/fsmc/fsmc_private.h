/* SPDX-License-Identifier: MIT
 *
 * fsmc_private: registers of the FSMC, and the mode and times that FSMC_init gives it.
 */
#pragma once

#include "fsmc.h"

/* Registers of the FSMC (RM0033, 31.5.6); bank 0 is NE1. */
#define FSMC_REGISTERS 0xA0000000U
#define FSMC_BCR(bank) (FSMC_REGISTERS + 8U * (bank))
#define FSMC_BTR(bank) (FSMC_REGISTERS + 8U * (bank) + 0x004U)
#define FSMC_BWTR(bank) (FSMC_REGISTERS + 8U * (bank) + 0x104U)

#define BCR_MBKEN (1U << 0)
#define BCR_MUXEN (1U << 1)
#define BCR_MTYP_PSRAM (1U << 2)
#define BCR_MTYP_NOR (2U << 2)
#define BCR_MWID_16 (1U << 4)
#define BCR_FACCEN (1U << 6)
#define BCR_RESERVED (1U << 7) /* reads 1, and is kept so */
#define BCR_WAITPOL (1U << 9)
#define BCR_WREN (1U << 12)
#define BCR_EXTMOD (1U << 14)
#define BCR_ASYNCWAIT (1U << 15)

/* BTR and BWTR; times in HCLK. */
#define BTR_ADDSET(n) ((U32)(n))
#define BTR_ADDHLD(n) ((U32)(n) << 4)
#define BTR_DATAST(n) ((U32)(n) << 8)
#define BTR_BUSTURN(n) ((U32)(n) << 16)
#define BTR_ACCMOD(n) ((U32)(n) << 28)

/* The bits that all modes set: bank on, 16 bits, write enable. */
#define BCR_ALWAYS (BCR_MBKEN | BCR_MWID_16 | BCR_RESERVED | BCR_WREN)
/* FSMC_init's settings: mode 1 with NWAIT, active low. ADDSET 2: NWAIT, which follows the pins in
 * less than 16 ns, is valid when the data phase begins; DATAST 4 is the least with NWAIT
 * (docs/fsmc.md). */
#define BCR_VALUE (BCR_ALWAYS | BCR_ASYNCWAIT)
#define BTR_VALUE (BTR_ADDSET(2) | BTR_DATAST(4) | BTR_BUSTURN(1))

extern const FSMC_Port* fsmc_port;
extern void* fsmc_context;

/* Looks for the system slot, the last step of setting up. Returns FSMC_OK or FSMC_NO_DEVICE. */
FSMC_Status fsmc_identify(void);

/* Turns a DDR3 address into one in the window, and moves the page register where it must. */
U32 fsmc_windowAddress(U32 address);
