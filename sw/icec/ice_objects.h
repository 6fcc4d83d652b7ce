/* SPDX-License-Identifier: MIT
 *
 * ice_objects: the members of communicators and adapters. Included by icec.h only.
 */
#pragma once

#define ICEC_FULL 1 /* the run time has all features, and serves several tasks */

typedef struct Ice_Servant {
    Ice_ObjectPtr servant; /* 0: free */
    Ice_Identity identity; /* an empty name: default servant of the category */
    Ice_String facet;
} Ice_Servant;

struct Ice_ObjectAdapter {
    Ice_CommunicatorPtr communicator;
    Ice_ObjectAdapterPtr next;
    Ice_Byte active;
    Ice_Byte transports; /* transports on which it listens, one bit each */
    Ice_Servant servants[ICE_SERVANTS];
};

typedef enum Ice_CallState {
    ICE_CALL_FREE,
    ICE_CALL_KEPT,     /* ended; its task may still use the results */
    ICE_CALL_BUILDING, /* its request is being written */
    ICE_CALL_WAITING,  /* the reply is expected */
    ICE_CALL_DONE      /* the reply has arrived, or will never arrive */
} Ice_CallState;

typedef struct Ice_Call {
    Ice_CallState state;
    int task;          /* task that made the call */
    Ice_Status status; /* valid in state DONE */
    Ice_Int id;
    int connection;
    U32 begunMs;
    Ice_Int timeoutMs;
    Ice_Callback callback; /* 0: a task waits */
    void* cookie;
    Ice_InputStream is;
    Ice_String unknown; /* unknown exception, for Ice_Failure */
    U32* reply;         /* the reply, followed by its decoded sequences */
    Ice_Int replySize;
    U32 replyData[ICE_REPLY_MAX / 4];
} Ice_Call;

typedef enum Ice_ConnectionState {
    ICE_CONNECTION_NONE,
    ICE_CONNECTION_VALIDATING, /* waiting for the first message of the peer */
    ICE_CONNECTION_OPEN
} Ice_ConnectionState;

typedef struct Ice_Connection {
    Ice_ConnectionState state;
    Ice_Byte pending; /* operations in progress, or answered later */
    Ice_Byte closing; /* the peer has been asked to close */
    U16 generation;   /* counts the connections that had this number; never 0 */
    U32 signMs;       /* time of the callers' last heartbeat, or of the start of the wait */
} Ice_Connection;

typedef struct Ice_Transport {
    const Ice_Endpoint* endpoint;
    void* context;
} Ice_Transport;

/* Small members first: their offsets are short in the code. The connection c of transport t has the
 * number t * ICE_CONNECTIONS + c. */
struct Ice_Communicator {
    Ice_Transport transports[ICE_TRANSPORTS];
    Ice_ObjectAdapterPtr adapters;
    Ice_Byte stopping;
    Ice_Byte transportCount;
    Ice_Byte turn;     /* transport that is listened to now */
    Ice_Byte turnUsed; /* events handled in this turn */
    int receiver;      /* task that receives; -1 if none */
    int servers;       /* tasks that want to receive */
    int depth;         /* messages being handled */
    Ice_Int lastId;
    Ice_OutputStream request;    /* being built, under ICE_LOCK_SEND */
    Ice_Int requestBody;         /* offset of its encapsulation */
    Ice_InputStreamPtr decoding; /* stream of the innermost operation, with its part of the arena */
    const Ice_Os* os;
    void* osContext;
    const char* const* properties;
    Ice_Connection connections[ICE_TRANSPORTS * ICE_CONNECTIONS];
    Ice_Call calls[ICE_CALLS];
    U32 arena[ICE_ARENA_BYTES / 4];
    Ice_Byte requestData[ICE_REQUEST_MAX];
    Ice_Byte in[ICE_NESTING][ICE_MESSAGE_MAX], out[ICE_RESULT_MAX];
};
