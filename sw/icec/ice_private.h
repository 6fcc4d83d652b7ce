/* SPDX-License-Identifier: MIT
 *
 * ice_private: what IceC's own files share.
 */
#ifndef ICE_PRIVATE_H
#define ICE_PRIVATE_H

#include "icec.h"

enum { ICE_REQUEST, ICE_BATCH, ICE_REPLY, ICE_VALIDATE, ICE_CLOSE };
#define ICE_HEADER 14
#define ICE_TYPE_AT 8
#define ICE_REPLY_BODY 19 /* where a reply's encapsulation begins: header, id, status */
#define ICE_REPLY_HEAD 25 /* where its results begin */

/* A call, and a connection: what is waited for is WAITING. */
enum { ICE_FREE, ICE_WAITING, ICE_DONE, ICE_BUILDING };

/* ---- messages (ice_message.c) ---- */

/* The bytes before every message: "IceP", versions, type, compression, size. */
extern const Ice_Byte Ice_head[ICE_HEADER];
/* On an empty stream with room for them; the size is set by Ice_endMessage. */
void Ice_beginMessage(Ice_OutputStreamPtr os, Ice_Byte type);
void Ice_endMessage(Ice_OutputStreamPtr os);
/* Overwrites four bytes. */
void Ice_patchInt(Ice_OutputStreamPtr os, Ice_Int at, Ice_Int value);
/* Size and encoding of an encapsulation; endEncapsulation fills the size in. */
Ice_Int Ice_beginEncapsulation(Ice_OutputStreamPtr os);
void Ice_endEncapsulation(Ice_OutputStreamPtr os, Ice_Int begin);
/* Narrows `is` to the encapsulation that follows. ICE_PROTOCOL: an encoding other than 1.0 and 1.1.
 */
Ice_Status Ice_enterEncapsulation(Ice_InputStreamPtr is);
/* Facet as on the wire: none, or one. */
void Ice_writeFacet(Ice_OutputStreamPtr os, const Ice_String* facet);
void Ice_readFacet(Ice_InputStreamPtr is, Ice_String* facet);
void Ice_skipStrings(Ice_InputStreamPtr is, U32 count);

/* ---- connections (ice_connection.c) ---- */

/* Where a task waits that wants to receive; 0..ICE_CALLS-1 are those of calls. */
#define ICE_SERVER_SLOT ICE_CALLS
#define Ice_lock(ic, which) ((void)(ICEC_TASKS && ((ic)->os->lock((ic)->osContext, which), 0)))
#define Ice_unlock(ic, which) ((void)(ICEC_TASKS && ((ic)->os->unlock((ic)->osContext, which), 0)))
Ice_Status Ice_sendPlain(Ice_CommunicatorPtr ic, int connection, Ice_Byte type);
/* A connection that cannot send is lost. Under ICE_LOCK_SEND. */
Ice_Status Ice_send(Ice_CommunicatorPtr ic, int connection, Ice_OutputStreamPtr os);
void Ice_lose(Ice_CommunicatorPtr ic, int connection, Ice_Status status);
U32 Ice_nowMs(Ice_CommunicatorPtr ic);
/* Receives, or lets another task receive, until `state` is no more ICE_WAITING; from within an
 * operation too. ICE_TIMEOUT, ICE_LIMIT. */
Ice_Status Ice_await(Ice_CommunicatorPtr ic, const volatile Ice_Int* state, int slot,
                     Ice_Int timeoutMs);
/* Handles at most one event; for the task that has the role of the receiver. */
Ice_Status Ice_receiveOne(Ice_CommunicatorPtr ic, Ice_Int timeoutMs);
/* A connection has come to be. Under the state lock. */
void Ice_openConnection(Ice_CommunicatorPtr ic, int connection, Ice_Int state);
/* The communicator's arena behind what outer operations use of it. */
void Ice_giveArena(Ice_CommunicatorPtr ic, Ice_InputStreamPtr is);

/* ---- the role of the receiver (ice_receiver.c; only with ICEC_TASKS) ---- */

typedef enum Ice_Role {
    ICE_ROLE_NONE,  /* another task has it */
    ICE_ROLE_TAKEN, /* to be given back by Ice_giveRole */
    ICE_ROLE_HAD    /* this task had it before: an operation calls this */
} Ice_Role;
#define ICE_FOREVER 0x7FFFFFFF /* a time-out: until the role is free, or shutdown is called */
Ice_Role Ice_takeRole(Ice_CommunicatorPtr ic, Ice_Int timeoutMs);
void Ice_giveRole(Ice_CommunicatorPtr ic);
/* Whether a task that waits for a reply is to receive now. `leads`: it took the role for that; it
 * takes the role where nobody has or wants it, and hands it to a server that wants it. */
int Ice_mayReceive(Ice_CommunicatorPtr ic, int* leads);

/* ---- requests (ice_dispatch.c, ice_reply.c) ---- */

/* One operation more or less under way; 0: the connection is another one by now. */
int Ice_countPending(Ice_CommunicatorPtr ic, int connection, U16 generation, int change);

/* ICE_OK whatever became of the operation; ICE_CONNECTION_LOST: the message is malformed. */
Ice_Status Ice_dispatchRequest(Ice_CommunicatorPtr ic, int connection, Ice_InputStreamPtr is);
Ice_Status Ice_dispatchBatch(Ice_CommunicatorPtr ic, int connection, Ice_InputStreamPtr is);
/* Turns results at ICE_REPLY_HEAD into a whole reply. `who`: identity, facet and operation as they
 * stand in the request; 0 bytes: no more known. */
void Ice_finishReply(Ice_OutputStreamPtr os, Ice_Int id, Ice_Status status, const Ice_Byte* who,
                     Ice_Int whoSize);

/* ---- calls (ice_call.c) ---- */

/* Sends what begin began, and gives the buffer back. */
Ice_Status Ice_sendRequest(Ice_ObjectPrxPtr self, Ice_Callback callback, void* cookie);
/* The call that a proxy began. */
#define Ice_callOf(ic, prx) (&(ic)->calls[ICE_CALLS > 1 ? (prx)->call : 0])
/* Empties ic->request; under ICE_LOCK_SEND. */
void Ice_initRequest(Ice_CommunicatorPtr ic);

void Ice_takeReply(Ice_CommunicatorPtr ic, int connection, Ice_InputStreamPtr is);
void Ice_failCalls(Ice_CommunicatorPtr ic, int connection, Ice_Status status);
/* Ends asynchronous calls whose time is over; the result is when the next one's is, at most
 * `waitMs`. */
Ice_Int Ice_expireCalls(Ice_CommunicatorPtr ic, Ice_Int waitMs);
/* Under the state lock. */
void Ice_wakeCalls(Ice_CommunicatorPtr ic);

/* ---- proxies (ice_proxy.c) ---- */

void Ice_ObjectPrx_init(Ice_ObjectPrxPtr prx, Ice_CommunicatorPtr ic);
/* ICE_LIMIT: too long together. `category` and `facet` may be 0. */
Ice_Status Ice_ObjectPrx_setIdentity(Ice_ObjectPrxPtr prx, const Ice_String* name,
                                     const Ice_String* category, const Ice_String* facet);
/* Adds the transport's endpoint; `options` 0: the one it listens on. */
Ice_Status Ice_ObjectPrx_addEndpoint(Ice_ObjectPrxPtr prx, const char* options);
/* The options behind the transport's name, or 0 where the text names another transport. */
const char* Ice_optionsOf(Ice_CommunicatorPtr ic, const char* text);
/* "category/name" */
Ice_Identity Ice_parseIdentity(const char* text);

#endif
