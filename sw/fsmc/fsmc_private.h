/* SPDX-License-Identifier: MIT
 *
 * fsmc_private: what the files of the FSMC driver share.
 */
#ifndef FSMC_PRIVATE_H
#define FSMC_PRIVATE_H

#include "fsmc.h"

#define FSMC_REGISTERS 0xA0000000UL
/* BCR: bank on, SRAM, 16 bits, write enable, asynchronous wait (NWAIT, active low): mode 1. */
#define BCR_VALUE (1UL << 0 | 1UL << 4 | 1UL << 7 | 1UL << 12 | 1UL << 15)
/* BTR: ADDSET 2 HCLK: NWAIT, which follows the pins in less than 16 ns, is valid when the data
 * phase begins; DATAST 4, the least with NWAIT; BUSTURN 1 (docs/fsmc.md). */
#define BTR_VALUE (2UL | 4UL << 8 | 1UL << 16)

extern const Fsmc_Port* fsmc_port;
extern void* fsmc_context;

/* Looks for the system slot; the last step of setting up. */
Fsmc_Status fsmc_identify(void);

/* Turns a DDR3 address into one in the window, and moves the page register where it must. */
U32 fsmc_windowAddress(U32 address);

#endif
