/* SPDX-License-Identifier: MIT
 *
 * ice_objects: the members of communicators and adapters. Included by icec.h only.
 */
#pragma once

#define ICEC_FULL 1 /* the run time has all features, and serves several tasks */

typedef struct Ice_Servant {
    Ice_ObjectPtr servant; /* 0: free */
    /* identity of the servant; an empty name makes it the default servant of the category */
    Ice_Identity identity;
    Ice_String facet;
} Ice_Servant;

struct Ice_ObjectAdapter {
    Ice_CommunicatorPtr communicator;
    Ice_ObjectAdapterPtr next;
    Ice_Byte active;
    Ice_Byte transports; /* transports on which the adapter listens, one bit each */
    Ice_Servant servants[ICE_SERVANTS];
};

typedef enum Ice_CallState {
    ICE_CALL_FREE,
    ICE_CALL_KEPT,     /* the call has ended, but its task may still use the results */
    ICE_CALL_BUILDING, /* the request is being written */
    ICE_CALL_WAITING,  /* the reply is expected */
    ICE_CALL_DONE      /* the reply has arrived, or will never arrive */
} Ice_CallState;

typedef struct Ice_Call {
    Ice_CallState state;
    int task;          /* task that made the call */
    Ice_Status status; /* status of the call; valid in state DONE */
    Ice_Int id;
    int connection;
    U32 begunMs;
    Ice_Int timeoutMs;
    Ice_Callback callback; /* callback of an asynchronous call; 0 if a task waits */
    void* cookie;
    Ice_InputStream is;
    Ice_String unknown; /* name of an exception that is not declared, for Ice_Failure */
    U32* reply;         /* the reply, followed by its decoded sequences */
    Ice_Int replySize;
    U32 replyData[ICE_REPLY_MAX / 4];
} Ice_Call;

typedef enum Ice_ConnectionState {
    ICE_CONNECTION_NONE,
    ICE_CONNECTION_VALIDATING, /* the first message of the peer has not arrived yet */
    ICE_CONNECTION_OPEN
} Ice_ConnectionState;

typedef struct Ice_Connection {
    Ice_ConnectionState state;
    /* number of operations in progress, including operations with a reply that is sent later */
    Ice_Byte pending;
    Ice_Byte closing; /* the peer has been asked to close */
    /* number of the connection among all connections that have used this slot; never 0 */
    U16 generation;
    /* time of the last heartbeat to the callers, or time since which the callers wait, ms */
    U32 signMs;
} Ice_Connection;

typedef struct Ice_Transport {
    const Ice_Endpoint* endpoint;
    void* context;
} Ice_Transport;

/* Small members come first, because short offsets make shorter code. Connection c of transport t
 * has the number t * ICE_CONNECTIONS + c. */
struct Ice_Communicator {
    Ice_Transport transports[ICE_TRANSPORTS];
    Ice_ObjectAdapterPtr adapters;
    Ice_Byte stopping;
    Ice_Byte transportCount;
    Ice_Byte turn;     /* transport that is served now */
    Ice_Byte turnUsed; /* number of events handled during this turn */
    int receiver;      /* task that has the role of the receiver; -1 if no task has it */
    int servers;       /* number of servers, which want the role of the receiver */
    int depth;         /* number of messages being handled */
    Ice_Int lastId;
    Ice_OutputStream request; /* request that is being built; protected by ICE_LOCK_SEND */
    Ice_Int requestBody;      /* offset of the request's encapsulation */
    /* stream of the operation that is being executed (the innermost one), with its part of the
     * arena */
    Ice_InputStreamPtr decoding;
    const Ice_Os* os;
    void* osContext;
    const char* const* properties;
    Ice_Connection connections[ICE_TRANSPORTS * ICE_CONNECTIONS];
    Ice_Call calls[ICE_CALLS];
    U32 arena[ICE_ARENA_BYTES / 4];
    Ice_Byte requestData[ICE_REQUEST_MAX];
    Ice_Byte in[ICE_NESTING][ICE_MESSAGE_MAX], out[ICE_RESULT_MAX];
};
