/* SPDX-License-Identifier: MIT
 *
 * os_switch: switches tasks in PendSV. It saves the registers that the processor has not saved,
 * calls OS_Switch to get the stack of the next task, and restores the registers of that task.
 *
 * Stack of a suspended task, from its stack pointer upwards: r4..r11, then the frame that the
 * processor has pushed: r0..r3, r12, lr, pc, xPSR (ARMv7-M ARM, B1.5.6).
 */
    .syntax unified
    .thumb
    .section .text.PendSV_Handler, "ax"
    .global PendSV_Handler
    .type PendSV_Handler, %function
PendSV_Handler:
    cpsid   i
    mrs     r0, psp
    cbz     r0, 1f              /* first switch: there is no task to save */
    stmdb   r0!, {r4-r11}
1:  push    {r3, lr}            /* r3 is only pushed to keep the stack aligned */
    bl      OS_Switch
    pop     {r3, lr}
    ldmia   r0!, {r4-r11}
    msr     psp, r0
    orr     lr, lr, #4          /* returns to thread mode on the process stack */
    cpsie   i
    bx      lr
    .size PendSV_Handler, . - PendSV_Handler
