/* SPDX-License-Identifier: MIT
 *
 * os_m3: functions that the Cortex-M3 port needs from the board (sw/board), in addition to the idle
 * hook.
 */
#pragma once

#include "ucos_ii.h"

/* Places the stack guard. PendSV calls it with interrupts disabled before a task continues.
 * `bottom`: lowest address of the task's stack, or 0 if it is unknown (OSTaskCreate). */
void OS_TaskSwitched(OS_STK* bottom);

/* Called when the task with this priority has overflowed its stack; 255 means that a task has
 * returned. Must not return. */
void OS_StackFault(INT8U priority);
