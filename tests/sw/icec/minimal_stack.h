/* SPDX-License-Identifier: MIT
 *
 * minimal_stack: IceC, endpoint and link in their minimal configurations, as a library that a test
 * with the full ones loads.
 */
#ifndef MINIMAL_STACK_H
#define MINIMAL_STACK_H

#include "base.h"

/* The test's side; `context` is passed back. */
typedef struct Stack_World {
    int (*transmit)(void* context, const U8* frame, U32 size); /* as Link_Port's */
    U32 (*receive)(void* context, U8* bytes); /* a packet of up to 100 bytes; 0: none has come */
    void (*step)(void* context);              /* lets 1 ms pass for everybody else */
    U32 (*nowUs)(void* context);
} Stack_World;

void Stack_init(const Stack_World* world, void* context);
void Stack_poll(void);      /* what has come from the air, and one event of IceC, without waiting */
int Stack_twice(int value); /* calls `twice` of the ground's "station"; -1000 - status on failure */
int Stack_notify(int value);  /* the same oneway, which has no result; 0: sent */
int Stack_served(void);       /* operations of "vehicle" so far: twice, and notify */
int Stack_lastNotified(void); /* the value of the last notify that came */

#endif
