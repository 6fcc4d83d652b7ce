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
 * No memory is allocated. The caller owns every object in this example, and must keep it while it
 * is in use; the same is true of strings passed as `const char*`. The limits are in ice_config.h.
 * If an Ice_Os is set, any task may call every function. A proxy object belongs to one task at a
 * time; a copy is made by assignment. Results returned by pointer (strings, sequences, exceptions,
 * instances) are valid until the same task makes its next call or serves (poll, waitForShutdown);
 * other tasks do not affect them. With Ice_ObjectPrx_setReplyBuffer, they are valid until the next
 * call through the same proxy. Names follow the paper's figures; for more see docs/icec.md.
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

/* The request being dispatched. Its strings are valid during the dispatch. */
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

/* Reads the parameters from `is` and runs the operation. When the servant's function has returned,
 * writes the results to `os`; before that, `os` has no buffer. Returns ICE_OPERATION_NOT_EXIST if
 * no such operation exists. */
typedef Ice_Status (*Ice_Dispatch)(Ice_ObjectPtr self, const Ice_Current* current,
                                   Ice_InputStreamPtr is, Ice_OutputStreamPtr os);

struct Ice_Object {
    Ice_Dispatch dispatch;
    /* type ids in alphabetical order, including "::Ice::Object"; 0 marks the end */
    const char* const* ids;
    const char* id; /* most derived type id of the servant */
};

/* Runs an operation of a servant as a request would. ice_ping, ice_isA, ice_id and ice_ids are
 * answered from the servant's `ids`. In the full run time, a servant with `ids` 0 receives
 * these four operations like all others. Such a servant can forward all requests; or it can log
 * each request and pass it to another servant by this function. */
Ice_Status Ice_Object_invoke(Ice_ObjectPtr servant, const Ice_Current* current,
                             Ice_InputStreamPtr is, Ice_OutputStreamPtr os);

/* Finds a key in the caller's context. Returns 1 and sets `value` if the key exists. */
Ice_Bool Ice_Current_context(const Ice_Current* current, const char* key, Ice_String* value);
/* Returns 1 and sets `key` and `value` to entry number `index` (from 0) of the caller's context.
 * Returns 0 after the last entry. */
Ice_Bool Ice_Current_contextAt(const Ice_Current* current, Ice_Int index, Ice_String* key,
                               Ice_String* value);
/* Returns memory for the data to which the results point, aligned to 8 bytes. The memory is a part
 * of the request's arena, which also holds the parameters (ICE_ARENA_BYTES). It is valid until the
 * reply has been sent, or until the servant's function has returned ICE_LATER. Returns 0 if there
 * is not enough room. */
void* Ice_Current_allocate(const Ice_Current* current, Ice_Int bytes);

/* Refuses a call: `return Ice_Current_refuse(current, "litres: expected 1 to 9")`. The caller gets
 * UnknownException with this text. Full run time. */
Ice_Status Ice_Current_refuse(const Ice_Current* current, const char* text);

/* Ends an operation with `text` as the reason of its failure: `return Ice_Current_fail(current,
 * "...")`. ICE_CHECK calls this function if its condition is false; the text then contains the
 * servant's file and line, and the caller gets UnknownLocalException("pump.c:42: litres > 0"). Full
 * run time. */
Ice_Status Ice_Current_fail(const Ice_Current* current, const char* text);
#define ICE_CHECK(current, condition)                                                          \
    do {                                                                                       \
        if (!(condition))                                                                      \
            return Ice_Current_fail(current, __FILE__ ":" ICE_TEXT(__LINE__) ": " #condition); \
    } while (0)
#define ICE_TEXT(x) ICE_TEXT_OF(x)
#define ICE_TEXT_OF(x) #x

/* Data that a servant keeps in order to reply later, after its function has returned ICE_LATER. */
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

/* Fills `reply`. Must be called while the operation runs. */
void Ice_Current_later(const Ice_Current* current, Ice_Reply* reply);
/* Returns the stream for the results, or for a user exception. Ice_Reply_end must be called
 * afterwards. */
Ice_OutputStreamPtr Ice_Reply_begin(Ice_Reply* reply);
/* Sends the reply. With ICE_OK and ICE_USER_EXCEPTION, the reply contains the bytes of the stream;
 * with any other status, the reply reports this failure. Returns ICE_CONNECTION_LOST if the caller
 * has disconnected. */
Ice_Status Ice_Reply_end(Ice_Reply* reply, Ice_Status status);

/* ---- object adapters ---- */

/* Adds a servant. `identity` is "name" or "category/name"; the text is not copied.
 * Returns ICE_LIMIT if another servant has this identity or if ICE_SERVANTS servants exist, and
 * ICE_PARSE if the identity is malformed. */
Ice_Status Ice_ObjectAdapter_add(Ice_ObjectAdapterPtr adapter, Ice_ObjectPtr servant,
                                 const char* identity);
Ice_Status Ice_ObjectAdapter_addFacet(Ice_ObjectAdapterPtr adapter, Ice_ObjectPtr servant,
                                      const char* identity, const char* facet);
/* Adds a default servant for a category: it receives the requests to identities of this category
 * that have no servant. With category "", it receives the requests to all identities that have no
 * other servant. */
Ice_Status Ice_ObjectAdapter_addDefaultServant(Ice_ObjectAdapterPtr adapter, Ice_ObjectPtr servant,
                                               const char* category);
/* Removes a servant. Returns ICE_OBJECT_NOT_EXIST if no servant has this identity. */
Ice_Status Ice_ObjectAdapter_remove(Ice_ObjectAdapterPtr adapter, const char* identity);
Ice_Status Ice_ObjectAdapter_removeFacet(Ice_ObjectAdapterPtr adapter, const char* identity,
                                         const char* facet);
Ice_Status Ice_ObjectAdapter_removeDefaultServant(Ice_ObjectAdapterPtr adapter,
                                                  const char* category);
/* Returns the servant of exactly this identity, without a facet; 0 if no such servant exists. */
Ice_ObjectPtr Ice_ObjectAdapter_find(Ice_ObjectAdapterPtr adapter, const char* identity);
/* Activates or deactivates an adapter. Callers reach the adapter's objects only while the adapter
 * is active and not destroyed. */
void Ice_ObjectAdapter_activate(Ice_ObjectAdapterPtr adapter);
void Ice_ObjectAdapter_deactivate(Ice_ObjectAdapterPtr adapter);
void Ice_ObjectAdapter_destroy(Ice_ObjectAdapterPtr adapter);
/* Makes a proxy to an object of this adapter; the proxy can be passed to a peer. `identity` is
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
    /* function of the run time that adds a call to the batch */
    Ice_Status (*keep)(Ice_ObjectPrxPtr prx);
} Ice_Batch;

/* A proxy. Frequently used members come first, because short offsets make shorter code. */
struct Ice_ObjectPrx {
    Ice_CommunicatorPtr communicator;
    int call;          /* slot of the last call; -1 without a call */
    int connection;    /* connection of the last call; a fixed proxy can only use this connection */
    Ice_Int timeoutMs; /* time-out for connecting and for a reply, ms; default 10 s */
    Ice_Byte mode, secure;
    Ice_Byte minor;  /* encoding of requests: 1.minor */
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
    /* text with the reason of the last call's failure, if this side detected the failure; otherwise
     * 0 */
    const char* reason;
    /* versions of protocol and encoding that are sent with the proxy; full run time only */
    Ice_Byte versions[4];
};

/* Reason of a failed call. After ICE_OBJECT_NOT_EXIST and similar failures, identity, facet and
 * operation describe the call. `text`: after a failure of the peer, the text in its reply;
 * after ICE_MARSHAL and ICE_LIMIT, the limit, with its macro and value. */
typedef struct Ice_Failure {
    Ice_Identity identity;
    Ice_String facet, operation;
    Ice_String unknown;
} Ice_Failure;

/* Makes a proxy from a string, as in Ice's manual: "identity [-t|-o|-O|-d|-D|-s] [-f facet] [-e
 * 1.0|1.1]:transport options[:...]" or "...@adapter". The minimal run time only accepts "name
 * [-t|-o]:transport options". Returns ICE_PARSE if the text is malformed, and ICE_LIMIT if
 * ICE_IDENTITY_MAX or ICE_ENDPOINT_MAX is too small. */
Ice_Status Ice_Communicator_stringToProxy(Ice_CommunicatorPtr ic, const char* proxy,
                                          Ice_ObjectPrxPtr prx);
/* Writes the proxy as a string of at most `size` bytes, including the terminating zero. Returns
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
/* Makes a batch proxy. Its calls are collected in `data`, which belongs to the caller, until they
 * are flushed or `data` is full. */
void Ice_ObjectPrx_ice_batchOneway(Ice_ObjectPrxPtr prx, Ice_Batch* batch, Ice_Byte* data,
                                   Ice_Int size);
Ice_Status Ice_ObjectPrx_ice_flushBatchRequests(Ice_ObjectPrxPtr prx);
void Ice_ObjectPrx_ice_context(Ice_ObjectPrxPtr prx, const Ice_ContextEntry* context); /* 0: none */
void Ice_ObjectPrx_ice_invocationTimeout(Ice_ObjectPrxPtr prx, Ice_Int ms);
/* Gives the proxy a separate buffer for replies, aligned to 8 bytes. The `bytes` bytes of the
 * buffer must hold one reply and its decoded sequences. Without a separate buffer, the proxy uses a
 * buffer of ICE_REPLY_MAX bytes of the communicator. */
void Ice_ObjectPrx_setReplyBuffer(Ice_ObjectPrxPtr prx, U32* buffer, Ice_Int bytes);
void Ice_ObjectPrx_ice_encodingVersion(Ice_ObjectPrxPtr prx, Ice_Byte minor);

Ice_Status Ice_ObjectPrx_ice_ping(Ice_ObjectPrxPtr self);
Ice_Status Ice_ObjectPrx_ice_isA(Ice_ObjectPrxPtr self, const char* id, Ice_Bool* result);
Ice_Status Ice_ObjectPrx_ice_id(Ice_ObjectPrxPtr self, Ice_String* result);
/* Asks the object for its type. If the object has the type `id`, makes `self` a copy of `from`;
 * otherwise makes `self` a null proxy. Returns the status of the call to the object. */
Ice_Status Ice_ObjectPrx_checkedCast(Ice_ObjectPrxPtr self, const Ice_ObjectPrx* from,
                                     const char* id);
/* Opens the connection that later calls will use, and sets `connection` to its number. */
Ice_Status Ice_ObjectPrx_ice_getConnection(Ice_ObjectPrxPtr self, int* connection);
/* Gives an indirect proxy ("object", "object@adapter") the endpoints that a locator returns.
 * `locator` is a proxy to an Ice::Locator, such as the locator of IceGrid. A direct proxy remains
 * unchanged. The proxy keeps the endpoints; to resolve again, call this function with a new copy of
 * the indirect proxy. Returns ICE_NO_ENDPOINT if the locator does not know the object. */
Ice_Status Ice_ObjectPrx_resolve(Ice_ObjectPrxPtr self, Ice_ObjectPrxPtr locator);
/* Describes why the last call through this proxy failed; to be called before the next call through
 * this proxy. The text from the peer is valid as long as the results of the call are; afterwards,
 * the text is empty. */
void Ice_ObjectPrx_failure(const Ice_ObjectPrx* self, Ice_Failure* failure);

/* Functions for a call, in the order in which generated code uses them: begin, writes to the
 * returned stream, invoke, reads, end. begin returns 0, with the reason in self->status, if all
 * ICE_CALLS slots are in use, or if `mode` has ICE_RESULTS and the proxy is oneway or batch. No
 * other call may be made between begin and invoke. */
#define ICE_RESULTS 0x80 /* in `mode`: the operation has results or exceptions */
Ice_OutputStreamPtr Ice_ObjectPrx_begin(Ice_ObjectPrxPtr self, const char* operation,
                                        Ice_Byte mode);
Ice_Status Ice_ObjectPrx_invoke(Ice_ObjectPrxPtr self, Ice_InputStreamPtr* is);
Ice_Status Ice_ObjectPrx_end(Ice_ObjectPrxPtr self, Ice_Status status);
/* Makes an asynchronous call; replaces invoke and end. If this function returns ICE_OK, the task
 * that receives the reply calls `callback` once; otherwise no task calls it. The stream `is` is
 * valid during the callback. */
typedef void (*Ice_Callback)(void* cookie, Ice_Status status, Ice_InputStreamPtr is);
Ice_Status Ice_ObjectPrx_invokeAsync(Ice_ObjectPrxPtr self, Ice_Callback callback, void* cookie);

/* Write and read a proxy. A pointer of 0 is written as the null proxy; the null proxy is read as a
 * proxy with an empty name. If `ic` is 0, the proxy that is read gets the communicator of the
 * stream. */
void Ice_OutputStream_writePrx(Ice_OutputStreamPtr os, const Ice_ObjectPrx* prx);
void Ice_InputStream_readPrx(Ice_InputStreamPtr is, Ice_CommunicatorPtr ic, Ice_ObjectPrxPtr prx);

/* ---- communicator ---- */

void Ice_initialize(Ice_CommunicatorPtr ic);
/* Set the port to the operating system, and a transport. Call both functions before any other
 * function; the objects that are passed must stay valid. Each call of the second function adds a
 * transport. When there are ICE_TRANSPORTS transports, a further call replaces the last one. A call
 * uses the transport of its proxy's endpoints. */
void Ice_Communicator_setOs(Ice_CommunicatorPtr ic, const Ice_Os* os, void* context);
void Ice_Communicator_setEndpoint(Ice_CommunicatorPtr ic, const Ice_Endpoint* endpoint,
                                  void* context);

/* Releases the results of the last call of a task, and its slot among the ICE_CALLS slots. `task`
 * is a number returned by the function `task` of Ice_Os. The kernel calls this function when a task
 * ends; a task that continues may call it when it no longer needs the results. Must not be called
 * during a call. The function acquires the state lock; a kernel hook that must not wait has to let
 * another task call it. Full run time. */
void Ice_Communicator_endTask(Ice_CommunicatorPtr ic, int task);

/* Sets the properties: an array of strings "key=value" that ends with 0. If a key occurs twice, its
 * first entry is used. */
void Ice_Communicator_setProperties(Ice_CommunicatorPtr ic, const char* const* table);
/* Returns the property's value; 0 if it is not set. */
const char* Ice_Communicator_getProperty(Ice_CommunicatorPtr ic, const char* key);
/* Returns the property's value as a number; `otherwise` if the property is not set or is not a
 * number. */
Ice_Int Ice_Communicator_getPropertyAsInt(Ice_CommunicatorPtr ic, const char* key,
                                          Ice_Int otherwise);
Ice_Status Ice_Communicator_propertyToProxy(Ice_CommunicatorPtr ic, const char* key,
                                            Ice_ObjectPrxPtr prx);

/* Makes an adapter, which is inactive at first. `endpoints` names the transport and its options,
 * such as "xbee-at" or "tcp -p 10000"; several endpoints are separated by colons. Returns
 * ICE_NO_ENDPOINT if no transport has this name, or if the system refuses the address. */
Ice_Status Ice_Communicator_createObjectAdapterWithEndpoints(Ice_CommunicatorPtr ic,
                                                             const char* name,
                                                             const char* endpoints,
                                                             Ice_ObjectAdapterPtr adapter);
/* Makes an adapter with the endpoints in the property <name>.Endpoints. Without this property, the
 * adapter has no endpoints. Its objects can then be called only by peers to which this side has
 * connected. */
Ice_Status Ice_Communicator_createObjectAdapter(Ice_CommunicatorPtr ic, const char* name,
                                                Ice_ObjectAdapterPtr adapter);
/* Receives and dispatches requests until Ice_Communicator_shutdown is called. Several tasks may
 * call this function; only one of them receives at a time. */
void Ice_Communicator_waitForShutdown(Ice_CommunicatorPtr ic);
/* Stops serving: accepts no more connections and executes no more requests. Callers notice this
 * because their connections are closed. Calls of this side continue. */
void Ice_Communicator_shutdown(Ice_CommunicatorPtr ic);
/* Handles at most one event; for programs with a main loop. Returns ICE_TIMEOUT if no event
 * arrived, or if another task was receiving all the time. */
Ice_Status Ice_Communicator_poll(Ice_CommunicatorPtr ic, Ice_Int timeoutMs);
/* Shuts down, and closes every connection gracefully: waits up to timeoutMs until operations in
 * progress have been answered and the peers have closed their connections. */
void Ice_Communicator_destroy(Ice_CommunicatorPtr ic, Ice_Int timeoutMs);

/* Makes a proxy to an object of the peer on this connection; either side may have made the
 * connection. Calls through the proxy use this connection only. When the connection ends, calls
 * fail with ICE_CONNECTION_LOST. The proxy cannot be passed to others. `identity` is
 * "category/name", or an identity from Ice_ObjectPrx_getIdentity. */
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
