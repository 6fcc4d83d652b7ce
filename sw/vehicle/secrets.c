/* SPDX-License-Identifier: MIT
 *
 * secrets: reads the random number generator (RM0033, 20.3), and stores keys in the backup SRAM. If
 * the generator reports an error, waits for the watchdog's reset, because predictable numbers would
 * be worse. ST recommends the backup SRAM for keys: a battery powers it, and if the read protection
 * is removed, it is erased together with the flash.
 */
#include "secrets.h"
#include "stm32f2.h"

static U32 lastRandom;

static U32 random(void* context) {
    (void)context;
    for (;;) {
        U32 status = RNG_SR, value;
        if (status & (RNG_SR_SEIS | RNG_SR_CEIS)) {
            RNG_SR = 0;
            RNG_CR = 0;
            RNG_CR = RNG_CR_RNGEN;
        } else if (status & RNG_SR_DRDY) {
            value = RNG_DR;
            if (value != lastRandom)
                return lastRandom = value;
        }
    }
}

static U32 load(void* context, U32 word) {
    (void)context;
    return BKPSRAM(word);
}

static void store(void* context, U32 word, U32 value) {
    (void)context;
    BKPSRAM(word) = value;
    /* ensures the order of the writes, because power may fail between them */
    __asm__ volatile("dsb");
}

const UAV_Board secrets_board = {random, load, store};

void Secrets_start(void) {
    RCC_AHB2ENR |= RCC_AHB2ENR_RNG;
    RNG_CR = RNG_CR_RNGEN;
    /* discards the first number, with which the generator compares the second one */
    (void)random(0);
    RCC_APB1ENR |= RCC_APB1ENR_PWR;
    PWR_CR |= PWR_CR_DBP;
    RCC_AHB1ENR |= RCC_AHB1ENR_BKPSRAM;
    PWR_CSR |= PWR_CSR_BRE;
}
