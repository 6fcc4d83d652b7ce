/* SPDX-License-Identifier: MIT
 *
 * loader: checks the images in the slots and starts one of them. It has no variables. Its stack is
 * at the end of RAM, where the firmware keeps nothing that must survive a reset. A signature check
 * needs a few functions from files of libsodium that are not linked; replacements are at the end of
 * this file.
 */
#include "loader.h"
#include "backup.h"
#include "clock.h"
#include "flash.h"
#include "signature.h"
#include "stm32f2.h"

#include <sodium/crypto_hash_sha512.h>
#include <sodium/utils.h>

#define TRIAL_PRESCALER 6UL /* divides LSI by 256, so that one count takes 8 ms */
/* 10 s: time within which new firmware must begin to refresh the watchdog itself */
#define TRIAL_RELOAD 1250UL

typedef void (*Vector)(void);

extern void stack_top(void); /* loader.ld */

void Reset_Handler(void);

/* Restarts after a fault in the loader, because the next attempt may succeed. */
static void restart(void) {
    SCB_AIRCR = SCB_AIRCR_RESET;
    for (;;)
        ;
}

__attribute__((section(".vectors"), used)) static const Vector vectors[16] = {
    stack_top, /* initial stack pointer, not a function */
    Reset_Handler, restart, restart, restart, restart, restart};

__attribute__((section(".services"), used)) static const Loader_Services services = {
    LOADER_MAGIC, Signature_isGood, Signature_digest};

static const Slots_Port port = {&slots_firmware,      0,
                                Flash_read,           Flash_erase,
                                Flash_program,        Signature_isGood,
                                Signature_digest,     LOADER_KEYS,
                                (const U8*)FLASH_BASE};

/* Starts the program with its vector table at this address, which is in r0. */
static void __attribute__((naked, noreturn)) jump(const U32* at __attribute__((unused))) {
    __asm__ volatile("ldrd r1, r2, [r0]\n\t"
                     "msr msp, r1\n\t"
                     "bx r2");
}

void Reset_Handler(void) {
    U32 slot;
    Clock_start();
    RCC_AHB1ENR |= RCC_AHB1ENR_BKPSRAM;
    slot = Slots_choose(&port, LOADER_PRODUCT, BKPSRAM(BACKUP_AT(vehicle.flight)) != BACKUP_FLYING);
    if (slot == SLOTS_NONE) /* no image can be started, so the board must be programmed again */
        for (;;)
            __asm__ volatile("wfi");
    if (!Slots_is(&port, slot, SLOTS_CONFIRMED)) {
        IWDG_KR = IWDG_KR_START;
        IWDG_KR = IWDG_KR_UNLOCK;
        IWDG_PR = TRIAL_PRESCALER;
        IWDG_RLR = TRIAL_RELOAD;
        IWDG_KR = IWDG_KR_REFRESH;
    }
    SCB_VTOR = FLASH_BASE + Slots_at(&slots_firmware, slot) + SLOTS_IMAGE_AT;
    jump((const U32*)SCB_VTOR);
}

void _crypto_sign_ed25519_ref10_hinit(crypto_hash_sha512_state* state, int prehashed);

void _crypto_sign_ed25519_ref10_hinit(crypto_hash_sha512_state* state, int prehashed) {
    (void)prehashed;
    (void)crypto_hash_sha512_init(state);
}

int sodium_memcmp(const void* a, const void* b, size_t bytes) {
    const volatile unsigned char* x = (const volatile unsigned char*)a;
    const volatile unsigned char* y = (const volatile unsigned char*)b;
    int difference = 0;
    while (bytes--)
        difference |= *x++ ^ *y++;
    return difference ? -1 : 0;
}

int sodium_is_zero(const unsigned char* bytes, const size_t count) {
    size_t i;
    unsigned all = 0;
    for (i = 0; i < count; ++i)
        all |= bytes[i];
    return all == 0;
}

/* Replaces libsodium's function, which wipes intermediate results. Does nothing, because the data
 * checked here is public. */
void sodium_memzero(void* const at, const size_t bytes) {
    (void)at;
    (void)bytes;
}
