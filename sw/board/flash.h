/* SPDX-License-Identifier: MIT
 *
 * flash: erases and programs the flash of the STM32F2 (PM0059). The flash has one bank, so the
 * processor stalls meanwhile: 16 us for a word, up to 2 s for a sector of 128 KiB.
 */
#pragma once

#include "base.h"

#define FLASH_BASE 0x08000000UL

/* Functions of a Slots_Port: read bytes, erase the sector of 128 KiB at an offset, program words.
 * The last two return 1 if no error flag was set. The context is not used. */
void Flash_read(void* context, U32 offset, U8* bytes, U32 count);
int Flash_erase(void* context, U32 offset);
int Flash_program(void* context, U32 offset, const U8* bytes, U32 count);
