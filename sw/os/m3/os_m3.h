/* SPDX-License-Identifier: MIT
 *
 * os_m3: what the Cortex-M3 port asks of the board (sw/board), besides an idle hook.
 */
#pragma once

#include "ucos_ii.h"

/* PendSV calls this before a task goes on, with interrupts off, to place a guard. `bottom` is the
 * lowest address of the task's stack, 0 where unknown (OSTaskCreate). */
void OS_TaskSwitched(OS_STK* bottom);

/* The task with this priority has run over the end of its stack (255: a task has returned). Does
 * not return. */
void OS_StackFault(INT8U priority);
