/* SPDX-License-Identifier: MIT
 *
 * ice_calls: the table of this side's calls whose replies have not come.
 */
#ifndef ICE_CALLS_H
#define ICE_CALLS_H

#include "icec.h"

/* Takes a slot for a call that is being built: a free one, or one that this task's last call has
 * kept. -1: all are taken. */
int icec_takeCall(Ice_CommunicatorPtr ic);
Ice_CallState icec_callState(Ice_CommunicatorPtr ic, int slot);

/* Hands a reply, read up to its body, to the call that waits for it. */
void icec_takeReply(Ice_CommunicatorPtr ic, int connection, Ice_InputStreamPtr is);
/* Finds an asynchronous call whose time is over, and its id; 0: there is none. Shortens `waitMs` to
 * the next call's time; under the state lock. */
Ice_Call* icec_expiredCall(Ice_CommunicatorPtr ic, U32 now, Ice_Int* id, Ice_Int* waitMs);
/* Ends that call, unless it has ended meanwhile. */
void icec_expireCall(Ice_CommunicatorPtr ic, Ice_Call* call, Ice_Int id);
/* Marks a connection as closed, and fails its calls with `status`. */
void icec_loseConnection(Ice_CommunicatorPtr ic, int connection, Ice_Status status);
/* Wakes every task that is making a call; under the state lock. */
void icec_wakeCalls(Ice_CommunicatorPtr ic);

#endif
