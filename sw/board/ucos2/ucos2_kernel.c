/* SPDX-License-Identifier: MIT
 *
 * ucos2_kernel: implements those functions of the board that depend on the kernel, for the original
 * uC/OS-II.
 */
#include "board.h"

#include <ucos_ii.h>

U32 Board_task(void) {
    return OSRunning ? OSPrioCur : 255U;
}
