/* SPDX-License-Identifier: MIT
 *
 * cpu_cases: start-up code, and the handlers of all exceptions. The test selects a case by its
 * symbol.
 */
#include "cpu_cases.h"
#include "program_memory.h"

void Handler(void);
void Handler_run(U32* frame, U32 number, U32 excReturn);

/* the case to run; the test writes it */
volatile Action selected __attribute__((section(".noinit")));
volatile U32 boots __attribute__((section(".noinit")));
char said[128];
U32 value[8]; /* results of a case */
static U32 at;
Action Case_action[16 + 4]; /* function that each exception's handler calls */
U32* Case_frame;            /* stack frame of the current exception */

void Case_say(char c) {
    said[at++] = c;
}

void Handler_run(U32* frame, U32 number, U32 excReturn) {
    static const char names[] = "..nhmuf....s..pt";
    char small = number < 16U ? names[number] : (char)('a' + number - 16U);
    Case_say(small);
    Case_frame = frame;
    value[7] = excReturn;
    if (Case_action[number])
        Case_action[number]();
    if (number >= 16U)
        Case_say((char)(small - 32));
}

void __attribute__((naked)) Handler(void) {
    __asm__ volatile("tst lr, #4\n\t"
                     "ite eq\n\t"
                     "mrseq r0, msp\n\t"
                     "mrsne r0, psp\n\t"
                     "mrs r1, ipsr\n\t"
                     "mov r2, lr\n\t"
                     "push {r3, lr}\n\t"
                     "bl Handler_run\n\t"
                     "pop {r3, pc}");
}

void Case_countCycles(void) {
    DEMCR = DEMCR_TRCENA;
    DWT_CTRL = 1; /* CYCCNTENA */
}

void Case_priority(U32 irq, U32 value8) {
    NVIC_IPR(irq) = (U8)value8;
    NVIC_ISER(0) = 1UL << irq;
}

void Case_pend(U32 irq) {
    NVIC_ISPR0 = 1UL << irq;
    __asm__ volatile("dsb\n\tisb");
}

#define NAMED(name) Case_##name,
__attribute__((section(".vectors"), used)) static const Vector vectors[] = {
    stack_top, Reset_Handler, Handler, Handler, Handler, Handler, Handler, 0, 0, 0, 0, Handler,
    Handler, 0, Handler, Handler, Handler, Handler, Handler, Handler, Case_ack, Case_ackWait,
    /* Addresses of all cases, because the linker would remove functions to which nothing refers. */
    CASES(NAMED)};

void Reset_Handler(void) {
    startMemory();
    selected();
    __asm__ volatile("bkpt #1");
}
