/* SPDX-License-Identifier: MIT
 *
 * flash: erases and programs the flash, which is unlocked only during an operation.
 */
#include "flash.h"
#include "stm32f2.h"

#include <string.h>

static void unlock(void) {
    if (FLASH_CR & FLASH_CR_LOCK) {
        FLASH_KEYR = FLASH_KEY1;
        FLASH_KEYR = FLASH_KEY2;
    }
    FLASH_SR = FLASH_SR_ERRORS; /* clears error flags, because some may be set after a reset */
}

static int done(void) {
    U32 status;
    while (FLASH_SR & FLASH_SR_BSY)
        ;
    status = FLASH_SR;
    FLASH_CR = FLASH_CR_LOCK;
    return !(status & FLASH_SR_ERRORS);
}

void Flash_read(void* context, U32 offset, U8* bytes, U32 count) {
    (void)context;
    memcpy(bytes, (const U8*)FLASH_BASE + offset, count);
}

int Flash_erase(void* context, U32 offset) {
    const U32 sector = 4U + offset / 0x20000U;
    (void)context;
    unlock();
    FLASH_CR = FLASH_CR_X32 | FLASH_CR_SER | sector << 3;
    FLASH_CR = FLASH_CR_X32 | FLASH_CR_SER | sector << 3 | FLASH_CR_STRT;
    return done();
}

int Flash_program(void* context, U32 offset, const U8* bytes, U32 count) {
    U32 i;
    (void)context;
    unlock();
    FLASH_CR = FLASH_CR_X32 | FLASH_CR_PG;
    for (i = 0; i < count; i += 4) {
        U32 word;
        memcpy(&word, bytes + i, sizeof word);
        REG(FLASH_BASE + offset + i) = word;
    }
    return done();
}
