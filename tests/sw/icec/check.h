/* SPDX-License-Identifier: MIT
 *
 * check: what a client expects; where it is not so, it says the line, and the function returns 1.
 */
#ifndef CHECK_H
#define CHECK_H

#include <stdio.h>

#define CHECK(condition)                                                 \
    do {                                                                 \
        if (!(condition)) {                                              \
            printf("client.c:%d: not true: %s\n", __LINE__, #condition); \
            return 1;                                                    \
        }                                                                \
    } while (0)

#endif
