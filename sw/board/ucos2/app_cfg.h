/* SPDX-License-Identifier: MIT
 *
 * app_cfg: configures uC/OS-II's ARMv7-M port. Interrupts with a priority of 0x40 or more may call
 * the kernel.
 */
#pragma once

#define CPU_CFG_KA_IPL_BOUNDARY 4u
#define CPU_CFG_NVIC_PRIO_BITS 4u

/* Replaces OSTaskPrio of our kernel: returns a number of the running task. The number is different
 * for each task, and does not change when the task inherits a priority. */
#define OSTaskPrio() ((INT8U)(OSTCBCur - OSTCBTbl))
