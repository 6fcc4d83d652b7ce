/* SPDX-License-Identifier: MIT
 *
 * cpu_cases: programs for the CPU model's tests. Each reports by letters: interrupt n prints a
 * small letter at its entry and a capital at its end ('a' is interrupt 0). Other handlers have
 * different letters.
 */
#pragma once

#include "stm32f2.h"

typedef void (*Action)(void);

extern volatile Action selected; /* the case; written by the test */
extern volatile U32 boots;       /* number of starts; survives a reset */
extern U32 value[8];             /* results of a case; [7] is EXC_RETURN of the last exception */
extern Action Case_action[20];   /* action of each exception, called by its handler */
extern U32* Case_frame;          /* frame of the current exception */

void Case_say(char c);
void Case_priority(U32 irq, U32 value8); /* Sets the priority of an interrupt, and enables it. */
void Case_pend(U32 irq);
void Reset_Handler(void);

void Case_ack(void);
void Case_ackWait(void);
U32 Work_asm(U32 rounds);
void Case_countCycles(void); /* starts DWT's cycle counter */

/* System registers that the header of the board does not define. */
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
    X(sleepOnExit) X(waitForEvent) X(unknownRegister) X(noBackground) X(alignmentTrap)
/* clang-format on */
#define DECLARED(name) void Case_##name(void);
CASES(DECLARED)
