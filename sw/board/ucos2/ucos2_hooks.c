/* SPDX-License-Identifier: MIT
 *
 * ucos2_hooks: the hooks that the original uC/OS-II requires from an application, and the name that
 * our vector table uses for its PendSV handler.
 */
#include "guard.h"

#include <ucos_ii.h>

void PendSV_Handler(void);

void __attribute__((naked)) PendSV_Handler(void) {
    __asm__ volatile("b OS_CPU_PendSVHandler");
}

void App_TaskIdleHook(void) {
    __asm__ volatile("wfi");
}

void App_TaskSwHook(void) {
    Guard_place(OSTCBHighRdy->OSTCBStkBottom);
}

void App_TaskCreateHook(OS_TCB* ptcb) {
    (void)ptcb;
}

void App_TaskDelHook(OS_TCB* ptcb) {
    (void)ptcb;
}

void App_TaskReturnHook(OS_TCB* ptcb) {
    (void)ptcb;
}

void App_TaskStatHook(void) {}

void App_TCBInitHook(OS_TCB* ptcb) {
    (void)ptcb;
}
