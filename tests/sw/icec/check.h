/* SPDX-License-Identifier: MIT
 *
 * check: a client's expectation; a failed one prints its line, and the function returns 1.
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
