/* SPDX-License-Identifier: MIT
 *
 * os_cfg: sizes of the kernel, with uC/OS-II's names.
 */
#pragma once

#define OS_LOWEST_PRIO 63U     /* lowest priority, which the idle task has */
#define OS_MAX_TASKS 8U        /* maximum number of tasks without the idle task */
#define OS_MAX_EVENTS 16U      /* maximum number of semaphores, mutexes and queues together */
#define OS_TICKS_PER_SEC 1000U /* frequency of calls of OSTimeTick, Hz */
