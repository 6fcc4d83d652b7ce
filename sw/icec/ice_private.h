/* SPDX-License-Identifier: MIT
 *
 * ice_private: declares the functions shared by the files of the full run time, bottom layer first.
 */
#pragma once

#include "ice_message.h"

/* ---- ice_transport: transports, locks, time, and the connections: their states, and sending on
 * them ---- */

/* Number of transports for loops; a single one costs no code. */
#define ICEC_TRANSPORTS(ic) (ICE_TRANSPORTS == 1 ? 1 : (ic)->transportCount)

/* `which`: ICE_LOCK_STATE or ICE_LOCK_SEND. */
#define icec_lock(ic, which) ((ic)->os->lock((ic)->osContext, which))
#define icec_unlock(ic, which) ((ic)->os->unlock((ic)->osContext, which))

/* Milliseconds since any time; wraps. */
U32 icec_nowMs(Ice_CommunicatorPtr ic);

/* Ends the receiver's wait early. */
void icec_wake(Ice_CommunicatorPtr ic);

/* Spaces between the words of proxies and endpoints as strings, as in Ice. */
#define ICEC_SPACES " \t\n\r"

/* Returns the options after the name of a transport, and sets the transport; 0 if the text does not
 * name a transport. */
const char* icec_optionsOf(Ice_CommunicatorPtr ic, const char* text, int* transport);
/* Returns the text after the next colon outside quotes; 0 if none. */
const char* icec_nextEndpoint(const char* text);
/* Adds an endpoint of a transport; `options` 0: the one on which it listens. ICE_LIMIT: more than
 * ICE_ENDPOINT_MAX. */
Ice_Status icec_addEndpoint(Ice_ObjectPrxPtr prx, int transport, const char* options);

/* Resolves escapes as Ice does: `special` may also be escaped; other escapes are kept. Fails `os`
 * if one is malformed, or for control characters. */
void icec_unescape(Ice_String text, char special, Ice_OutputStreamPtr os);
/* The status of a stream that failed: ICE_PARSE if its text is malformed, otherwise ICE_LIMIT. */
#define icec_parseFailure(os) ((os)->failed == ICE_FAILED_MALFORMED ? ICE_PARSE : ICE_LIMIT)

/* Sends the complete message in `os`; under ICE_LOCK_SEND. ICE_CONNECTION_LOST: the connection has
 * ended. */
Ice_Status icec_send(Ice_CommunicatorPtr ic, int connection, Ice_OutputStreamPtr os);
/* Sends a message without a body: ICEC_VALIDATE or ICEC_CLOSE. */
Ice_Status icec_sendHead(Ice_CommunicatorPtr ic, int connection, Ice_Byte type);

/* Begins a connection of this number; under the state lock. */
void icec_openConnection(Ice_CommunicatorPtr ic, int connection, Ice_ConnectionState state);
/* Closes the transport's connection; icec_loseConnection ends its calls. */
void icec_closeConnection(Ice_CommunicatorPtr ic, int connection);
Ice_ConnectionState icec_connectionState(Ice_CommunicatorPtr ic, int connection);

/* Sends CloseConnection, once: pending requests of the peer were not executed, and the peer closes.
 * Waits until operations in progress have been answered: then the next call sends. */
void icec_askToClose(Ice_CommunicatorPtr ic, int connection);
int icec_isStopping(Ice_CommunicatorPtr ic);

/* Counts `change` more operations in progress on a connection. Returns 0 if the number now belongs
 * to another connection, or to none. */
int icec_countPending(Ice_CommunicatorPtr ic, int connection, U16 generation, int change);

/* Gives `is` the part of the communicator's arena that outer operations do not use. */
void icec_giveArena(Ice_CommunicatorPtr ic, Ice_InputStreamPtr is);

/* ---- ice_calls: the table of calls that wait for replies ---- */

/* Takes a slot for a call that is being built: a free slot, or the slot that the previous call of
 * this task kept. Returns -1 if all slots are taken. */
int icec_takeCall(Ice_CommunicatorPtr ic);
Ice_CallState icec_callState(Ice_CommunicatorPtr ic, int slot);

/* Hands a reply, read up to its body, to the call that waits for it. */
void icec_takeReply(Ice_CommunicatorPtr ic, int connection, Ice_InputStreamPtr is);
/* Finds an asynchronous call that has timed out, and its id; returns 0 if none. Shortens
 * `waitMs` to the next time-out; under the state lock. */
Ice_Call* icec_expiredCall(Ice_CommunicatorPtr ic, U32 now, Ice_Int* id, Ice_Int* waitMs);
/* Ends that call, unless it has already ended. */
void icec_expireCall(Ice_CommunicatorPtr ic, Ice_Call* call, Ice_Int id);
/* Marks a connection as closed, and fails its calls with `status`. */
void icec_loseConnection(Ice_CommunicatorPtr ic, int connection, Ice_Status status);
/* Wakes every task that is making a call; under the state lock. */
void icec_wakeCalls(Ice_CommunicatorPtr ic);

/* ---- ice_dispatch: incoming requests, from the message to the servant, and replies ---- */

/* Executes a request, or a batch of requests, and replies. Returns ICE_OK for any result;
 * ICE_CONNECTION_LOST: the message is malformed. */
Ice_Status icec_dispatchRequest(Ice_CommunicatorPtr ic, int connection, Ice_InputStreamPtr is);
Ice_Status icec_dispatchBatch(Ice_CommunicatorPtr ic, int connection, Ice_InputStreamPtr is);

/* ---- ice_loop: handles arriving events, and waits for them, in one of several tasks ---- */

/* Receives, or lets another task receive, while `waits(ic, which)` holds; also from within an
 * operation. `slot` belongs to the call on which the task sleeps. ICE_TIMEOUT, ICE_LIMIT. */
Ice_Status icec_await(Ice_CommunicatorPtr ic, int (*waits)(Ice_CommunicatorPtr ic, int which),
                      int which, int slot, Ice_Int timeoutMs);

/* Slot of Ice_Os in which tasks that want to receive sleep; 0..ICE_CALLS-1 belong to calls. */
#define ICEC_SERVER_SLOT ICE_CALLS
