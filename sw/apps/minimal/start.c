/* SPDX-License-Identifier: MIT
 *
 * start: vectors and start of the minimal program on the STM32F2: clock, pins, memory, a tick of
 * 1 kHz. There is no other interrupt: the program polls.
 */
#include "board.h"
#include "minimal.h"
#include "stm32f2.h"

typedef void (*Vector)(void);

extern void stack_top(void); /* firmware.ld */
extern U32 data_begin[], data_end[], data_load[], bss_begin[], bss_end[];

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
    U32* to;
    const U32* from = data_load;
    Board_start();
    for (to = data_begin; to < data_end;)
        *to++ = *from++;
    for (to = bss_begin; to < bss_end;)
        *to++ = 0;
    SYST_RVR = SYST_MS - 1UL;
    SYST_CVR = 0;
    SYST_CSR = SYST_CSR_ON;
    (void)main();
    halt();
}
