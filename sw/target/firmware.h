/* SPDX-License-Identifier: MIT
 *
 * firmware: the program: kernel, application, watchdog task. The differences between kernels are in
 * own_kernel.c and ucos2/.
 */
#ifndef FIRMWARE_H
#define FIRMWARE_H

#include "ucos_ii.h"

/* Runs the program after reset, once memory is set up. Does not return. */
void Firmware_run(void);

#endif
