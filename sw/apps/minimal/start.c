/* SPDX-License-Identifier: MIT
 *
 * start: vectors and start of the minimal program on the STM32F2: clock, pins, memory, a tick of
 * 1 kHz. There is no other interrupt: the program polls.
 */
#include "board.h"
#include "minimal.h"
#include "program_memory.h"
#include "stm32f2.h"

volatile U32 minimal_ticks;

void Reset_Handler(void);

static void countTick(void) {
    ++minimal_ticks;
}

static void halt(void) {
    for (;;)
        Minimal_sleep();
}

void Minimal_sleep(void) {
    __asm__ volatile("wfi");
}

__attribute__((section(".vectors"), used)) static const Vector vectors[16] = {
    stack_top, /* not a function: the first word is the stack pointer */
    Reset_Handler, halt, halt, halt, halt, halt, 0, 0, 0, 0, halt, halt, 0, halt, countTick};

void Reset_Handler(void) {
    Board_start();
    startMemory();
    SYST_RVR = SYST_MS - 1UL;
    SYST_CVR = 0;
    SYST_CSR = SYST_CSR_ON;
    (void)main();
    halt();
}
