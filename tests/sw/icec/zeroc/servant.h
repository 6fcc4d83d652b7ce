/* SPDX-License-Identifier: MIT
 *
 * servant: shared by the servants for ZeroC's test suites.
 */
#ifndef ZEROC_SERVANT_H
#define ZEROC_SERVANT_H

#include "serve.h"

#include <string.h>

/* Returns `count` elements of `a`, then those of `b`, in the arena; 0: no room. */
void* Suite_joined(const Ice_Current* current, const void* a, Ice_Int countA, const void* b,
                   Ice_Int countB, size_t element);
void* Suite_reversed(const Ice_Current* current, const void* a, Ice_Int count, size_t element);
#define SET(out, room, count) \
    do {                      \
        (out)->data = room;   \
        (out)->size = count;  \
        if (!(out)->data)     \
            return ICE_LIMIT; \
    } while (0)
#define JOIN(out, a, b)                                                                            \
    SET(out, Suite_joined(current, (a)->data, (a)->size, (b)->data, (b)->size, sizeof *(a)->data), \
        (a)->size + (b)->size)
#define REVERSE(out, a) \
    SET(out, Suite_reversed(current, (a)->data, (a)->size, sizeof *(a)->data), (a)->size)
/* Makes a dictionary: `a` with the entries of `b`; `b` wins. SAME compares the keys x and y. */
#define MERGE(out, a, b, SAME)                                                                 \
    do {                                                                                       \
        Ice_Int i, j;                                                                          \
        JOIN(out, a, b);                                                                       \
        (out)->size = (a)->size;                                                               \
        for (i = 0; i < (b)->size; ++i) {                                                      \
            for (j = 0; j < (out)->size && !SAME((b)->data[i].key, (out)->data[j].key); ++j) { \
            }                                                                                  \
            (out)->data[j] = (b)->data[i];                                                     \
            (out)->size += j == (out)->size;                                                   \
        }                                                                                      \
    } while (0)
#define SAME_NUMBER(x, y) ((x) == (y))
#define SAME_LONG(x, y) ((x).low == (y).low && (x).high == (y).high)
#define SAME_TEXT(x, y) ((x).size == (y).size && memcmp((x).data, (y).data, (size_t)(x).size) == 0)

#define SHUTDOWN Ice_Communicator_shutdown(current->communicator)
/* An exception outside of the operation's list, in the sliced format where `isSliced`. */
#define THROW(exception, Type, isSliced)                 \
    do {                                                 \
        Ice_Reply reply;                                 \
        Ice_OutputStreamPtr os;                          \
        Ice_Current_later(current, &reply);              \
        os = Ice_Reply_begin(&reply);                    \
        os->sliced = isSliced;                           \
        Type##_writeToOutputStream(exception, os);       \
        (void)Ice_Reply_end(&reply, ICE_USER_EXCEPTION); \
        return ICE_LATER;                                \
    } while (0)

#endif
