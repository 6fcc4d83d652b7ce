/* SPDX-License-Identifier: MIT
 *
 * clock: configures the clock tree of the STM32F2: oscillator, PLL, dividers (RM0033, 5.2).
 */
#pragma once

#include "board_pins.h"
#include "stm32f2.h"

/* Switches to 120 MHz with the oscillator of the board (board_pins.h), and sets the flash wait
 * states. Does nothing if this was done before. Uses no RAM. */
static void Clock_start(void) {
    if ((RCC_CFGR & RCC_CFGR_SWS_MASK) == RCC_CFGR_SWS_PLL)
        return; /* the boot loader has already set the clock */
    RCC_CR |= BOARD_HSE_ON;
    while (!(RCC_CR & RCC_CR_HSERDY))
        ;
    /* The PLL makes 1 MHz * 240 / 2 = 120 MHz, and 1 MHz * 240 / 5 = 48 MHz for the random number
     * generator. */
    RCC_PLLCFGR = BOARD_HSE_HZ / 1000000UL | 240UL << 6 | 0UL << 16 | 1UL << 22 | 5UL << 24;
    RCC_CR |= RCC_CR_PLLON;
    while (!(RCC_CR & RCC_CR_PLLRDY))
        ;
    FLASH_ACR = FLASH_ACR_120MHZ;
    RCC_CFGR = RCC_CFGR_APB1_DIV4 | RCC_CFGR_APB2_DIV2 | RCC_CFGR_SW_PLL;
    while ((RCC_CFGR & RCC_CFGR_SWS_MASK) != RCC_CFGR_SWS_PLL)
        ;
}
