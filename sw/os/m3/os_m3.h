/* SPDX-License-Identifier: MIT
 *
 * os_m3: functions that the Cortex-M3 port requires from the board (sw/board), besides an idle
 * hook.
 */
#pragma once

#include "ucos_ii.h"

/* Called by PendSV with interrupts disabled, before a task continues, to place the stack guard.
 * `bottom`: lowest address of the task's stack, or 0 if unknown (OSTaskCreate). */
void OS_TaskSwitched(OS_STK* bottom);

/* Called when the task with this priority has overflowed its stack (255: a task has returned). Does
 * not return. */
void OS_StackFault(INT8U priority);
