/* SPDX-License-Identifier: MIT
 *
 * ice_port: the functions that IceC needs from its environment: a transport, and, if several tasks
 * use IceC, an operating system.
 */
#pragma once

#include "ice_stream.h"

typedef enum Ice_Status {
    /* The first eight statuses have the same numbers as the reply statuses in Ice's protocol. */
    ICE_OK = 0,
    ICE_USER_EXCEPTION, /* the operation threw a user exception; its body is in the stream */
    ICE_OBJECT_NOT_EXIST,
    ICE_FACET_NOT_EXIST,
    ICE_OPERATION_NOT_EXIST,
    ICE_UNKNOWN_LOCAL_EXCEPTION, /* the peer's Ice run time reported a failure */
    /* the servant threw an exception that the operation does not declare */
    ICE_UNKNOWN_USER_EXCEPTION,
    ICE_UNKNOWN_EXCEPTION, /* the peer reported a failure of another kind */
    /* If a servant returns ICE_MARSHAL or ICE_PROTOCOL, the caller gets a local exception; for any
     * later status, the caller gets an unknown exception. */
    ICE_MARSHAL, /* the message is malformed or too large */
    /* the message is not IceP 1.0, is compressed, or has an encoding other than 1.0 and 1.1 */
    ICE_PROTOCOL,
    ICE_TIMEOUT,
    /* the connection was lost; a call in progress may or may not have been executed */
    ICE_CONNECTION_LOST,
    ICE_NO_ENDPOINT, /* the transport is unknown, or the proxy has no endpoints */
    ICE_LIMIT,       /* a limit of ice_config.h was reached */
    /* the peer closed the connection gracefully: the call was not executed */
    ICE_CONNECTION_CLOSED,
    ICE_PARSE, /* the text of a proxy, identity or endpoint is malformed */
    /* the operation has results, which a oneway or batch proxy cannot receive */
    ICE_TWOWAY_ONLY,
    ICE_LATER /* returned by a servant that sends its reply later (Ice_Reply) */
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
    int connection; /* connection number of the transport, 0..ICE_CONNECTIONS-1 */
    Ice_Int size;   /* size of the message in the buffer that was passed to receive, bytes */
} Ice_Event;

/* The port to a transport. A transport moves complete IceP messages on numbered connections.
 * connect, close and listen are called under the communicator's state lock; send and receive are
 * each called by one task at a time. */
typedef struct Ice_Endpoint {
    const char* name; /* name in proxy strings: "xbee-at", "tcp" */
    /* Waits up to timeoutMs for one event. A message of up to ICE_MESSAGE_MAX bytes is stored in
     * `buffer`. After the function has returned, the transport no longer writes to `buffer`. The
     * event OPENED reports a connection that the peer has made. */
    Ice_Status (*receive)(void* context, Ice_Byte* buffer, Ice_Int timeoutMs, Ice_Event* event);
    /* Sends one message. Returns ICE_CONNECTION_LOST if the connection has ended; receive then also
     * reports the event CLOSED. */
    Ice_Status (*send)(void* context, int connection, const Ice_Byte* message, Ice_Int size);
    /* Connects to one endpoint, which is encoded as in a proxy: type (2 bytes) and encapsulation.
     * Uses the open connection to the same peer if there is one. Returns ICE_NO_ENDPOINT if the
     * type belongs to another transport. */
    Ice_Status (*connect)(void* context, const Ice_Byte* encoded, Ice_Int size, int* connection);
    /* Closes a connection. The event CLOSED is not reported. */
    void (*close)(void* context, int connection);
    /* Starts to accept connections from peers. If `options` is 0, stops accepting. */
    Ice_Status (*listen)(void* context, const char* options);
    /* Converts options such as "-a 1 -p 3" to an endpoint in wire format. The options end at the
     * end of the string or at an unquoted colon. If `options` is 0, writes the endpoint of this
     * side, which is part of every proxy to one of its objects. Fails the stream with
     * ICE_FAILED_MALFORMED if the options are not valid for this transport. */
    void (*encode)(void* context, const char* options, Ice_OutputStreamPtr os);
    /* Makes receive return early; any task may call this function. */
    void (*wake)(void* context);
    /* Returns milliseconds since an arbitrary time; the count wraps. */
    U32 (*nowMs)(void* context);
    /* Writes the name of the transport and the options of an encoded endpoint as text. Returns 0 if
     * the endpoint's type belongs to another transport. The function pointer may be 0; endpoints
     * are then printed as opaque. */
    Ice_Bool (*print)(void* context, const Ice_Byte* encoded, Ice_Int size,
                      Ice_OutputStreamPtr text);
} Ice_Endpoint;

/* ---- functions for transports: options of an endpoint; they end at the end of the text or at an
 * unquoted colon ---- */

/* Returns 1 if the text contains only options with these letters. Each option has a value, except a
 * letter followed by '-' in `letters`. If `letters` is 0, checks only the quotes. */
Ice_Bool Ice_areOptions(const char* options, const char* letters);
/* Returns the value of the option -x with this letter, without quotes; if the option occurs several
 * times, the last value. Returns 0 if the option is missing. */
const char* Ice_findOption(const char* options, char letter, Ice_Int* size);
Ice_Bool Ice_hasOption(const char* options, char letter);
/* Reads the option's value, a decimal number from 0 to `most`; if the option occurs several
 * times, the last value. Leaves `value` unchanged if the option is missing. Returns 0 if any of
 * the values is not such a number. */
Ice_Bool Ice_integerOption(const char* options, char letter, Ice_Int most, Ice_Int* value);
/* Returns the option's value, a number in decimal or 0x...; `otherwise` if the option is missing.
 * If the value is not a number, returns 0xFFFFFFFF in the full run time. */
U32 Ice_numberOption(const char* options, char letter, U32 otherwise);

/* Two locks. ICE_LOCK_SEND protects the request buffer, and the order of requests from writing to
 * sending. ICE_LOCK_STATE protects the communicator's tables and is only held for a short time. A
 * task that holds SEND may acquire STATE; the reverse is not allowed. */
enum { ICE_LOCK_STATE, ICE_LOCK_SEND };

/* The port to an operating system, needed if several tasks use one communicator. Ice_Os_none is
 * the version for a single task. */
typedef struct Ice_Os {
    void (*lock)(void* context, int which);
    void (*unlock)(void* context, int which);
    /* Sleeps until `wake` is called for this slot (0..ICE_CALLS) or the time-out expires. A wake
     * that precedes the sleep is not lost. At most one task waits on each slot, except on the last
     * slot: several tasks may wait there, and a wake wakes one of them. Returns 1 if woken. */
    int (*wait)(void* context, int slot, Ice_Int timeoutMs);
    void (*wake)(void* context, int slot);
    /* Returns a number, 0 or greater, that is different for each task. */
    int (*task)(void* context);
} Ice_Os;

extern const Ice_Os Ice_Os_none;
