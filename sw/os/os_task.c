/* SPDX-License-Identifier: MIT
 *
 * os_task: creates tasks, and measures the use of their stacks.
 */
#include "os_core.h"

U8 OS_TaskMake(void (*task)(void*), void* argument, OS_STK* ptos, U8 priority,
               const OS_Task* stack) {
    OS_Task* t = 0;
    U32 i;
    for (i = 0; i <= OS_MAX_TASKS && !t; ++i)
        if (!os_kernel.tasks[i].used)
            t = &os_kernel.tasks[i];
    if (!t)
        return OS_ERR_TASK_NO_MORE_TCB;
    t->used = 1;
    t->priority = t->base = priority;
    t->delay = 0;
    t->event = 0;
    t->bottom = stack->bottom;
    t->words = stack->words;
    t->options = stack->options;
    for (i = 0; stack->options & OS_TASK_OPT_STK_CLR && i < t->words; ++i)
        t->bottom[i] = 0;
    t->stack = OSTaskStkInit(task, argument, ptos, 0);
    os_kernel.byPriority[priority] = t;
    OS_SET_ADD(&os_kernel.ready, priority);
    return OS_ERR_NONE;
}

static INT8U create(void (*task)(void*), void* argument, OS_STK* ptos, U8 prio,
                    const OS_Task* stack) {
    OS_CPU_SR cpu_sr;
    INT8U error;
    if (prio >= OS_LOWEST_PRIO)
        return OS_ERR_PRIO_INVALID;
    if (os_kernel.interruptNesting)
        return OS_ERR_TASK_CREATE_ISR;
    OS_ENTER_CRITICAL();
    error =
        OS_PriorityTaken(prio) ? OS_ERR_PRIO_EXIST : OS_TaskMake(task, argument, ptos, prio, stack);
    OS_EXIT_CRITICAL();
    if (error == OS_ERR_NONE && os_kernel.running)
        OS_Sched();
    return error;
}

INT8U OSTaskCreate(void (*task)(void* p_arg), void* p_arg, OS_STK* ptos, INT8U prio) {
    static const OS_Task unknown;
    return create(task, p_arg, ptos, prio, &unknown);
}

INT8U OSTaskCreateExt(void (*task)(void* p_arg), void* p_arg, OS_STK* ptos, INT8U prio, INT16U id,
                      OS_STK* pbos, INT32U stk_size, void* pext, INT16U opt) {
    OS_Task stack;
    (void)id;
    (void)pext;
    stack.bottom = pbos;
    stack.words = stk_size;
    stack.options = opt;
    return create(task, p_arg, ptos, prio, &stack);
}

INT8U OSTaskStkChk(INT8U prio, OS_STK_DATA* p_stk_data) {
    OS_Task* task;
    U32 free = 0;
    if (prio > OS_LOWEST_PRIO)
        return OS_ERR_PRIO_INVALID;
    if (!p_stk_data)
        return OS_ERR_PDATA_NULL;
    p_stk_data->OSFree = p_stk_data->OSUsed = 0;
    task = os_kernel.byPriority[prio];
    if (!task)
        return OS_ERR_TASK_NOT_EXIST;
    if (!(task->options & OS_TASK_OPT_STK_CHK))
        return OS_ERR_TASK_OPT;
    while (free < task->words && task->bottom[free] == 0)
        ++free;
    p_stk_data->OSFree = free;
    p_stk_data->OSUsed = task->words - free;
    return OS_ERR_NONE;
}

INT8U OSTaskPrio(void) {
    return os_kernel.current->base;
}
