/* SPDX-License-Identifier: MIT
 *
 * firmware: the program: kernel, application, watchdog task. Two files implement what differs
 * between kernels: own_kernel.c and ucos2/.
 */
#ifndef FIRMWARE_H
#define FIRMWARE_H

#include "ucos_ii.h"

/* Runs the program, from reset once memory is set up; does not return. */
void Firmware_run(void);

#endif
