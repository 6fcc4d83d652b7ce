/* SPDX-License-Identifier: MIT
 *
 * m3_runner: runs one case on a Cortex-M3. It contains the vectors, the tick, the interrupt, and a
 * breakpoint at the end.
 */
#include "boot.h"
#include "os_cases.h"
#include "program_memory.h"
#include "stm32f2.h"

#define TICK_CYCLES 4000UL
#define IRQ_PRIORITY 0x50U
#define TICK_PRIORITY 0x60U
#define SWITCH_PRIORITY 0xF0U

extern void PendSV_Handler(void);

void Reset_Handler(void);
void SysTick_Handler(void);
void Irq_Handler(void);

/* number of the case; the test writes it */
unsigned selected_case __attribute__((section(".noinit")));
static unsigned ticksLeft;

static void fault(void) {
    __asm__ volatile("bkpt #2");
}

void Boot_fail(Boot_Reason reason, U32 pc, U32 lr, U32 address) { /* own_kernel's */
    (void)reason, (void)pc, (void)lr, (void)address;
    __asm__ volatile("bkpt #3");
}

__attribute__((section(".vectors"), used)) static const Vector vectors[17] = {
    stack_top, /* initial stack pointer; all other entries are functions */
    Reset_Handler, fault, fault, fault,          fault,           fault,      0, 0, 0, 0,
    fault,         fault, 0,     PendSV_Handler, SysTick_Handler, Irq_Handler};

void Reset_Handler(void) {
    startMemory();
    SCB_SHCSR |= SCB_SHCSR_FAULTS;
    SCB_SHPR(15) = TICK_PRIORITY;
    SCB_SHPR(14) = SWITCH_PRIORITY;
    NVIC_IPR(0) = IRQ_PRIORITY;
    NVIC_ISER(0) = 1;
    OSInit();
    ticksLeft = os_cases[selected_case].ticks;
    os_cases[selected_case].prepare();
    __asm__ volatile("cpsid i");
    SYST_RVR = TICK_CYCLES - 1UL;
    SYST_CVR = 0;
    SYST_CSR = SYST_CSR_ON;
    OSStart();
}

void SysTick_Handler(void) {
    OSIntEnter();
    if (ticksLeft-- == 0)
        __asm__ volatile("bkpt #1");
    OSTimeTick();
    OSIntExit();
}

void Irq_Handler(void) {
    OSIntEnter();
    os_cases[selected_case].interrupt();
    OSIntExit();
}

void Runner_interrupt(void) {
    REG(0xE000E200UL) = 1; /* NVIC_ISPR0 */
    __asm__ volatile("dsb\n\tisb");
}

void Runner_passTime(void) {}
