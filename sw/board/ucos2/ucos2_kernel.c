/* SPDX-License-Identifier: MIT
 *
 * ucos2_kernel: implements the board's functions for the real uC/OS-II.
 */
#include "board.h"

#include <ucos_ii.h>

U32 Board_task(void) {
    return OSRunning ? OSPrioCur : 255U;
}
