/* SPDX-License-Identifier: MIT
 *
 * os_cpu: the interface that the kernel needs from a processor, with uC/OS-II's names. Host: tasks
 * are coroutines of one thread, and interrupts arrive only when simulated time passes, so runs
 * repeat exactly.
 */
#pragma once

typedef unsigned long OS_STK;
typedef unsigned int OS_CPU_SR;

/* Method 3: the interrupt-enable state is stored in a local variable. */
#define OS_CRITICAL_METHOD 3U
#define OS_ENTER_CRITICAL() (cpu_sr = OS_CPU_SR_Save())
#define OS_EXIT_CRITICAL() (OS_CPU_SR_Restore(cpu_sr))

OS_CPU_SR OS_CPU_SR_Save(void);
void OS_CPU_SR_Restore(OS_CPU_SR cpu_sr);
