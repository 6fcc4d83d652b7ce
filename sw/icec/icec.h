/* SPDX-License-Identifier: MIT
 *
 * icec: a small peer of ZeroC Ice 3.7 in C90: communicator, object adapter, servants, proxies.
 *
 * No allocation: the caller owns every object named here, and keeps it while it is in use. Limits are
 * the constants below. Names follow the paper's figures; the mapping is docs/icec.md.
 */
#ifndef ICEC_H
#define ICEC_H

#include "base.h"

typedef U8 Ice_Bool;
typedef U8 Ice_Byte;
typedef S16 Ice_Short;
typedef S32 Ice_Int;
typedef float Ice_Float;
typedef double Ice_Double;
typedef struct Ice_Long {
    U32 low; /* C90 has no 64-bit integer */
    S32 high;
} Ice_Long;

/* Not terminated; points into a message, or at what the caller keeps. */
typedef struct Ice_String {
    Ice_Int size;
    const char *data;
} Ice_String;

#define ICE_MESSAGE_MAX 8192   /* bytes of one message, header included (LINK_MAX_MESSAGE) */
#define ICE_ARENA_BYTES 2048   /* decoded sequences of one message */
#define ICE_ADAPTERS 2         /* object adapters a communicator */
#define ICE_SERVANTS 8         /* servants an adapter */
#define ICE_NAME_MAX 32        /* characters of an identity's name in a proxy */
#define ICE_ENDPOINT_MAX 48    /* bytes of a proxy's encoded endpoints */
#define ICE_CONNECTIONS 4
#define ICE_CALLS 4            /* two-way calls waiting for their replies */

typedef enum Ice_Status {
    ICE_OK = 0,
    ICE_OBJECT_NOT_EXIST,
    ICE_FACET_NOT_EXIST,
    ICE_OPERATION_NOT_EXIST,
    ICE_USER_EXCEPTION,   /* the reply is one; its body is in the stream */
    ICE_UNKNOWN_EXCEPTION, /* the peer failed otherwise */
    ICE_MARSHAL,          /* a message is not what it should be, or does not fit */
    ICE_TIMEOUT,
    ICE_CONNECTION_LOST,
    ICE_NO_ENDPOINT,      /* unknown transport, or a proxy string that is none */
    ICE_LIMIT,            /* one of the constants above */
    ICE_PROTOCOL          /* not IceP 1.0, compressed, or an encoding other than 1.0 and 1.1 */
} Ice_Status;

const char *Ice_Status_text(Ice_Status status);

Ice_String Ice_String_from(const char *terminated);
int Ice_String_equals(Ice_String a, const char *terminated);

/* ---- streams: errors stick, one check at the end is enough ---- */

typedef struct Ice_OutputStream {
    Ice_Byte *data;
    Ice_Int size, capacity;
    Ice_Byte minor; /* encoding 1.minor */
    Ice_Byte failed;
} Ice_OutputStream, *Ice_OutputStreamPtr;

typedef struct Ice_InputStream {
    const Ice_Byte *data;
    Ice_Int position, size;
    Ice_Byte minor;
    Ice_Byte failed;
    U32 *arena; /* for decoded sequences */
    Ice_Int arenaUsed, arenaSize; /* in words of 4 bytes */
} Ice_InputStream, *Ice_InputStreamPtr;

void Ice_OutputStream_init(Ice_OutputStreamPtr os, Ice_Byte *data, Ice_Int capacity);
void Ice_OutputStream_writeBlob(Ice_OutputStreamPtr os, const Ice_Byte *data, Ice_Int size);
void Ice_OutputStream_writeByte(Ice_OutputStreamPtr os, Ice_Byte v);
void Ice_OutputStream_writeBool(Ice_OutputStreamPtr os, Ice_Bool v);
void Ice_OutputStream_writeShort(Ice_OutputStreamPtr os, Ice_Short v);
void Ice_OutputStream_writeInt(Ice_OutputStreamPtr os, Ice_Int v);
void Ice_OutputStream_writeLong(Ice_OutputStreamPtr os, Ice_Long v);
void Ice_OutputStream_writeFloat(Ice_OutputStreamPtr os, Ice_Float v);
void Ice_OutputStream_writeDouble(Ice_OutputStreamPtr os, Ice_Double v);
void Ice_OutputStream_writeSize(Ice_OutputStreamPtr os, Ice_Int v);
void Ice_OutputStream_writeString(Ice_OutputStreamPtr os, Ice_String v);
/* `largest`: the greatest enumerator, which chooses the width in encoding 1.0. */
void Ice_OutputStream_writeEnum(Ice_OutputStreamPtr os, Ice_Int v, Ice_Int largest);

void Ice_InputStream_init(Ice_InputStreamPtr is, const Ice_Byte *data, Ice_Int size);
const Ice_Byte *Ice_InputStream_readBlob(Ice_InputStreamPtr is, Ice_Int size); /* 0 on failure */
Ice_Byte Ice_InputStream_readByte(Ice_InputStreamPtr is);
Ice_Bool Ice_InputStream_readBool(Ice_InputStreamPtr is);
Ice_Short Ice_InputStream_readShort(Ice_InputStreamPtr is);
Ice_Int Ice_InputStream_readInt(Ice_InputStreamPtr is);
Ice_Long Ice_InputStream_readLong(Ice_InputStreamPtr is);
Ice_Float Ice_InputStream_readFloat(Ice_InputStreamPtr is);
Ice_Double Ice_InputStream_readDouble(Ice_InputStreamPtr is);
Ice_Int Ice_InputStream_readSize(Ice_InputStreamPtr is);
Ice_String Ice_InputStream_readString(Ice_InputStreamPtr is);
Ice_Int Ice_InputStream_readEnum(Ice_InputStreamPtr is, Ice_Int largest);
/* Size of a sequence whose elements take at least `least` bytes each: more than is left fails. */
Ice_Int Ice_InputStream_readSequence(Ice_InputStreamPtr is, Ice_Int least);
/* Room for `count` elements of `bytes` each, aligned to 8; 0 and a failed stream if there is none. */
void *Ice_InputStream_allocate(Ice_InputStreamPtr is, Ice_Int count, Ice_Int bytes);

/* ---- transports ---- */

/* What a transport tells its communicator. */
typedef enum Ice_EventKind { ICE_EVENT_NONE, ICE_EVENT_OPENED, ICE_EVENT_MESSAGE, ICE_EVENT_CLOSED } Ice_EventKind;

typedef struct Ice_Event {
    Ice_EventKind kind;
    int connection; /* 0..ICE_CONNECTIONS-1, the transport's number */
    Ice_Int size;   /* of the message, which lies in the buffer that receive was given */
} Ice_Event;

/* A transport moves whole IceP messages on numbered connections. All calls are made by the tasks of the
 * communicator; receive by one at a time. */
typedef struct Ice_Endpoint {
    const char *name; /* in proxy strings: "xbee-at", "tcp" */
    /* Waits up to timeoutMs for one event. `buffer` takes a message of up to ICE_MESSAGE_MAX bytes. */
    Ice_Status (*receive)(void *context, Ice_Byte *buffer, Ice_Int timeoutMs, Ice_Event *event);
    Ice_Status (*send)(void *context, int connection, const Ice_Byte *message, Ice_Int size);
    /* `encoded`: endpoints as in a proxy on the wire (2-byte type + encapsulation each). */
    Ice_Status (*connect)(void *context, const Ice_Byte *encoded, Ice_Int size, int *connection);
    void (*close)(void *context, int connection);
    Ice_Status (*listen)(void *context, const char *options);
    /* From "-a 1 -p 3" to the wire, and the endpoint that a proxy of our own should carry (options 0). */
    void (*encode)(void *context, const char *options, Ice_OutputStreamPtr os);
    /* Makes receive return early; may be called from any task. */
    void (*wake)(void *context);
} Ice_Endpoint;

/* ---- tasks ---- */

/* What IceC needs where several tasks use one communicator. The single-task version is Ice_Os_none. */
typedef struct Ice_Os {
    void (*lock)(void *context);
    void (*unlock)(void *context);
    /* Sleeps until wake of this slot (0..ICE_CALLS-1) or the time is over. 1: woken. */
    int (*wait)(void *context, int slot, Ice_Int timeoutMs);
    void (*wake)(void *context, int slot);
    /* Something that differs from task to task. */
    int (*task)(void *context);
} Ice_Os;

/* ---- objects ---- */

typedef struct Ice_Communicator Ice_Communicator, *Ice_CommunicatorPtr;
typedef struct Ice_ObjectAdapter Ice_ObjectAdapter, *Ice_ObjectAdapterPtr;
typedef struct Ice_Object Ice_Object, *Ice_ObjectPtr;
typedef struct Ice_ObjectPrx Ice_ObjectPrx, *Ice_ObjectPrxPtr;

/* The call being dispatched. */
typedef struct Ice_Current {
    Ice_ObjectAdapterPtr adapter;
    Ice_String name, category, operation;
    Ice_Byte mode; /* 0 normal, 1 nonmutating, 2 idempotent */
    int connection;
} Ice_Current;

/* Reads the parameters from `is`, runs the operation, writes the results to `os`.
 * ICE_OPERATION_NOT_EXIST where there is no such operation. */
typedef Ice_Status (*Ice_Dispatch)(Ice_ObjectPtr self, const Ice_Current *current, Ice_InputStreamPtr is,
                                   Ice_OutputStreamPtr os);

struct Ice_Object {
    Ice_Dispatch dispatch;
    const char *const *ids; /* type ids in alphabetical order, "::Ice::Object" among them; 0 ends */
    const char *id;         /* the most derived one */
};

struct Ice_ObjectAdapter {
    Ice_CommunicatorPtr communicator;
    const char *name;
    Ice_Byte active;
    struct {
        const char *name;
        Ice_ObjectPtr servant;
    } servants[ICE_SERVANTS];
};

struct Ice_ObjectPrx {
    Ice_CommunicatorPtr communicator;
    char name[ICE_NAME_MAX];
    Ice_Byte nameSize, mode; /* mode: 0 twoway, 1 oneway */
    Ice_Byte encoded[ICE_ENDPOINT_MAX];
    Ice_Byte encodedSize, endpointCount;
    Ice_Int timeoutMs; /* for a reply; 10 s unless set */
    int call;          /* the slot of the call under way */
};

typedef struct Ice_Call {
    Ice_Byte used, done;
    Ice_Int id;
    int connection;
    Ice_Status status;
    Ice_Int replySize;
    Ice_Byte out[512]; /* the request: parameters of calls that the UAV makes are small */
    Ice_Byte reply[512];
    U32 arena[64];
    Ice_OutputStream os;
    Ice_InputStream is;
    Ice_Int encapsulation; /* where its size goes */
} Ice_Call;

struct Ice_Communicator {
    const Ice_Os *os;
    void *osContext;
    const Ice_Endpoint *endpoint;
    void *endpointContext;
    Ice_ObjectAdapterPtr adapters[ICE_ADAPTERS];
    Ice_Call calls[ICE_CALLS];
    Ice_Byte validated[ICE_CONNECTIONS]; /* the peer of an outgoing connection has said hello */
    Ice_Byte open[ICE_CONNECTIONS];
    Ice_Byte stopping;
    int receiver; /* task that receives, -1 none */
    Ice_Byte dispatching;
    Ice_Int lastId;
    Ice_Byte in[ICE_MESSAGE_MAX], out[ICE_MESSAGE_MAX];
    U32 arena[ICE_ARENA_BYTES / 4];
};

void Ice_initialize(Ice_CommunicatorPtr ic);
/* Before any other call; `os` must stay valid. */
void Ice_Communicator_setOs(Ice_CommunicatorPtr ic, const Ice_Os *os, void *context);
void Ice_Communicator_setEndpoint(Ice_CommunicatorPtr ic, const Ice_Endpoint *endpoint, void *context);

/* `endpoints`: name of the transport and its options, "xbee-at" or "tcp -p 10000". */
Ice_Status Ice_Communicator_createObjectAdapterWithEndpoints(Ice_CommunicatorPtr ic, const char *name,
                                                             const char *endpoints,
                                                             Ice_ObjectAdapterPtr adapter);
/* `proxy`: "identity [-t|-o]:transport options". */
Ice_Status Ice_Communicator_stringToProxy(Ice_CommunicatorPtr ic, const char *proxy, Ice_ObjectPrxPtr prx);
/* Receives and dispatches until Ice_Communicator_shutdown. */
void Ice_Communicator_waitForShutdown(Ice_CommunicatorPtr ic);
void Ice_Communicator_shutdown(Ice_CommunicatorPtr ic);
/* Handles at most one event; for programs with a loop of their own. */
Ice_Status Ice_Communicator_poll(Ice_CommunicatorPtr ic, Ice_Int timeoutMs);

Ice_Status Ice_ObjectAdapter_add(Ice_ObjectAdapterPtr adapter, Ice_ObjectPtr servant, const char *identity);
Ice_Status Ice_ObjectAdapter_remove(Ice_ObjectAdapterPtr adapter, const char *identity);
void Ice_ObjectAdapter_activate(Ice_ObjectAdapterPtr adapter);
/* A proxy to an object of this adapter, to be passed to a peer. */
Ice_Status Ice_ObjectAdapter_createProxy(Ice_ObjectAdapterPtr adapter, const char *identity,
                                         Ice_ObjectPrxPtr prx);

/* For generated code: a call is begin, writes to the returned stream, invoke, reads, end. begin
 * returns 0 where all calls are taken. */
Ice_OutputStreamPtr Ice_ObjectPrx_begin(Ice_ObjectPrxPtr self, const char *operation, Ice_Byte mode);
Ice_Status Ice_ObjectPrx_invoke(Ice_ObjectPrxPtr self, Ice_InputStreamPtr *is);
Ice_Status Ice_ObjectPrx_end(Ice_ObjectPrxPtr self, Ice_Status status);
Ice_Status Ice_ObjectPrx_ice_ping(Ice_ObjectPrxPtr self);

/* A null proxy is written for 0, and read as an empty name. */
void Ice_OutputStream_writePrx(Ice_OutputStreamPtr os, const Ice_ObjectPrx *prx);
void Ice_InputStream_readPrx(Ice_InputStreamPtr is, Ice_CommunicatorPtr ic, Ice_ObjectPrxPtr prx);

extern const Ice_Os Ice_Os_none;

#endif
