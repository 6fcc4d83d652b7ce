/* SPDX-License-Identifier: MIT
 *
 * program_memory: symbols that firmware.ld defines, and the first step of a program: initialising
 * its variables.
 */
#pragma once

#include "base.h"

typedef void (*Vector)(void);

extern void stack_top(void);
extern U32 data_begin[], data_end[], data_load[], bss_begin[], bss_end[];

static void startMemory(void) {
    U32* to;
    const U32* from = data_load;
    for (to = data_begin; to < data_end;)
        *to++ = *from++;
    for (to = bss_begin; to < bss_end;)
        *to++ = 0;
}
