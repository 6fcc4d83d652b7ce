/* SPDX-License-Identifier: MIT
 *
 * os_m3: the kernel's port to the Cortex-M3: prepares the stack of a new task, starts the first
 * task, selects the next task in PendSV, and places the stack guard.
 */
#include "os_m3.h"
#include "os_core.h"

#define ICSR (*(volatile U32*)0xE000ED04UL)
#define ICSR_PENDSVSET (1UL << 28)
#define SHPR3 (*(volatile U32*)0xE000ED20UL)
#define XPSR_THUMB 0x01000000UL

U32* OS_Switch(U32* sp); /* called by os_switch.S */

/* The running task; 0 before the first task starts. Debuggers look for this name. */
static OS_Task* os_running;

static void taskReturned(void) {
    /* a task has returned, which is not allowed; handled like a stack overflow */
    OS_StackFault(0xFFU);
}

OS_STK* OSTaskStkInit(void (*task)(void* p_arg), void* p_arg, OS_STK* ptos, INT16U opt) {
    /* The frame must begin at a multiple of 8 (AAPCS). */
    OS_STK* stack = (OS_STK*)((U32)(ptos + 1) & ~7UL);
    int i;
    (void)opt;
    *--stack = XPSR_THUMB;
    *--stack = (OS_STK)task;
    *--stack = (OS_STK)taskReturned;
    for (i = 0; i < 4; ++i)
        *--stack = 0; /* r12, r3..r1 */
    *--stack = (OS_STK)p_arg;
    for (i = 0; i < 8; ++i)
        *--stack = 0; /* r11..r4 */
    return stack;
}

void OSCtxSw(OS_Task* from, OS_Task* to) {
    (void)from;
    (void)to; /* not needed, because PendSV switches to os_kernel.current */
    ICSR = ICSR_PENDSVSET;
    /* ensures that PendSV is pending before the caller enables interrupts */
    __asm__ volatile("dsb");
}

void OSStartHighRdy(void) {
    os_running = 0;
    SHPR3 |= 0xFFUL << 16; /* sets the lowest priority for PendSV */
    __asm__ volatile("msr psp, %0" : : "r"(0));
    ICSR = ICSR_PENDSVSET;
    __asm__ volatile("cpsie i\n\tisb");
    for (;;) /* never reached, because PendSV switches to the first task */
        ;
}

/* Selects the next task; PendSV calls this function with interrupts disabled. `sp` points to the
 * saved registers of the task that was running. Returns the pointer to the saved registers of the
 * next task. */
U32* OS_Switch(U32* sp) {
    if (os_running) {
        os_running->stack = sp;
        if (os_running->bottom && (sp < os_running->bottom || *os_running->bottom != 0))
            OS_StackFault(os_running->base);
    }
    os_running = os_kernel.current;
    OS_TaskSwitched(os_running->bottom);
    return os_running->stack;
}
