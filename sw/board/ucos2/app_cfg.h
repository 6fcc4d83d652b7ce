/* SPDX-License-Identifier: MIT
 *
 * app_cfg: configuration of uC/OS-II's ARMv7-M port. Interrupts of priority 0x40 and more may call
 * it.
 */
#pragma once

#define CPU_CFG_KA_IPL_BOUNDARY 4u
#define CPU_CFG_NVIC_PRIO_BITS 4u

/* Our kernel's OSTaskPrio: a number that differs from task to task, whatever priority it
 * inherits. */
#define OSTaskPrio() ((INT8U)(OSTCBCur - OSTCBTbl))
