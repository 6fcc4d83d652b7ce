/* SPDX-License-Identifier: MIT
 *
 * spi_nor: a Slots_Port on a serial NOR flash with the usual instructions (W25Q, M25P: 03, 02, D8,
 * 05, 06, 9F). Its context is the bus.
 */
#pragma once

#include "base.h"

typedef struct SpiNor_Bus {
    /* Drives chip select and the bus; 0: releases both. */
    void (*select)(int isLow);
    U8 (*transfer)(U8 byte);
    void (*pause)(void); /* lets other tasks work for a while */
} SpiNor_Bus;

/* Returns 1 if a flash answers. */
int SpiNor_isThere(void* bus);
void SpiNor_read(void* bus, U32 offset, U8* bytes, U32 count);
/* Erases 64 KiB. Returns 1 when done. */
int SpiNor_erase(void* bus, U32 offset);
/* Programs up to 256 bytes of a page. Returns 1 when done. */
int SpiNor_program(void* bus, U32 offset, const U8* bytes, U32 count);
