/* SPDX-License-Identifier: MIT
 *
 * flash: erases and programs the STM32F2's flash (PM0059). There is one bank: the processor stands
 * still meanwhile, 16 us for a word, up to 2 s for a sector of 128 KiB.
 */
#ifndef FLASH_H
#define FLASH_H

#include "base.h"

#define FLASH_BASE 0x08000000UL

/* Erase a sector; program a word at an offset. They return 1 if no error flag was set; the context
 * is not used. */
int Flash_erase(void* context, U32 sector);
int Flash_program(void* context, U32 offset, U32 word);

#endif
