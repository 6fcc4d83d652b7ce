/* SPDX-License-Identifier: MIT
 *
 * ice_port: IceC's needs from below: a transport, and tasks where there are several.
 */
#pragma once

#include "ice_stream.h"

typedef enum Ice_Status {
    /* The first eight have the numbers that replies have on the wire. */
    ICE_OK = 0,
    ICE_USER_EXCEPTION, /* an exception of the operation; its body is in the stream */
    ICE_OBJECT_NOT_EXIST,
    ICE_FACET_NOT_EXIST,
    ICE_OPERATION_NOT_EXIST,
    ICE_UNKNOWN_LOCAL_EXCEPTION, /* the peer's run time failed */
    ICE_UNKNOWN_USER_EXCEPTION,  /* an exception that the operation does not declare */
    ICE_UNKNOWN_EXCEPTION,       /* the peer failed otherwise */
    /* The next two are local exceptions for the peer, the others unknown ones. */
    ICE_MARSHAL,  /* malformed message, or too large */
    ICE_PROTOCOL, /* not IceP 1.0, compressed, or an encoding other than 1.0 and 1.1 */
    ICE_TIMEOUT,
    ICE_CONNECTION_LOST,   /* a call in progress may or may not have been executed */
    ICE_NO_ENDPOINT,       /* unknown transport, or a proxy without endpoints */
    ICE_LIMIT,             /* one of the constants of ice_config.h */
    ICE_CONNECTION_CLOSED, /* the peer closed in good order: the call was not executed */
    ICE_PARSE,             /* malformed proxy, identity or endpoint string */
    ICE_TWOWAY_ONLY,       /* a oneway or batch proxy cannot have results */
    ICE_LATER              /* returned by a servant: the reply is sent later (Ice_Reply) */
} Ice_Status;

const char* Ice_Status_text(Ice_Status status);

/* An event that a transport reports to its communicator. */
typedef enum Ice_EventKind {
    ICE_EVENT_NONE,
    ICE_EVENT_MESSAGE,
    ICE_EVENT_CLOSED,
    ICE_EVENT_OPENED
} Ice_EventKind;

typedef struct Ice_Event {
    Ice_EventKind kind;
    int connection; /* 0..ICE_CONNECTIONS-1, the transport's number */
    Ice_Int size;   /* bytes of the message in the buffer passed to receive */
} Ice_Event;

/* The port to a transport, which moves complete IceP messages on numbered connections. connect,
 * close and listen are called under the communicator's state lock, send by one task at a time,
 * receive by one task at a time. */
typedef struct Ice_Endpoint {
    const char* name; /* as in proxy strings: "xbee-at", "tcp" */
    /* Waits up to timeoutMs for one event. `buffer` takes a message of up to ICE_MESSAGE_MAX bytes,
     * and is not touched after the return. OPENED reports connections that the peer made. */
    Ice_Status (*receive)(void* context, Ice_Byte* buffer, Ice_Int timeoutMs, Ice_Event* event);
    /* Sends one message. ICE_CONNECTION_LOST: the connection has ended; CLOSED is also reported. */
    Ice_Status (*send)(void* context, int connection, const Ice_Byte* message, Ice_Int size);
    /* Connects to one endpoint, as encoded in a proxy (2-byte type + encapsulation). An open
     * connection to the same peer is reused. ICE_NO_ENDPOINT: another transport's type. */
    Ice_Status (*connect)(void* context, const Ice_Byte* encoded, Ice_Int size, int* connection);
    /* Closes a connection, without reporting CLOSED. */
    void (*close)(void* context, int connection);
    /* Starts to accept connections from peers; options 0: stops. */
    Ice_Status (*listen)(void* context, const char* options);
    /* Writes an endpoint in wire format from options such as "-a 1 -p 3" (up to their end, or an
     * unquoted colon); options 0: the endpoint in a proxy to an object of this side. Fails the
     * stream with ICE_FAILED_MALFORMED if the options are not valid for this transport. */
    void (*encode)(void* context, const char* options, Ice_OutputStreamPtr os);
    /* Makes receive return early; may be called by any task. */
    void (*wake)(void* context);
    /* Returns milliseconds since any time; wraps. */
    U32 (*nowMs)(void* context);
    /* Writes name and options of an encoded endpoint as text. Returns 0 for another transport's
     * type. The pointer itself may be 0: then endpoints print as opaque. */
    Ice_Bool (*print)(void* context, const Ice_Byte* encoded, Ice_Int size,
                      Ice_OutputStreamPtr text);
} Ice_Endpoint;

/* ---- options of endpoints, up to their end or an unquoted colon; for transports ---- */

/* Checks that there are only options of these letters, each with its value; a letter that is
 * followed by '-' has no value. `letters` 0: checks the quotes alone. */
Ice_Bool Ice_areOptions(const char* options, const char* letters);
/* Finds the value of the last "-x", without its quotes; 0 if it is missing. */
const char* Ice_findOption(const char* options, char letter, Ice_Int* size);
Ice_Bool Ice_hasOption(const char* options, char letter);
/* Reads the value, or the last of several, as a decimal number from 0 to `most`; leaves `value` if
 * the option is missing. Returns 0 if a value is not such a number. */
Ice_Bool Ice_integerOption(const char* options, char letter, Ice_Int most, Ice_Int* value);
/* Returns the value as a number, decimal or 0x...; `otherwise` if it is missing. Another text gives
 * 0xFFFFFFFF in the full run time. */
U32 Ice_numberOption(const char* options, char letter, U32 otherwise);

/* Two locks: SEND protects the buffer and order of requests while one is written and sent, STATE
 * the communicator's tables, briefly. A task that holds SEND may take STATE, not the reverse. */
enum { ICE_LOCK_STATE, ICE_LOCK_SEND };

/* The tasks' port, needed where several tasks use one communicator. The version for a single task
 * is Ice_Os_none. */
typedef struct Ice_Os {
    void (*lock)(void* context, int which);
    void (*unlock)(void* context, int which);
    /* Sleeps until wake of this slot (0..ICE_CALLS) or the time-out; an earlier wake counts. Each
     * slot has at most one waiting task, except the last slot: several tasks may wait on it, and a
     * wake wakes one of them. Returns 1 if woken. */
    int (*wait)(void* context, int slot, Ice_Int timeoutMs);
    void (*wake)(void* context, int slot);
    /* Returns a number that differs from task to task, 0 or greater. */
    int (*task)(void* context);
} Ice_Os;

extern const Ice_Os Ice_Os_none;
