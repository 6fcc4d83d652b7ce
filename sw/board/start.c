/* SPDX-License-Identifier: MIT
 *
 * start: vector table, code that runs before main, fault handlers.
 */
#include "board.h"
#include "boot.h"
#include "program.h"
#include "program_memory.h"
#include "stm32f2.h"

extern void PendSV_Handler(void);

void Reset_Handler(void);
void Fault_Handler(void);
void Fault_entered(const U32* frame, U32 number);

/* Calls the handler of a fault with the address of the exception frame; bit 2 of EXC_RETURN selects
 * the stack. */
void __attribute__((naked)) Fault_Handler(void) {
    __asm__ volatile("tst lr, #4\n\t"
                     "ite eq\n\t"
                     "mrseq r0, msp\n\t"
                     "mrsne r0, psp\n\t"
                     "mrs r1, ipsr\n\t"
                     "b Fault_entered");
}

void Fault_entered(const U32* frame, U32 number) {
    static const Boot_Reason reasons[] = {BOOT_HARD_FAULT, BOOT_STACK_OVERFLOW, BOOT_BUS_FAULT,
                                          BOOT_USAGE_FAULT};
    U32 status = SCB_CFSR;
    U32 address = status & SCB_CFSR_MMFARVALID  ? SCB_MMFAR
                  : status & SCB_CFSR_BFARVALID ? SCB_BFAR
                                                : 0;
    Boot_Reason reason = number >= 3U && number <= 6U ? reasons[number - 3U] : BOOT_HARD_FAULT;
    Boot_fail(reason, frame[6], frame[5], address);
}

__attribute__((section(".vectors"), used)) static const Vector vectors[16 + 7] = {
    stack_top, /* initial stack pointer, not a function */
    Reset_Handler,
    Fault_Handler, /* NMI */
    Fault_Handler, /* HardFault */
    Fault_Handler, /* MemManage: a stack overflow, because the MPU guards the ends of the stacks */
    Fault_Handler, /* BusFault */
    Fault_Handler, /* UsageFault */
    0,
    0,
    0,
    0,
    Fault_Handler, /* SVC */
    Fault_Handler, /* DebugMonitor */
    0,
    PendSV_Handler,
    SysTick_Handler,
    Fault_Handler, /* first of interrupts 0 to 5, which are never enabled */
    Fault_Handler,
    Fault_Handler,
    Fault_Handler,
    Fault_Handler,
    Fault_Handler,
    EXTI0_Handler};

void Reset_Handler(void) {
    Board_start();
    startMemory();
    Boot_begin();
    if (!Boot_imageIsSound())
        Boot_refuse();
    Program_run();
}
