/* SPDX-License-Identifier: MIT
 *
 * icec: a small peer of ZeroC Ice 3.7 in C90: communicator, object adapter, servants, proxies.
 *
 *     Ice_initialize(&ic);
 *     TcpEndpoint_init(&ic, &tcp);                     (a transport: endpoints/)
 *     Ice_Communicator_createObjectAdapterWithEndpoints(&ic, "A", "tcp -p 10000", &adapter);
 *     M_Thing_init(&thing);                            (generated from Slice)
 *     Ice_ObjectAdapter_add(&adapter, (Ice_ObjectPtr)&thing, "thing");
 *     Ice_ObjectAdapter_activate(&adapter);
 *     Ice_Communicator_stringToProxy(&ic, "other:tcp -h ground -p 10000", &prx);
 *     if (M_OtherPrx_op(&prx, in, &out) != ICE_OK)     (a call, generated)
 *         ...                                          (Ice_ObjectPrx_failure has details)
 *     Ice_Communicator_waitForShutdown(&ic);           (serves)
 *
 * Nothing is allocated: the caller owns every object named here, and keeps it, and strings passed
 * as `const char*`, while it is in use. The limits are in ice_config.h. Any task may call every
 * function if an Ice_Os is set; a proxy object belongs to one task at a time (copies are plain
 * assignments). Results returned by pointer (strings, sequences, exceptions, instances) belong to
 * the task until it makes its next call, or serves (poll, waitForShutdown), whatever other tasks
 * do; with Ice_ObjectPrx_setReplyBuffer, until the next call through that proxy. Names follow the
 * paper's figures; for more see docs/icec.md.
 */
#pragma once

#include "ice_port.h"

typedef struct Ice_Communicator Ice_Communicator, *Ice_CommunicatorPtr;
typedef struct Ice_ObjectAdapter Ice_ObjectAdapter, *Ice_ObjectAdapterPtr;
typedef struct Ice_Object Ice_Object, *Ice_ObjectPtr;
typedef struct Ice_ObjectPrx Ice_ObjectPrx, *Ice_ObjectPrxPtr;

typedef struct Ice_Identity {
    Ice_String name, category;
} Ice_Identity;

/* Entry of a request context. An array of entries ends with a key of 0. */
typedef struct Ice_ContextEntry {
    const char *key, *value;
} Ice_ContextEntry;

/* ---- servants ---- */

/* The call being dispatched. Its strings are valid during the dispatch. */
typedef struct Ice_Current {
    Ice_CommunicatorPtr communicator;
    Ice_ObjectAdapterPtr adapter;
    Ice_String name, category, facet, operation;
    Ice_Byte mode;  /* mode of the call: 0 normal, 1 nonmutating, 2 idempotent */
    Ice_Byte minor; /* minor version of the encoding: 1.minor */
    int connection;
    Ice_Int requestId;       /* 0: oneway */
    Ice_InputStream context; /* the caller's context; read it with Ice_Current_context */
} Ice_Current;

/* Reads the parameters from `is`, runs the operation, and writes the results to `os` after the
 * servant's function has returned; before that `os` has no buffer. Returns ICE_OPERATION_NOT_EXIST
 * if the operation does not exist. */
typedef Ice_Status (*Ice_Dispatch)(Ice_ObjectPtr self, const Ice_Current* current,
                                   Ice_InputStreamPtr is, Ice_OutputStreamPtr os);

struct Ice_Object {
    Ice_Dispatch dispatch;
    /* type ids in alphabetical order, including "::Ice::Object"; 0 marks the end */
    const char* const* ids;
    const char* id; /* most derived type id of the servant */
};

/* Runs an operation of a servant as a request does: ice_ping, ice_isA, ice_id and ice_ids are
 * answered from the servant's ids. In the full run time, a servant with `ids` 0 receives these four
 * operations as well. Such a servant can forward all requests; or it logs them, and passes them to
 * another servant with this function. */
Ice_Status Ice_Object_invoke(Ice_ObjectPtr servant, const Ice_Current* current,
                             Ice_InputStreamPtr is, Ice_OutputStreamPtr os);

/* Looks up a key of the caller's context. Returns 1 and sets `value` if it exists. */
Ice_Bool Ice_Current_context(const Ice_Current* current, const char* key, Ice_String* value);
/* Returns 1 and the entry number `index` (from 0) of the caller's context, or 0 after the last
 * entry. */
Ice_Bool Ice_Current_contextAt(const Ice_Current* current, Ice_Int index, Ice_String* key,
                               Ice_String* value);
/* Returns room for the targets of the results, aligned to 8 bytes. It lies in the request's arena
 * (ICE_ARENA_BYTES, parameters included), and is valid until the reply has been sent, or the
 * servant's function has returned ICE_LATER. Returns 0 if there is not enough room. */
void* Ice_Current_allocate(const Ice_Current* current, Ice_Int bytes);

/* Ends an operation with `text` as the reason of its failure: `return Ice_Current_fail(current,
 * "...")`. ICE_CHECK does this if its condition is false. The text is then the servant's file and
 * line: the caller gets UnknownLocalException("pump.c:42: litres > 0"). Full run time. */
Ice_Status Ice_Current_fail(const Ice_Current* current, const char* text);
#define ICE_CHECK(current, condition)                                                          \
    do {                                                                                       \
        if (!(condition))                                                                      \
            return Ice_Current_fail(current, __FILE__ ":" ICE_TEXT(__LINE__) ": " #condition); \
    } while (0)
#define ICE_TEXT(x) ICE_TEXT_OF(x)
#define ICE_TEXT_OF(x) #x

/* Allows a servant to answer a call later, after its function returned ICE_LATER. */
typedef struct Ice_Reply {
    Ice_CommunicatorPtr communicator;
    Ice_Int id;
    int connection;
    U16 generation;
    Ice_Byte minor;
} Ice_Reply;

/* Marks a request that arrived by broadcast, so that only operations with the metadata
 * [":broadcast"] accept it. Transports call this function. Returns 0 if the message is not a
 * request, or if its sender expects a reply. */
int Ice_markBroadcast(Ice_Byte* message, Ice_Int size);

/* Fills `reply`; to be called while the operation runs. */
void Ice_Current_later(const Ice_Current* current, Ice_Reply* reply);
/* Returns the stream for the results, or for a user exception; Ice_Reply_end must follow. */
Ice_OutputStreamPtr Ice_Reply_begin(Ice_Reply* reply);
/* Sends the reply: with ICE_OK and ICE_USER_EXCEPTION the stream's content, with any other status
 * that failure. Returns ICE_CONNECTION_LOST if the caller has gone. */
Ice_Status Ice_Reply_end(Ice_Reply* reply, Ice_Status status);

/* ---- object adapters ---- */

/* Adds a servant. `identity` is "name" or "category/name", and is kept as a pointer. Returns
 * ICE_LIMIT if another servant has this identity or if ICE_SERVANTS servants exist, and ICE_PARSE
 * if the identity is malformed. */
Ice_Status Ice_ObjectAdapter_add(Ice_ObjectAdapterPtr adapter, Ice_ObjectPtr servant,
                                 const char* identity);
Ice_Status Ice_ObjectAdapter_addFacet(Ice_ObjectAdapterPtr adapter, Ice_ObjectPtr servant,
                                      const char* identity, const char* facet);
/* Adds a servant for each identity of the category that has no servant. With category "", adds a
 * servant for each identity of every category. */
Ice_Status Ice_ObjectAdapter_addDefaultServant(Ice_ObjectAdapterPtr adapter, Ice_ObjectPtr servant,
                                               const char* category);
/* Removes a servant. Returns ICE_OBJECT_NOT_EXIST if no servant has this identity. */
Ice_Status Ice_ObjectAdapter_remove(Ice_ObjectAdapterPtr adapter, const char* identity);
Ice_Status Ice_ObjectAdapter_removeFacet(Ice_ObjectAdapterPtr adapter, const char* identity,
                                         const char* facet);
Ice_Status Ice_ObjectAdapter_removeDefaultServant(Ice_ObjectAdapterPtr adapter,
                                                  const char* category);
/* Returns the servant of exactly this identity, without a facet; 0 if there is no such servant. */
Ice_ObjectPtr Ice_ObjectAdapter_find(Ice_ObjectAdapterPtr adapter, const char* identity);
/* Activates or deactivates an adapter. Callers reach its objects only while it is active and not
 * destroyed. */
void Ice_ObjectAdapter_activate(Ice_ObjectAdapterPtr adapter);
void Ice_ObjectAdapter_deactivate(Ice_ObjectAdapterPtr adapter);
void Ice_ObjectAdapter_destroy(Ice_ObjectAdapterPtr adapter);
/* Makes a proxy to an object of this adapter, which can be passed to a peer. `identity` is
 * "category/name", or the identity in an Ice_Current. Returns ICE_LIMIT if ICE_IDENTITY_MAX or
 * ICE_ENDPOINT_MAX is too small. */
Ice_Status Ice_ObjectAdapter_createProxy(Ice_ObjectAdapterPtr adapter, const char* identity,
                                         Ice_ObjectPrxPtr prx);
Ice_Status Ice_ObjectAdapter_createProxyTo(Ice_ObjectAdapterPtr adapter,
                                           const Ice_Identity* identity, Ice_ObjectPrxPtr prx);

/* ---- proxies ---- */

enum { ICE_TWOWAY, ICE_ONEWAY, ICE_BATCH_ONEWAY, ICE_DATAGRAM, ICE_BATCH_DATAGRAM };

/* A buffer for one-way requests that are sent together. */
typedef struct Ice_Batch {
    Ice_OutputStream os;
    Ice_Int count;
    /* function of the run time that keeps a call in the batch */
    Ice_Status (*keep)(Ice_ObjectPrxPtr prx);
} Ice_Batch;

/* A proxy. Frequently used members come first, because their offsets are short. */
struct Ice_ObjectPrx {
    Ice_CommunicatorPtr communicator;
    int call;          /* slot of the last call; -1 without a call */
    int connection;    /* connection of the last call; a fixed proxy has only this connection */
    Ice_Int timeoutMs; /* time-out for connecting and for a reply, ms; default 10 s */
    Ice_Byte mode, secure;
    Ice_Byte minor;  /* encoding of requests, 1.minor */
    Ice_Byte status; /* Ice_Status of the last call */
    Ice_Byte identitySize, endpointsSize;
    U16 generation; /* generation of a fixed proxy's connection; 0 if the proxy is not fixed */
    const Ice_ContextEntry* context;
    Ice_Batch* batch;
    /* reply buffer of this proxy; 0 selects the communicator's buffer of ICE_REPLY_MAX bytes */
    U32* reply;
    Ice_Int replySize;
    Ice_Byte identity[ICE_IDENTITY_MAX]; /* identity in wire format: name, category, facet */
    /* endpoints in wire format: their number and the endpoints, or 0 and the id of an adapter */
    Ice_Byte endpoints[ICE_ENDPOINT_MAX];
    /* request id of the last call; 0 if the call had no reply */
    Ice_Int id;
    const char* operation; /* operation of the last call */
    /* reason of the last call's failure if this side detected the failure; otherwise 0 */
    const char* reason;
    /* versions of protocol and encoding that are sent with the proxy; full run time only */
    Ice_Byte versions[4];
};

/* Reason of a failed call. identity, facet and operation are those of the call, for
 * ICE_OBJECT_NOT_EXIST and similar failures. The text is the peer's for failures of the peer;
 * for ICE_MARSHAL and ICE_LIMIT it is the limit with its macro and value. */
typedef struct Ice_Failure {
    Ice_Identity identity;
    Ice_String facet, operation;
    Ice_String unknown;
} Ice_Failure;

/* Makes a proxy from "identity [-t|-o|-O|-d|-D|-s] [-f facet] [-e 1.0|1.1]:transport options[:...]"
 * or "...@adapter", as in Ice's manual; the minimal run time from "name [-t|-o]:transport options".
 * Returns ICE_PARSE if the text is malformed, and ICE_LIMIT if ICE_IDENTITY_MAX or ICE_ENDPOINT_MAX
 * is too small. */
Ice_Status Ice_Communicator_stringToProxy(Ice_CommunicatorPtr ic, const char* proxy,
                                          Ice_ObjectPrxPtr prx);
/* Writes the proxy as a string of at most `size` bytes, including the end mark. Returns
 * ICE_LIMIT if the string is longer. */
Ice_Status Ice_Communicator_proxyToString(const Ice_ObjectPrx* prx, char* text, Ice_Int size);
int Ice_ObjectPrx_isNull(const Ice_ObjectPrx* prx);
int Ice_ObjectPrx_equals(const Ice_ObjectPrx* a, const Ice_ObjectPrx* b);
Ice_Identity Ice_ObjectPrx_getIdentity(const Ice_ObjectPrx* prx);
Ice_String Ice_ObjectPrx_getFacet(const Ice_ObjectPrx* prx);

/* Functions that change a copy of a proxy: `Ice_ObjectPrx other = *prx;
 * Ice_ObjectPrx_ice_facet(&other, "f");` */
Ice_Status Ice_ObjectPrx_ice_identity(Ice_ObjectPrxPtr prx, const char* identity);
Ice_Status Ice_ObjectPrx_ice_facet(Ice_ObjectPrxPtr prx, const char* facet);
void Ice_ObjectPrx_ice_twoway(Ice_ObjectPrxPtr prx);
void Ice_ObjectPrx_ice_oneway(Ice_ObjectPrxPtr prx);
/* Collects calls in `data`, which belongs to the caller, until the calls are flushed or `data`
 * is full. */
void Ice_ObjectPrx_ice_batchOneway(Ice_ObjectPrxPtr prx, Ice_Batch* batch, Ice_Byte* data,
                                   Ice_Int size);
Ice_Status Ice_ObjectPrx_ice_flushBatchRequests(Ice_ObjectPrxPtr prx);
void Ice_ObjectPrx_ice_context(Ice_ObjectPrxPtr prx, const Ice_ContextEntry* context); /* 0: none */
void Ice_ObjectPrx_ice_invocationTimeout(Ice_ObjectPrxPtr prx, Ice_Int ms);
/* Gives the proxy a separate buffer for replies, aligned to 8 bytes; without it, the proxy uses
 * the ICE_REPLY_MAX bytes of the communicator. The buffer of `bytes` holds one reply and its
 * decoded sequences. */
void Ice_ObjectPrx_setReplyBuffer(Ice_ObjectPrxPtr prx, U32* buffer, Ice_Int bytes);
void Ice_ObjectPrx_ice_encodingVersion(Ice_ObjectPrxPtr prx, Ice_Byte minor);

Ice_Status Ice_ObjectPrx_ice_ping(Ice_ObjectPrxPtr self);
Ice_Status Ice_ObjectPrx_ice_isA(Ice_ObjectPrxPtr self, const char* id, Ice_Bool* result);
Ice_Status Ice_ObjectPrx_ice_id(Ice_ObjectPrxPtr self, Ice_String* result);
/* Makes `self` a copy of `from` if the object has the type, and otherwise a null proxy. Returns
 * whether the object replied. */
Ice_Status Ice_ObjectPrx_checkedCast(Ice_ObjectPrxPtr self, const Ice_ObjectPrx* from,
                                     const char* id);
/* Opens the connection that later calls will use. */
Ice_Status Ice_ObjectPrx_ice_getConnection(Ice_ObjectPrxPtr self, int* connection);
/* Gives an indirect proxy ("object", "object@adapter") the endpoints that a locator returns;
 * `locator` is a proxy to an Ice::Locator, such as that of IceGrid. A direct proxy does not change.
 * The proxy keeps the endpoints; to resolve again, call this function with a new copy of the
 * indirect proxy. Returns ICE_NO_ENDPOINT if the locator does not know the object. */
Ice_Status Ice_ObjectPrx_resolve(Ice_ObjectPrxPtr self, Ice_ObjectPrxPtr locator);
/* Describes the failure of the last call through this proxy, until its next call. The peer's
 * text is valid as long as the results of the call, and is empty afterwards. */
void Ice_ObjectPrx_failure(const Ice_ObjectPrx* self, Ice_Failure* failure);

/* Four steps of a call in generated code: begin, writes to the returned stream, invoke, reads, end.
 * begin returns 0, with the reason in self->status, if all ICE_CALLS slots are taken, or if `mode`
 * has ICE_RESULTS and the proxy is oneway or batch. No other call may be made between begin and
 * invoke. */
#define ICE_RESULTS 0x80 /* in `mode`: the operation has results or exceptions */
Ice_OutputStreamPtr Ice_ObjectPrx_begin(Ice_ObjectPrxPtr self, const char* operation,
                                        Ice_Byte mode);
Ice_Status Ice_ObjectPrx_invoke(Ice_ObjectPrxPtr self, Ice_InputStreamPtr* is);
Ice_Status Ice_ObjectPrx_end(Ice_ObjectPrxPtr self, Ice_Status status);
/* Replaces invoke and end in an asynchronous call. The task that receives the reply calls
 * `callback` with it, unless this function returned a status other than ICE_OK. `is` is valid
 * during the callback. */
typedef void (*Ice_Callback)(void* cookie, Ice_Status status, Ice_InputStreamPtr is);
Ice_Status Ice_ObjectPrx_invokeAsync(Ice_ObjectPrxPtr self, Ice_Callback callback, void* cookie);

/* Write and read a proxy. A proxy pointer of 0 is written as the null proxy, which is read as a
 * proxy with an empty name. With `ic` 0, the communicator of the stream is used. */
void Ice_OutputStream_writePrx(Ice_OutputStreamPtr os, const Ice_ObjectPrx* prx);
void Ice_InputStream_readPrx(Ice_InputStreamPtr is, Ice_CommunicatorPtr ic, Ice_ObjectPrxPtr prx);

/* ---- communicator ---- */

void Ice_initialize(Ice_CommunicatorPtr ic);
/* Set the port to the operating system, and a transport. Call both functions before any other
 * function; the objects that are passed must stay valid. Each call of the second function adds a
 * transport, up to ICE_TRANSPORTS; a further call replaces the last transport. A call uses the
 * transport of its proxy's endpoints. */
void Ice_Communicator_setOs(Ice_CommunicatorPtr ic, const Ice_Os* os, void* context);
void Ice_Communicator_setEndpoint(Ice_CommunicatorPtr ic, const Ice_Endpoint* endpoint,
                                  void* context);

/* Releases the result of the last call of a task, and its place among ICE_CALLS; `task` is a
 * number returned by the function task of Ice_Os. The kernel calls it when a task ends; a task that
 * continues may call it when it does not need the result any more. It must not be called during a
 * call. The function takes the state lock, so a kernel hook that may not wait must let another task
 * call it. Full run time. */
void Ice_Communicator_endTask(Ice_CommunicatorPtr ic, int task);

/* Takes properties from an array of strings "key=value" that ends with 0. If a key occurs twice,
 * the first is used. */
void Ice_Communicator_setProperties(Ice_CommunicatorPtr ic, const char* const* table);
/* Returns the property's value; 0 if it is not set. */
const char* Ice_Communicator_getProperty(Ice_CommunicatorPtr ic, const char* key);
/* Returns the property's value as a number; `otherwise` if the property is not set or is not a
 * number. */
Ice_Int Ice_Communicator_getPropertyAsInt(Ice_CommunicatorPtr ic, const char* key,
                                          Ice_Int otherwise);
Ice_Status Ice_Communicator_propertyToProxy(Ice_CommunicatorPtr ic, const char* key,
                                            Ice_ObjectPrxPtr prx);

/* Makes an adapter, inactive at first. `endpoints` names the transport and its options: "xbee-at"
 * or "tcp -p 10000"; or several, with colons between them. Returns ICE_NO_ENDPOINT if no transport
 * has this name, or if the system refuses the address. */
Ice_Status Ice_Communicator_createObjectAdapterWithEndpoints(Ice_CommunicatorPtr ic,
                                                             const char* name,
                                                             const char* endpoints,
                                                             Ice_ObjectAdapterPtr adapter);
/* Makes an adapter with the endpoints in the property <name>.Endpoints. Without this property,
 * the adapter has no endpoints, and only peers to which this side has connected can call its
 * objects. */
Ice_Status Ice_Communicator_createObjectAdapter(Ice_CommunicatorPtr ic, const char* name,
                                                Ice_ObjectAdapterPtr adapter);
/* Receives and dispatches requests until Ice_Communicator_shutdown is called. Several tasks may
 * call it; one of them receives at a time. */
void Ice_Communicator_waitForShutdown(Ice_CommunicatorPtr ic);
/* Stops serving: connections are no longer accepted and requests no longer executed. Callers
 * learn this because their connections are closed. Calls of this side continue. */
void Ice_Communicator_shutdown(Ice_CommunicatorPtr ic);
/* Handles at most one event; for programs with a main loop. Returns ICE_TIMEOUT if no event
 * arrived, or if another task was receiving all the time. */
Ice_Status Ice_Communicator_poll(Ice_CommunicatorPtr ic, Ice_Int timeoutMs);
/* Shuts down, and closes every connection gracefully: waits up to timeoutMs for operations in
 * progress to be answered, and for the peers to close. */
void Ice_Communicator_destroy(Ice_CommunicatorPtr ic, Ice_Int timeoutMs);

/* Makes a proxy to an object of the peer on this connection, whichever side made the connection.
 * Calls through the proxy use this connection. The proxy ends with the connection
 * (ICE_CONNECTION_LOST), and cannot be passed to others. `identity` is "category/name", or as from
 * Ice_ObjectPrx_getIdentity. */
Ice_Status Ice_Connection_createProxy(Ice_CommunicatorPtr ic, int connection, const char* identity,
                                      Ice_ObjectPrxPtr prx);
Ice_Status Ice_Connection_createProxyTo(Ice_CommunicatorPtr ic, int connection,
                                        const Ice_Identity* identity, Ice_ObjectPrxPtr prx);
/* Closes one connection gracefully, without waiting for the peer. */
void Ice_Connection_close(Ice_CommunicatorPtr ic, int connection);

#ifdef ICEC_MINIMAL
#include "ice_minimal.h"
#else
#include "ice_objects.h"
#endif
