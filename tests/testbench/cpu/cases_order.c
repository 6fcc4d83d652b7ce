/* SPDX-License-Identifier: MIT
 *
 * cases_order: cases about the order and the time of exceptions: priorities, masks, PendSV, SVC,
 * SysTick, WFI. Also cases about stacks, alignment, cycle counts, the reset request, and a
 * computation that is interrupted anywhere.
 */
#include "cpu_cases.h"

#define PENDSVSET (1UL << 28)

static void pend1(void) {
    Case_pend(1);
}
static void pend12(void) {
    Case_pend(2);
    Case_pend(1);
}
static void pendSwitch(void) {
    SCB_ICSR = PENDSVSET;
}

void Case_nesting(void) {
    Case_priority(0, 0x80);
    Case_priority(1, 0x40);
    Case_action[16] = pend1;
    Case_pend(0);
}

void Case_samePriority(void) {
    Case_priority(0, 0x80);
    Case_priority(1, 0x80);
    Case_action[16] = pend1;
    Case_pend(0);
}

void Case_lowestNumberFirst(void) {
    Case_priority(0, 0x40);
    Case_priority(1, 0x80);
    Case_priority(2, 0x80);
    Case_action[16] = pend12;
    Case_pend(0);
}

/* PRIGROUP 6: bit 7 is the group priority, which can preempt; bits 6..4 are the subpriority, which
 * only sets the order */
void Case_subPriority(void) {
    SCB_AIRCR = 0x05FA0000UL | 6UL << 8;
    Case_priority(0, 0x70);
    Case_priority(1, 0x50);
    Case_priority(2, 0x40);
    Case_action[16] = pend12;
    Case_pend(0);
    SCB_AIRCR = 0x05FA0000UL;
}

static void primask(void) {
    Case_priority(0, 0x80);
    __asm__ volatile("cpsid i");
    Case_pend(0);
    Case_say('1');
    /* The handler must run right after the instruction that enables interrupts, so it sees the
     * value that r0 has there. */
    __asm__ volatile("mov r0, #5\n\tcpsie i\n\tmov r0, #6\n\tmov r0, #7" ::: "r0");
    Case_say('2');
}

static void saveR0(void) {
    value[0] = Case_frame[0];
}

void Case_primaskExact(void) {
    Case_action[16] = saveR0;
    primask();
}

void Case_basepri(void) {
    Case_priority(0, 0x80);
    Case_priority(1, 0x40);
    __asm__ volatile("msr basepri, %0" : : "r"(0x50));
    Case_pend(0);
    Case_say('1');
    Case_pend(1);
    Case_say('2');
    __asm__ volatile("msr basepri, %0" : : "r"(0));
    Case_say('3');
}

void Case_faultmask(void) {
    Case_priority(0, 0x00);
    __asm__ volatile("cpsid f");
    Case_pend(0);
    Case_say('1');
    __asm__ volatile("cpsie f");
    Case_say('2');
}

void Case_switchLast(void) {
    SCB_SHPR(14) = 0xF0;
    Case_priority(0, 0x80);
    Case_priority(1, 0xF0);
    Case_action[16] = pendSwitch;
    Case_action[17] = 0;
    Case_pend(0);
    __asm__ volatile("isb");
}

static void svcNumber(void) {
    value[0] = ((U8*)Case_frame[6])[-2];
}

void Case_supervisorCall(void) {
    Case_action[11] = svcNumber;
    __asm__ volatile("svc #42");
    Case_say('.');
}

static U32 tickAt[4], ticks;
static void noteTick(void) {
    if (ticks < 4U)
        tickAt[ticks++] = DWT_CYCCNT;
}

void Case_systick(void) {
    Case_countCycles();
    Case_action[15] = noteTick;
    SYST_RVR = 999;
    SYST_CVR = 0;
    SYST_CSR = 7;
    while (ticks < 4U)
        __asm__ volatile("wfi");
    SYST_CSR = 0;
    value[0] = tickAt[1] - tickAt[0];
    value[1] = tickAt[3] - tickAt[2];
}

void Case_sleepMasked(void) { /* WFI ends although PRIMASK blocks the interrupt */
    SYST_RVR = 99;
    SYST_CVR = 0;
    __asm__ volatile("cpsid i");
    SYST_CSR = 7;
    __asm__ volatile("wfi");
    Case_say('w');
    SYST_CSR = 0;
    __asm__ volatile("cpsie i");
    Case_say('.');
}

static void noteStacks(void) {
    U32 msp, psp;
    __asm__ volatile("mrs %0, msp\n\tmrs %1, psp" : "=r"(msp), "=r"(psp));
    value[0] = (U32)Case_frame - psp;
    value[1] = msp != psp;
}

static U32 processStack[64];

void Case_process(void) {
    U32 control;
    Case_priority(0, 0x80);
    Case_priority(1, 0x40);
    Case_action[16] = noteStacks;
    Case_action[17] = 0;
    __asm__ volatile("msr psp, %1\n\tmov %0, #2\n\tmsr control, %0\n\tisb\n\t"
                     "ldr r0, =0xE000E200\n\tmovs r1, #1\n\tstr r1, [r0]\n\tdsb\n\tisb\n\t"
                     "mrs %0, control\n\tmovs r0, #0\n\tmsr control, r0\n\tisb"
                     : "=&r"(control)
                     : "r"(&processStack[63])
                     : "r0", "r1", "memory");
    value[2] = control;
    value[3] = value[7]; /* EXC_RETURN */
}

/* If the stack pointer is not a multiple of 8, it is aligned at exception entry and restored at the
 * return. */
void Case_alignment(void) {
    U32 before, after;
    Case_priority(0, 0x80);
    Case_action[16] = noteStacks;
    __asm__ volatile(
        "sub sp, sp, #4\n\tmov %0, sp\n\tldr r0, =0xE000E200\n\tmovs r1, #1\n\tstr r1, [r0]\n\t"
        "dsb\n\tisb\n\tmov %1, sp\n\tadd sp, sp, #4"
        : "=&r"(before), "=&r"(after)
        :
        : "r0", "r1", "memory");
    value[2] = after - before;
    value[3] = (U32)Case_frame & 7UL;
}

void Case_cycles(void) {
    U32 start;
    Case_countCycles();
#define MEASURE(n, code)                                               \
    start = DWT_CYCCNT;                                                \
    __asm__ volatile(code ::: "r0", "r1", "r2", "r3", "cc", "memory"); \
    value[n] = DWT_CYCCNT - start;
    MEASURE(0, "")
    MEASURE(1, "nop\n\tnop\n\tnop\n\tnop\n\tnop\n\tnop\n\tnop\n\tnop\n\tnop\n\tnop")
    MEASURE(2, "ldr r0, [sp]\n\tldr r0, [sp]")
    MEASURE(3, "push {r0-r3}\n\tpop {r0-r3}")
    MEASURE(4, "b 1f\n\tnop\n1:")
    MEASURE(5, "movs r0, #0\n\tcbz r0, 1f\n\tnop\n1:")
    MEASURE(6,
            "movs r0, #1\n\tcmp r0, #2\n\titte eq\n\tmoveq r0, #3\n\tmoveq r0, #4\n\tmovne r0, #5")
}

void Case_resetRequest(void) {
    if (boots++ == 0) {
        SCB_AIRCR = SCB_AIRCR_RESET;
        for (;;)
            Case_say('!');
    }
    Case_say('r');
}

/* A computation with loops, IT blocks, multiple loads, calls and products. It must give the same
 * result wherever it is interrupted. */
static U32 mix(U32 a, U32 b) {
    return (a ^ b) * 2654435761UL + (a >> 7 | b << 25);
}

U32 Work_asm(U32 rounds) {
    U32 result = 0, i, words[8];
    for (i = 0; i < 8U; ++i)
        words[i] = i * 77U;
    for (i = 0; i < rounds; ++i) {
        __asm__ volatile(
            "ldm %1, {r0-r5}\n\tcmp r0, r1\n\tittee lo\n\taddlo r0, r0, r5\n\tsublo r2, r2, r1\n\t"
            "addhs r3, r3, r0\n\teorhs r4, r4, r2\n\tadcs r5, r5, r0\n\tstm %1, {r0-r5}\n\t"
            "it vs\n\tmvnvs %0, %0\n\tadds %0, %0, r4\n\tudiv r0, r5, r3\n\teor %0, %0, r0"
            : "+r"(result)
            : "r"(words)
            : "r0", "r1", "r2", "r3", "r4", "r5", "cc", "memory");
        result = mix(result, words[i & 7U]);
        words[6] += result % 13U;
    }
    return result;
}

void Case_work(void) {
    Case_priority(0, 0x80);
    Case_priority(1, 0x40);
    Case_action[16] = 0;
    value[0] = Work_asm(6);
}
