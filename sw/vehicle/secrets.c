/* SPDX-License-Identifier: MIT
 *
 * secrets: the random number generator by RM0033, 20.3. Its errors are waited out, since guessable
 * numbers are worse than a restart by the watchdog. The backup SRAM is ST's place for keys: the
 * battery keeps it, and removing the read protection erases it with the flash.
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
    __asm__ volatile("dsb"); /* in order, since power may fail */
}

const UAV_Board secrets_board = {random, load, store};

void Secrets_start(void) {
    RCC_AHB2ENR |= RCC_AHB2ENR_RNG;
    RNG_CR = RNG_CR_RNGEN;
    (void)random(0); /* the second number is compared with this first one */
    RCC_APB1ENR |= RCC_APB1ENR_PWR;
    PWR_CR |= PWR_CR_DBP;
    RCC_AHB1ENR |= RCC_AHB1ENR_BKPSRAM;
    PWR_CSR |= PWR_CSR_BRE;
}
