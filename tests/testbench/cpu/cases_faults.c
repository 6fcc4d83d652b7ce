/* SPDX-License-Identifier: MIT
 *
 * cases_faults: cases about accesses and instructions that fail, escalation, lock-up and the MPU.
 */
#include "cpu_cases.h"

#define SCB_HFSR REG(0xE000ED2CUL)
#define SCB_ACTLR REG(0xE000E008UL)
#define ACTLR_DISDEFWBUF 2UL
#define CFSR_IMPRECISERR (1UL << 10)

/* Makes the program continue after the instruction that failed. (The fault of a buffered store
 * arrives later anyway.) */
static void skip(void) {
    U16 first = *(U16*)Case_frame[6];
    value[0] = SCB_CFSR;
    value[1] = SCB_BFAR;
    value[2] = SCB_HFSR;
    value[3] = SCB_MMFAR;
    SCB_CFSR = 0xFFFFFFFFUL;
    if (!(value[0] & CFSR_IMPRECISERR))
        Case_frame[6] += first >> 11 >= 0x1DU ? 4U : 2U;
}

void Case_busFault(void) {
    SCB_SHCSR = SCB_SHCSR_FAULTS;
    Case_action[5] = skip;
    value[4] = REG(0x60000010UL);
    Case_say('.');
}

/* Makes a store that fails. Its fault arrives after some other instructions have been executed; DSB
 * waits for it. */
static void storeAndGoOn(void) {
    SCB_SHCSR = SCB_SHCSR_FAULTS;
    SCB_BFAR = 0;
    __asm__ volatile("mov r0, #0x60000000\n\t"
                     "movs r1, #0\n\t"
                     "str r0, [r0, #16]\n\t"
                     "adds r1, #1\n\t"
                     "adds r1, #1\n\t"
                     "dsb\n\t"
                     "adds r1, #1" ::
                         : "r0", "r1", "memory");
}

static void notePassed(void) {
    skip();
    value[4] = Case_frame[1]; /* R1 */
}

void Case_storeFault(void) {
    Case_action[5] = notePassed;
    storeAndGoOn();
    Case_say('.');
}

void Case_unbuffered(void) {
    SCB_ACTLR = ACTLR_DISDEFWBUF;
    Case_action[5] = notePassed;
    storeAndGoOn();
    Case_say('.');
}

/* While PRIMASK is set, the fault of a store must wait. The fault of a load would become a hard
 * fault. */
void Case_storeMasked(void) {
    SCB_SHCSR = SCB_SHCSR_FAULTS;
    Case_action[5] = skip;
    __asm__ volatile("cpsid i");
    REG(0x60000010UL) = 1;
    __asm__ volatile("dsb");
    Case_say('1');
    __asm__ volatile("cpsie i\n\tisb");
    Case_say('2');
}

/* Handlers of interrupts 4 and 5, which clear the interrupt line by a store. In the first handler
 * no barrier follows the store, in the second one a barrier follows. */
void __attribute__((naked)) Case_ack(void) {
    __asm__ volatile("mov r0, #0x60000000\n\t"
                     "str r0, [r0, #16]\n\t"
                     "bx lr");
}

void __attribute__((naked)) Case_ackWait(void) {
    __asm__ volatile("mov r0, #0x60000000\n\t"
                     "str r0, [r0, #16]\n\t"
                     "dsb\n\t"
                     "bx lr");
}

void Case_lateAck(void) {
    Case_priority(4, 0);
    Case_priority(5, 0);
    /* the test raises the interrupt line with the number that is written here */
    REG(0x60000000UL) = 4;
    __asm__ volatile("dsb\n\tisb");
    REG(0x60000000UL) = 5;
    __asm__ volatile("dsb\n\tisb");
}

void Case_noMemory(void) {
    SCB_SHCSR = SCB_SHCSR_FAULTS;
    Case_action[5] = skip;
    REG(0x10000000UL) = 1;
    Case_say('.');
    /* writes to the code of this case; the store fails, because flash cannot be written by a
     * store */
    *(volatile U32*)((U32)selected & ~3UL) = 1;
    Case_say('.');
}

void Case_escalation(void) {
    Case_action[3] = skip;
    value[4] = REG(0x60000010UL);
    Case_say('.');
}

void Case_breakpoint(void) {
    Case_action[3] = skip;
    __asm__ volatile("bkpt #2");
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

/* Handlers of hard faults and of NMI run without the MPU, so the frame of an NMI may be put
 * here. */
static U32 readOnly[64] __attribute__((aligned(256)));

static void interruptOnReadOnly(void) {
    skip();
    __asm__ volatile("mov r2, sp\n\t"
                     "mov sp, %0\n\t"
                     "str %1, [%2]\n\t"
                     "dsb\n\t"
                     "isb\n\t"
                     "mov sp, r2" ::"r"(readOnly + 64),
                     "r"(1UL << 31), /* ICSR.NMIPENDSET */
                     "r"(&SCB_ICSR)
                     : "r2", "memory");
}

void Case_guardOff(void) {
    Case_action[3] = interruptOnReadOnly;
    MPU_RBAR = (U32)readOnly | 0x10UL;
    MPU_RASR = 1UL << 28 | 5UL << 24 | 7UL << 1 | 1UL;
    MPU_CTRL = MPU_CTRL_ON;
    value[4] = REG(0x60000010UL);
    Case_say('.');
    value[5] = SCB_CFSR;
    MPU_CTRL = 0;
}
