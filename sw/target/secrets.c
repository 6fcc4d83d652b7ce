/* SPDX-License-Identifier: MIT
 *
 * secrets: the generator by RM0033, 20.3, whose errors are waited out: numbers that can be guessed
 * are worse than a vehicle that the watchdog starts again. The backup SRAM is ST's place for keys:
 * the battery keeps it, and it is erased with the flash where the read protection is taken off.
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
    __asm__ volatile("dsb"); /* one after the other, where power fails */
}

const UAV_Board secrets_board = {random, load, store};

void Secrets_start(void) {
    RCC_AHB2ENR |= RCC_AHB2ENR_RNG;
    RNG_CR = RNG_CR_RNGEN;
    (void)random(0); /* the first one is only there to be compared with the second */
    RCC_APB1ENR |= RCC_APB1ENR_PWR;
    PWR_CR |= PWR_CR_DBP;
    RCC_AHB1ENR |= RCC_AHB1ENR_BKPSRAM;
    PWR_CSR |= PWR_CSR_BRE;
}
