/* SPDX-License-Identifier: MIT
 *
 * os_cpu: the interface between kernel and processor, with uC/OS-II's names, for a host. Tasks are
 * coroutines of one thread. Interrupts arrive only when simulated time advances, so every run can
 * be repeated exactly.
 */
#pragma once

typedef unsigned long OS_STK;
typedef unsigned int OS_CPU_SR;

/* Method 3 of uC/OS-II: a local variable stores whether interrupts were enabled. */
#define OS_CRITICAL_METHOD 3U
#define OS_ENTER_CRITICAL() (cpu_sr = OS_CPU_SR_Save())
#define OS_EXIT_CRITICAL() (OS_CPU_SR_Restore(cpu_sr))

OS_CPU_SR OS_CPU_SR_Save(void);
void OS_CPU_SR_Restore(OS_CPU_SR cpu_sr);
