/* SPDX-License-Identifier: MIT
 *
 * cases_faults: accesses and instructions that fail, escalation, lock-up, the MPU.
 */
#include "cpu_cases.h"

#define SCB_HFSR REG(0xE000ED2CUL)

/* Goes on behind the instruction that failed. */
static void skip(void) {
    U16 first = *(U16*)Case_frame[6];
    value[0] = SCB_CFSR;
    value[1] = SCB_BFAR;
    value[2] = SCB_HFSR;
    value[3] = SCB_MMFAR;
    SCB_CFSR = 0xFFFFFFFFUL;
    Case_frame[6] += first >> 11 >= 0x1DU ? 4U : 2U;
}

void Case_busFault(void) {
    SCB_SHCSR = SCB_SHCSR_FAULTS;
    Case_action[5] = skip;
    value[4] = REG(0x60000010UL);
    Case_say('.');
}

void Case_noMemory(void) {
    SCB_SHCSR = SCB_SHCSR_FAULTS;
    Case_action[5] = skip;
    REG(0x10000000UL) = 1;
    Case_say('.');
    *(volatile U32*)selected = 1; /* selected is small: flash is not written like this */
    Case_say('.');
}

void Case_escalation(void) {
    Case_action[3] = skip;
    value[4] = REG(0x60000010UL);
    Case_say('.');
}

void Case_undefinedInstruction(void) {
    SCB_SHCSR = SCB_SHCSR_FAULTS;
    Case_action[6] = skip;
    __asm__ volatile("udf #7");
    Case_say('.');
}

static void toLr(void) {
    value[0] = SCB_CFSR;
    Case_frame[6] = Case_frame[5] & ~1UL;
    Case_frame[7] |= 1UL << 24;
}

void Case_armState(void) {
    SCB_SHCSR = SCB_SHCSR_FAULTS;
    Case_action[6] = toLr;
    __asm__ volatile("ldr r0, =Reset_Handler\n\tbic r0, r0, #1\n\tblx r0" ::
                         : "r0", "lr", "r1", "r2", "r3", "r12");
    Case_say('.');
}

static void failAgain(void) {
    value[4] = REG(0x60000010UL);
}

void Case_lockUp(void) {
    Case_action[3] = failAgain;
    value[4] = REG(0x60000010UL);
}

static U32 guarded[32] __attribute__((aligned(64)));

void Case_guard(void) {
    SCB_SHCSR = SCB_SHCSR_FAULTS;
    Case_action[4] = skip;
    MPU_RBAR = (U32)&guarded[8] | 0x10UL;
    MPU_RASR = 1UL << 28 | 5UL << 24 | 4UL << 1 | 1UL;
    MPU_CTRL = MPU_CTRL_ON;
    ((volatile U32*)guarded)[7] = 1;
    Case_say((char)('0' + ((volatile U32*)guarded)[8]));
    ((volatile U32*)guarded)[8] = 1;
    Case_say('.');
    ((volatile U32*)guarded)[16] = 1;
    MPU_CTRL = 0;
    Case_say('.');
}
