/* SPDX-License-Identifier: MIT
 *
 * timing: configures the clock tree and SysTick.
 */
#include "timing.h"
#include "board_pins.h"
#include "stm32f2.h"
#include "watchdog.h"

#define CYCLES_MASK 0xFFFFFFUL
#define HSI_HZ 16000000UL
#define READY_POLLS 200000UL /* limit of the number of polls; a crystal starts within some ms */

static Timing_Clock now;

U32 Timing_mhz(void) {
    return now.hclkHz / 1000000UL;
}

U32 Timing_cycles(void) {
    return CYCLES_MASK - SYST_CVR;
}

void Timing_pause(U32 cycles) {
    U32 from = SYST_CVR;
    Watchdog_feed();
    while (((from - SYST_CVR) & CYCLES_MASK) < cycles)
        ;
}

void Timing_wait(U32 us) {
    for (; us > 1000U; us -= 1000U)
        Timing_pause(now.hclkHz / 1000U);
    Timing_pause(now.hclkHz / 1000000U * us);
}

/* Sets the PLL to 2 * hz, from an input of 1 MHz, and HCLK to hz. */
static void startPll(U32 hz) {
    U32 mhz = hz / 1000000UL, source = now.isCrystal ? BOARD_HSE_HZ : HSI_HZ;
    RCC_CFGR &= ~3UL; /* uses HSI as the clock while the PLL changes */
    while (RCC_CFGR & RCC_CFGR_SWS_MASK)
        ;
    RCC_CR &= ~RCC_CR_PLLON;
    while (RCC_CR & RCC_CR_PLLRDY)
        ;
    /* The PLL's oscillator needs 192 to 432 MHz; its output is divided by 2, 4, 6 or 8. */
    RCC_PLLCFGR = source / 1000000UL |
                  (mhz >= 96UL   ? mhz * 2UL << 6
                   : mhz >= 48UL ? mhz * 4UL << 6 | 1UL << 16
                                 : mhz * 8UL << 6 | 3UL << 16) |
                  (U32)now.isCrystal << 22 | 5UL << 24;
    RCC_CR |= RCC_CR_PLLON;
    while (!(RCC_CR & RCC_CR_PLLRDY))
        ;
    FLASH_ACR = FLASH_ACR_120MHZ;
    RCC_CFGR = RCC_CFGR_APB1_DIV4 | RCC_CFGR_APB2_DIV2 | RCC_CFGR_SW_PLL;
    while ((RCC_CFGR & RCC_CFGR_SWS_MASK) != RCC_CFGR_SWS_PLL)
        ;
    now.hclkHz = hz;
}

const Timing_Clock* Timing_start(void) {
    U32 polls;
    RCC_CR |= BOARD_HSE_ON;
    for (polls = 0; polls < READY_POLLS && !(RCC_CR & RCC_CR_HSERDY); ++polls)
        ;
    now.isCrystal = (RCC_CR & RCC_CR_HSERDY) != 0;
    startPll(120000000UL);
    SYST_RVR = CYCLES_MASK;
    SYST_CVR = 0;
    SYST_CSR = SYST_CSR_POLLED;
    return &now;
}

void Timing_setHclk(U32 hz) {
    if (hz != now.hclkHz)
        startPll(hz);
}
