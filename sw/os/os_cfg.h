/* SPDX-License-Identifier: MIT
 *
 * os_cfg: sizes of the kernel, under uC/OS-II's own names.
 */
#pragma once

#define OS_LOWEST_PRIO 63U     /* the idle task's priority */
#define OS_MAX_TASKS 8U        /* without the idle task */
#define OS_MAX_EVENTS 16U      /* semaphores, mutexes and queues together */
#define OS_TICKS_PER_SEC 1000U /* calls of OSTimeTick a second */
