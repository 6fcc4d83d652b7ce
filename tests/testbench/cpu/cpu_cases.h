/* SPDX-License-Identifier: MIT
 *
 * cpu_cases: programs for the CPU model's tests. Each reports by letters: interrupt n enters as a
 * small letter and leaves as a capital ('a' is interrupt 0), other handlers have letters of their
 * own.
 */
#ifndef CPU_CASES_H
#define CPU_CASES_H

#include "stm32f2.h"

typedef void (*Action)(void);

extern volatile Action selected; /* the case; written by the test */
extern volatile U32 boots;       /* survives a reset */
extern U32 value[8];             /* what a case found out; [7]: EXC_RETURN of the last exception */
extern Action Case_action[20];   /* of exceptions, called by their handlers */
extern U32* Case_frame;          /* the frame of the exception under way */

void Case_say(char c);
void Case_priority(U32 irq, U32 value8); /* and enables it */
void Case_pend(U32 irq);
void Reset_Handler(void);

void Case_nesting(void);
void Case_samePriority(void);
void Case_lowestNumberFirst(void);
void Case_subPriority(void);
void Case_primaskExact(void);
void Case_basepri(void);
void Case_faultmask(void);
void Case_switchLast(void);
void Case_supervisorCall(void);
void Case_systick(void);
void Case_sleepMasked(void);
void Case_busFault(void);
void Case_storeFault(void);
void Case_unbuffered(void);
void Case_storeMasked(void);
void Case_lateAck(void);
void Case_ack(void);
void Case_ackWait(void);
void Case_noMemory(void);
void Case_escalation(void);
void Case_undefinedInstruction(void);
void Case_armState(void);
void Case_lockUp(void);
void Case_guard(void);
void Case_process(void);
void Case_alignment(void);
void Case_cycles(void);
void Case_resetRequest(void);
void Case_work(void);
U32 Work_asm(U32 rounds);

#endif
