/* SPDX-License-Identifier: MIT
 *
 * cpu_cases: programs for the tests of the CPU model. Each program reports its steps as letters:
 * interrupt n prints a small letter when it begins and a capital letter when it ends ('a' is
 * interrupt 0). Other handlers print other letters.
 */
#pragma once

#include "stm32f2.h"

typedef void (*Action)(void);

extern volatile Action selected; /* the case to run; the test writes it */
extern volatile U32 boots;       /* number of starts, which survives a reset */
/* results of a case; [7] is the value EXC_RETURN of the last exception */
extern U32 value[8];
extern Action Case_action[20]; /* function that each exception's handler calls */
extern U32* Case_frame;        /* stack frame of the current exception */

void Case_say(char c);
void Case_priority(U32 irq, U32 value8); /* Sets the priority of an interrupt, and enables it. */
void Case_pend(U32 irq);
void Reset_Handler(void);

void Case_ack(void);
void Case_ackWait(void);
U32 Work_asm(U32 rounds);
void Case_countCycles(void); /* starts the cycle counter of DWT */

/* System registers that the board's header does not define. */
#define DEMCR REG(0xE000EDFCUL)
#define DEMCR_TRCENA (1UL << 24)
#define DWT_CTRL REG(0xE0001000UL)
#define DWT_CYCCNT REG(0xE0001004UL)
#define NVIC_ISPR0 REG(0xE000E200UL)

/* clang-format off */
#define CASES(X) \
    X(nesting) X(samePriority) X(lowestNumberFirst) X(subPriority) X(primaskExact) X(basepri) \
    X(faultmask) X(switchLast) X(supervisorCall) X(systick) X(sleepMasked) X(busFault) \
    X(storeFault) X(unbuffered) X(storeMasked) X(lateAck) X(noMemory) X(escalation) \
    X(undefinedInstruction) X(armState) X(lockUp) X(guard) X(guardOff) X(process) X(alignment) X(cycles) \
    X(resetRequest) X(work) X(exclusive) X(unaligned) X(executeNever) X(basepriBits) \
    X(cycleCounter) X(tickRules) X(interruptState) X(bitBand) X(stackedState) X(unprivileged) \
    X(sleepOnExit) X(waitForEvent) X(unknownRegister) X(noBackground) X(alignmentTrap) \
    X(breakpoint) X(faultmaskIgnored) X(regionBits) X(byteOfRegister) X(unprivilegedLoad) X(unprivilegedStore)
/* clang-format on */
#define DECLARED(name) void Case_##name(void);
CASES(DECLARED)
