/* SPDX-License-Identifier: MIT
 *
 * os_cpu: the interface between kernel and processor, with uC/OS-II's names, for the Cortex-M3.
 * Critical sections set PRIMASK. Tasks are switched in PendSV, which has the lowest priority, so
 * that it runs after all interrupts.
 */
#pragma once

typedef unsigned int OS_STK;
typedef unsigned int OS_CPU_SR;

/* Method 3 of uC/OS-II: a local variable stores whether interrupts were enabled. */
#define OS_CRITICAL_METHOD 3U
#define OS_ENTER_CRITICAL() (cpu_sr = OS_CPU_SR_Save())
#define OS_EXIT_CRITICAL() (OS_CPU_SR_Restore(cpu_sr))

#define OS_INLINE static __inline__ __attribute__((always_inline, unused))

OS_INLINE OS_CPU_SR OS_CPU_SR_Save(void) {
    OS_CPU_SR was;
    __asm__ volatile("mrs %0, primask\n\tcpsid i" : "=r"(was) : : "memory");
    return was;
}

OS_INLINE void OS_CPU_SR_Restore(OS_CPU_SR cpu_sr) {
    __asm__ volatile("msr primask, %0\n\tisb" : : "r"(cpu_sr) : "memory");
}
