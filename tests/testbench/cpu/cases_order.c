/* SPDX-License-Identifier: MIT
 *
 * cases_order: order and time of exceptions: priorities, masks, PendSV, SVC, SysTick, WFI.
 */
#include "cpu_cases.h"

#define DWT_CYCCNT REG(0xE0001004UL)
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

void Case_subPriority(void) { /* PRIGROUP 6: bit 7 preempts, bits 6..4 only order */
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
    /* The handler sees r0 as it was when interrupts were enabled: not one instruction later. */
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

void Case_sleepMasked(void) { /* WFI wakes, though PRIMASK keeps the interrupt from being taken */
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
