/* SPDX-License-Identifier: MIT
 *
 * loop_endpoint: IceC's transport between two communicators of one process and one task, for tests.
 *
 * Time is simulated: it passes only where a communicator waits and nothing can happen. Without a
 * peer, messages go to `tap` alone, and LoopEndpoint_inject plays the other side.
 */
#ifndef LOOP_ENDPOINT_H
#define LOOP_ENDPOINT_H

#include "icec.h"

#define LOOP_ENDPOINT_TYPE 0x4C50
#define LOOP_EVENTS 16

typedef struct LoopEndpoint LoopEndpoint;

struct LoopEndpoint {
    Ice_CommunicatorPtr ic;
    LoopEndpoint* peer; /* 0: none */
    U32* nowMs;         /* the clock that both ends share */
    U32 ownNowMs;
    Ice_Byte first; /* connections that this side makes: this number, and this + 2 */
    Ice_Byte open[ICE_CONNECTIONS];
    Ice_Byte silent; /* connections can be made, but nobody answers */
    int running;     /* in the peer's loop */
    unsigned head, count;
    Ice_Event events[LOOP_EVENTS];
    Ice_Byte data[LOOP_EVENTS][ICE_MESSAGE_MAX];
    /* Sees every message that is sent; may be 0. */
    void (*tap)(void* context, int connection, const Ice_Byte* message, Ice_Int size);
    void* tapContext;
};

void LoopEndpoint_init(Ice_CommunicatorPtr ic, LoopEndpoint* self);
/* Joins two sides: one receives what the other sends. */
void LoopEndpoint_join(LoopEndpoint* a, LoopEndpoint* b);
/* Plays a peer: queues an event. ICE_LIMIT: the queue is full. */
Ice_Status LoopEndpoint_inject(LoopEndpoint* self, Ice_EventKind kind, int connection,
                               const Ice_Byte* message, Ice_Int size);

#endif
