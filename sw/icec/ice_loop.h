/* SPDX-License-Identifier: MIT
 *
 * ice_loop: handles arriving events, and waits for them; which of several tasks receives them.
 */
#ifndef ICE_LOOP_H
#define ICE_LOOP_H

#include "icec.h"

/* Handles at most one event; for the task that has the role of the receiver. ICE_TIMEOUT: there was
 * none; ICE_LIMIT: ICE_NESTING. */
Ice_Status icec_receiveOne(Ice_CommunicatorPtr ic, Ice_Int timeoutMs);

/* Receives, or lets another task receive, while `waits(ic, which)` holds; from within an operation,
 * too. `slot` belongs to the call that the task sleeps on. ICE_TIMEOUT, ICE_LIMIT. */
Ice_Status icec_await(Ice_CommunicatorPtr ic, int (*waits)(Ice_CommunicatorPtr ic, int which),
                      int which, int slot, Ice_Int timeoutMs);

/* ---- the role of the receiver (leader and followers): ice_receiver.c ---- */

typedef enum Icec_Role {
    ICEC_ROLE_NONE,  /* another task has it */
    ICEC_ROLE_TAKEN, /* to be returned by icec_giveRole */
    ICEC_ROLE_HAD    /* this task already had it: an operation calls this */
} Icec_Role;
/* The slot of Ice_Os in which tasks sleep that want to receive; 0..ICE_CALLS-1 belong to calls. */
#define ICEC_SERVER_SLOT ICE_CALLS
#define ICEC_FOREVER 0x7FFFFFFF /* a time-out: until the role is free, or shutdown is called */

/* Takes the role of the receiver for a server, waiting for it up to timeoutMs. */
Icec_Role icec_takeRole(Ice_CommunicatorPtr ic, Ice_Int timeoutMs);
void icec_giveRole(Ice_CommunicatorPtr ic);
/* Tells whether a task that waits for a reply must receive now. Such a task leads (`leads`) where
 * no other has or wants the role, and hands it to a server that wants it. */
int icec_mayReceive(Ice_CommunicatorPtr ic, int* leads);

#endif
