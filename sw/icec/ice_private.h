/* SPDX-License-Identifier: MIT
 *
 * ice_private: declares the functions that the files of the full run time share, lowest layer
 * first.
 */
#pragma once

#include "ice_message.h"

/* ---- ice_transport: transports, locks and time; states of the connections, and sending on them
 * ---- */

/* Number of transports, for use in loops. If ICE_TRANSPORTS is 1, the compiler removes the loop. */
#define ICEC_TRANSPORTS(ic) (ICE_TRANSPORTS == 1 ? 1 : (ic)->transportCount)

/* Takes a lock. `which` is ICE_LOCK_STATE or ICE_LOCK_SEND. */
#define icec_lock(ic, which) ((ic)->os->lock((ic)->osContext, which))
#define icec_unlock(ic, which) ((ic)->os->unlock((ic)->osContext, which))

/* Returns milliseconds since an arbitrary time; the count wraps. */
U32 icec_nowMs(Ice_CommunicatorPtr ic);

/* Makes the receiving task return early from its wait. */
void icec_wake(Ice_CommunicatorPtr ic);

/* Characters that separate words in the string form of proxies and endpoints; the same as in
 * Ice. */
#define ICEC_SPACES " \t\n\r"

/* Returns the options after the name of a transport, and sets `transport`. Returns 0 if the text
 * does not begin with the name of a transport. */
const char* icec_optionsOf(Ice_CommunicatorPtr ic, const char* text, int* transport);
/* Returns the text after the next colon outside quotes; 0 if no such colon exists. */
const char* icec_nextEndpoint(const char* text);
/* Adds an endpoint of a transport to a proxy; if `options` is 0, the endpoint on which this side
 * listens. Returns ICE_LIMIT if the endpoints exceed ICE_ENDPOINT_MAX. */
Ice_Status icec_addEndpoint(Ice_ObjectPrxPtr prx, int transport, const char* options);

/* Replaces escape sequences as Ice does, and writes the text to `os`. The character `special` may
 * also be escaped; unknown escape sequences are kept. Fails `os` if an escape sequence is
 * malformed, or if the text contains control characters. */
void icec_unescape(Ice_String text, char special, Ice_OutputStreamPtr os);
/* Returns the status that corresponds to a failed stream: ICE_PARSE if the text is malformed,
 * otherwise ICE_LIMIT. */
#define icec_parseFailure(os) ((os)->failed == ICE_FAILED_MALFORMED ? ICE_PARSE : ICE_LIMIT)

/* Sends the complete message in `os`; the caller holds ICE_LOCK_SEND. Returns
 * ICE_CONNECTION_LOST if the connection has ended. */
Ice_Status icec_send(Ice_CommunicatorPtr ic, int connection, Ice_OutputStreamPtr os);
/* Sends a message without a body: ICEC_VALIDATE or ICEC_CLOSE. */
Ice_Status icec_sendHead(Ice_CommunicatorPtr ic, int connection, Ice_Byte type);

/* Records that a connection with this number has begun; the caller holds the state lock. */
void icec_openConnection(Ice_CommunicatorPtr ic, int connection, Ice_ConnectionState state);
/* Lets the transport close the connection. Calls that wait for a reply on this connection still
 * wait afterwards: icec_loseConnection ends them. */
void icec_closeConnection(Ice_CommunicatorPtr ic, int connection);
Ice_ConnectionState icec_connectionState(Ice_CommunicatorPtr ic, int connection);

/* Sends CloseConnection, once per connection. The message informs the peer that its pending
 * requests were not executed; the peer then closes the connection. While operations are in
 * progress, sends nothing; the function must be called again after their replies. */
void icec_askToClose(Ice_CommunicatorPtr ic, int connection);
int icec_isStopping(Ice_CommunicatorPtr ic);

/* Adds `change` to the number of operations in progress on a connection. Returns 0 if the
 * connection of this `generation` has ended. */
int icec_countPending(Ice_CommunicatorPtr ic, int connection, U16 generation, int change);

/* Gives `is` the part of the communicator's arena that no operation in progress uses. */
void icec_giveArena(Ice_CommunicatorPtr ic, Ice_InputStreamPtr is);

/* ---- ice_calls: the table of calls that wait for replies ---- */

/* Takes a slot for a call that is being prepared: a free slot, or the slot of this task's previous
 * call. Returns -1 if all slots are in use. */
int icec_takeCall(Ice_CommunicatorPtr ic);
Ice_CallState icec_callState(Ice_CommunicatorPtr ic, int slot);

/* Passes a reply to the call that waits for it. `is` is at the start of the reply's body.
 * Returns ICE_CONNECTION_LOST if the reply ends within its id. */
Ice_Status icec_takeReply(Ice_CommunicatorPtr ic, int connection, Ice_InputStreamPtr is);
/* Finds an asynchronous call that has timed out, and sets `id` to its id; returns 0 if no
 * call has timed out. Reduces `waitMs` to the time until the next time-out. The caller holds
 * the state lock. */
Ice_Call* icec_expiredCall(Ice_CommunicatorPtr ic, U32 now, Ice_Int* id, Ice_Int* waitMs);
/* Ends a call found by icec_expiredCall, unless the call has ended in the meantime. */
void icec_expireCall(Ice_CommunicatorPtr ic, Ice_Call* call, Ice_Int id);
/* Marks a connection as closed, and ends the calls on it with `status`. */
void icec_loseConnection(Ice_CommunicatorPtr ic, int connection, Ice_Status status);
/* Wakes every task that waits in a call; the caller holds the state lock. */
void icec_wakeCalls(Ice_CommunicatorPtr ic);

/* ---- ice_dispatch: incoming requests, from the message to the servant, and replies ---- */

/* Executes a request, or a batch of requests, and replies. Returns ICE_OK for any result of the
 * operation, and ICE_CONNECTION_LOST if the message is malformed. */
Ice_Status icec_dispatchRequest(Ice_CommunicatorPtr ic, int connection, Ice_InputStreamPtr is);
Ice_Status icec_dispatchBatch(Ice_CommunicatorPtr ic, int connection, Ice_InputStreamPtr is);

/* ---- ice_loop: waits for events and handles them; only one of several tasks does this at a time
 * ---- */

/* Receives, or waits while another task receives, until `waits(ic, which)` returns 0. May also be
 * called while an operation is executed. The task sleeps on `slot`, the slot of its call. Returns
 * ICE_TIMEOUT or ICE_LIMIT if the wait fails. */
Ice_Status icec_await(Ice_CommunicatorPtr ic, int (*waits)(Ice_CommunicatorPtr ic, int which),
                      int which, int slot, Ice_Int timeoutMs);

/* Slot of Ice_Os on which tasks sleep that want to be the receiver; slots 0..ICE_CALLS-1 belong to
 * calls. */
#define ICEC_SERVER_SLOT ICE_CALLS
