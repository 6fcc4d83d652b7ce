/* SPDX-License-Identifier: MIT
 *
 * guard: a task that runs over the end of its stack gets a MemManage fault before it harms
 * another's.
 */
#pragma once

#include "ucos_ii.h"

/* Forbids writing to the lowest 32 bytes of a stack (aligned to 32); 0 removes the guard. Called at
 * each switch, with interrupts off. */
void Guard_place(const OS_STK* bottom);
