/* SPDX-License-Identifier: MIT
 *
 * os_m3: functions that the Cortex-M3 port calls and the board (sw/board) implements, in addition
 * to the idle hook.
 */
#pragma once

#include "ucos_ii.h"

/* Places the stack guard. PendSV calls this function, with interrupts disabled, before a task
 * continues. `bottom` is the lowest address of the task's stack; 0 if it is unknown, as after
 * OSTaskCreate. */
void OS_TaskSwitched(OS_STK* bottom);

/* Called when the task with this priority has overflowed its stack; 255 means that a task has
 * returned from its function. Must not return. */
void OS_StackFault(INT8U priority);
