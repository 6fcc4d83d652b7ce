/* SPDX-License-Identifier: MIT
 *
 * loader_client: gives the firmware access to the functions of the boot loader.
 */
#include "flash.h"
#include "loader.h"
#include "stm32f2.h"

#define WATCHDOG_LONGEST 0xFFFUL

extern U32 image_begin[]; /* firmware.ld */

static Slots_Port port;

/* Erases a sector. The processor stalls during an erase and cannot refresh the watchdog. The
 * time-out of the watchdog is therefore set to 4 s (2.8 s if its oscillator has the highest
 * frequency). */
static int erase(void* context, U32 offset) {
    const U32 usual = IWDG_RLR;
    int good;
    IWDG_KR = IWDG_KR_UNLOCK;
    IWDG_RLR = WATCHDOG_LONGEST;
    IWDG_KR = IWDG_KR_REFRESH;
    good = Flash_erase(context, offset);
    IWDG_KR = IWDG_KR_UNLOCK;
    IWDG_RLR = usual;
    IWDG_KR = IWDG_KR_REFRESH;
    return good;
}

const Slots_Port* Loader_slots(U32* running) {
    for (*running = 0; *running < SLOTS_COUNT; ++*running)
        if ((U32)image_begin == FLASH_BASE + Slots_at(&slots_firmware, *running) + SLOTS_IMAGE_AT &&
            LOADER_SERVICES->magic == LOADER_MAGIC) {
            port.layout = &slots_firmware;
            port.keys = LOADER_KEYS;
            port.mapped = (const U8*)FLASH_BASE;
            port.read = Flash_read;
            port.erase = erase;
            port.program = Flash_program;
            port.isSigned = LOADER_SERVICES->isSigned;
            port.digest = LOADER_SERVICES->digest;
            return &port;
        }
    return 0;
}
