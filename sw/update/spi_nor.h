/* SPDX-License-Identifier: MIT
 *
 * spi_nor: a Slots_Port for a serial NOR flash that has the usual commands 03, 02, D8, 05, 06 and
 * 9F (such as W25Q and M25P). Its context is the bus.
 */
#pragma once

#include "base.h"

typedef struct SpiNor_Bus {
    /* Called with 1: drives the bus, and chip select low. Called with 0: releases both. */
    void (*select)(int isLow);
    U8 (*transfer)(U8 byte);
    void (*pause)(void); /* lets other tasks run for a while */
} SpiNor_Bus;

/* Returns 1 if a flash answers on the bus. */
int SpiNor_isThere(void* bus);
void SpiNor_read(void* bus, U32 offset, U8* bytes, U32 count);
/* Erases 64 KiB. Returns 1 when done, 0 on failure. */
int SpiNor_erase(void* bus, U32 offset);
/* Programs up to 256 bytes within a page. Returns 1 when done, 0 on failure. */
int SpiNor_program(void* bus, U32 offset, const U8* bytes, U32 count);
