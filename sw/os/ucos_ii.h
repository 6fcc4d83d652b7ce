/* SPDX-License-Identifier: MIT
 *
 * ucos_ii: the part of uC/OS-II's API (2.9x) that the firmware uses. Names, argument orders, error
 * codes and blocking rules are the same as in uC/OS-II, so that the original kernel can replace
 * this one. Manual: "MicroC/OS-II, The Real-Time Kernel", chapter 16. Time-outs and delays count
 * ticks of 1/OS_TICKS_PER_SEC s.
 */
#pragma once

#include "base.h"
#include "os_cfg.h"
#include "os_cpu.h"

typedef U8 BOOLEAN;
typedef U8 INT8U;
typedef U16 INT16U;
typedef U32 INT32U;

#define OS_FALSE 0U
#define OS_TRUE 1U

#define OS_ERR_NONE 0U
#define OS_ERR_EVENT_TYPE 1U /* the event has another type */
#define OS_ERR_PEND_ISR 2U   /* a call that only tasks may make was made from an interrupt */
#define OS_ERR_POST_NULL_PTR 3U
#define OS_ERR_PEVENT_NULL 4U
#define OS_ERR_POST_ISR 5U /* an interrupt cannot own a mutex */
#define OS_ERR_PDATA_NULL 9U
#define OS_ERR_TIMEOUT 10U
#define OS_ERR_PEND_LOCKED 13U /* the scheduler is locked */
#define OS_ERR_CREATE_ISR 16U
#define OS_ERR_Q_FULL 30U
#define OS_ERR_Q_EMPTY 31U
#define OS_ERR_PRIO_EXIST 40U /* the priority is taken */
#define OS_ERR_PRIO_INVALID 42U
#define OS_ERR_SEM_OVF 51U
#define OS_ERR_TASK_CREATE_ISR 60U
#define OS_ERR_TASK_NO_MORE_TCB 66U
#define OS_ERR_TASK_NOT_EXIST 67U
#define OS_ERR_TASK_OPT 69U /* the task was created without OS_TASK_OPT_STK_CHK */
#define OS_ERR_NOT_MUTEX_OWNER 100U
#define OS_ERR_PIP_LOWER 120U /* the owner's priority is higher than the ceiling of the mutex */

typedef struct os_event OS_EVENT;

void OSInit(void);
/* Runs the tasks. On the target it does not return. */
void OSStart(void);

/* Creates a task. `prio` is 0 (highest) to OS_LOWEST_PRIO - 1; each task needs a different
 * priority. `ptos` is the highest address of the task's stack. */
INT8U OSTaskCreate(void (*task)(void* p_arg), void* p_arg, OS_STK* ptos, INT8U prio);

#define OS_TASK_OPT_NONE 0U
#define OS_TASK_OPT_STK_CHK 1U /* allows OSTaskStkChk for this task */
/* fills the stack with zeros, so that OSTaskStkChk can count the unused words */
#define OS_TASK_OPT_STK_CLR 2U

/* Creates a task like OSTaskCreate, with the bounds of the task's stack: `pbos` is the lowest
 * address of the stack, `stk_size` the size of the stack in units of OS_STK. `id` and `pext` have
 * no effect; they are parameters of uC/OS-II. */
INT8U OSTaskCreateExt(void (*task)(void* p_arg), void* p_arg, OS_STK* ptos, INT8U prio, INT16U id,
                      OS_STK* pbos, INT32U stk_size, void* pext, INT16U opt);

typedef struct os_stk_data {
    /* sizes of the free and the used part of the stack, in units of OS_STK */
    INT32U OSFree, OSUsed;
} OS_STK_DATA;

/* Reports how much of a task's stack was used at most so far. */
INT8U OSTaskStkChk(INT8U prio, OS_STK_DATA* p_stk_data);

/* Returns the priority of the running task. In uC/OS-II this is the variable OSPrioCur. */
INT8U OSTaskPrio(void);

extern INT8U OSPrioCur; /* priority with which the current task is running; must not be written */

void OSTimeDly(INT32U ticks);
INT32U OSTimeGet(void);
void OSTimeTick(void); /* to be called by the tick interrupt, between OSIntEnter and OSIntExit */

/* Functions for semaphores. A time-out of 0 means no limit. *perr is set to OS_ERR_NONE,
 * OS_ERR_TIMEOUT, or the error of the call. */
OS_EVENT* OSSemCreate(INT16U cnt);
void OSSemPend(OS_EVENT* pevent, INT32U timeout, INT8U* perr);
INT8U OSSemPost(OS_EVENT* pevent);
INT16U OSSemAccept(OS_EVENT* pevent);

/* Functions for mutexes. `prio` is the ceiling: the priority that an owner inherits while a task of
 * higher priority waits. No task may have this priority.
 */
OS_EVENT* OSMutexCreate(INT8U prio, INT8U* perr);
void OSMutexPend(OS_EVENT* pevent, INT32U timeout, INT8U* perr);
INT8U OSMutexPost(OS_EVENT* pevent);

OS_EVENT* OSQCreate(void** start, INT16U size);
void* OSQPend(OS_EVENT* pevent, INT32U timeout, INT8U* perr);
INT8U OSQPost(OS_EVENT* pevent, void* pmsg);

void OSIntEnter(void);
void OSIntExit(void);
void OSSchedLock(void);
void OSSchedUnlock(void);
