/* SPDX-License-Identifier: MIT
 *
 * watchdog: the independent watchdog (RM0033, 18.3), and a name in RAM that a reset keeps.
 */
#include "watchdog.h"
#include "stm32f2.h"

#define DIVIDE_BY_256 6UL /* 8 ms at 32 kHz */
#define TICK_MS 8U
#define MOST_TICKS 4096U
#define MARK 0x57A7C4D0UL

typedef struct Memory {
    U32 mark;
    const char* step;
} Memory;
static Memory memory __attribute__((section(".noinit")));

void Watchdog_start(U32 ms) {
    U32 ticks = ms / TICK_MS;
    IWDG_KR = IWDG_KR_START;
    IWDG_KR = IWDG_KR_UNLOCK;
    IWDG_PR = DIVIDE_BY_256;
    IWDG_RLR = (ticks > MOST_TICKS ? MOST_TICKS : ticks ? ticks : 1U) - 1U;
    IWDG_KR = IWDG_KR_REFRESH;
}

void Watchdog_feed(void) {
    IWDG_KR = IWDG_KR_REFRESH;
}

void Watchdog_enter(const char* step) {
    memory.mark = MARK;
    memory.step = step;
}

const char* Watchdog_hungStep(void) {
    int isHung = (RCC_CSR & RCC_CSR_IWDGRST) && memory.mark == MARK;
    RCC_CSR |= RCC_CSR_RMVF;
    memory.mark = 0;
    return isHung ? memory.step : 0;
}
