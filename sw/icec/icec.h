/* SPDX-License-Identifier: MIT
 *
 * icec: a small peer of ZeroC Ice 3.7 in C90: communicator, object adapter, servants, proxies.
 *
 * No allocation: the caller owns every object named here, and keeps it while it is in use. So are
 * strings that are passed as `const char *`. Limits and options: ice_config.h. With ICEC_TASKS and
 * an Ice_Os, every function may be called by any task; a proxy object belongs to one task at a time
 * (copies are plain assignments). Names follow the paper's figures; the mapping is docs/icec.md.
 */
#ifndef ICEC_H
#define ICEC_H

#include "ice_seam.h"

typedef struct Ice_Communicator Ice_Communicator, *Ice_CommunicatorPtr;
typedef struct Ice_ObjectAdapter Ice_ObjectAdapter, *Ice_ObjectAdapterPtr;
typedef struct Ice_Object Ice_Object, *Ice_ObjectPtr;
typedef struct Ice_ObjectPrx Ice_ObjectPrx, *Ice_ObjectPrxPtr;

typedef struct Ice_Identity {
    Ice_String name, category;
} Ice_Identity;

typedef struct Ice_ContextEntry {
    const char *key, *value;
} Ice_ContextEntry; /* in an array; a key of 0 ends it */

/* ---- servants ---- */

/* The call being dispatched. Its strings are valid during the dispatch. */
typedef struct Ice_Current {
    Ice_CommunicatorPtr communicator;
    Ice_ObjectAdapterPtr adapter;
    Ice_String name, category, facet, operation;
    Ice_Byte mode;  /* 0 normal, 1 nonmutating, 2 idempotent */
    Ice_Byte minor; /* encoding 1.minor */
    int connection;
    Ice_Int requestId;       /* 0: oneway */
    Ice_InputStream context; /* use Ice_Current_context */
} Ice_Current;

/* Reads the parameters from `is`, runs the operation, writes the results to `os` (after the
 * servant's function has returned: until then `os` has no place of its own).
 * ICE_OPERATION_NOT_EXIST where there is no such operation. */
typedef Ice_Status (*Ice_Dispatch)(Ice_ObjectPtr self, const Ice_Current* current,
                                   Ice_InputStreamPtr is, Ice_OutputStreamPtr os);

struct Ice_Object {
    Ice_Dispatch dispatch;
    const char* const* ids; /* type ids in alphabetical order, "::Ice::Object" among them; 0 ends */
    const char* id;         /* the most derived one */
};

/* 1: the caller's context has the key, and `value` is set. */
Ice_Bool Ice_Current_context(const Ice_Current* current, const char* key, Ice_String* value);

/* The right to answer a call later; the servant's function returned ICE_LATER. */
typedef struct Ice_Reply {
    Ice_CommunicatorPtr communicator;
    Ice_Int id;
    int connection;
    U16 generation;
    Ice_Byte minor;
} Ice_Reply;

void Ice_Current_later(const Ice_Current* current, Ice_Reply* reply);
/* The stream for the results (or a user exception); to be followed by end. */
Ice_OutputStreamPtr Ice_Reply_begin(Ice_Reply* reply);
/* Sends: ICE_OK and ICE_USER_EXCEPTION with what was written, any other status as the failure it
 * is. ICE_CONNECTION_LOST: who asked is gone. */
Ice_Status Ice_Reply_end(Ice_Reply* reply, Ice_Status status);

/* ---- object adapters ---- */

/* `identity`: "name" or "category/name". ICE_LIMIT: it is taken, or there is no room. */
Ice_Status Ice_ObjectAdapter_add(Ice_ObjectAdapterPtr adapter, Ice_ObjectPtr servant,
                                 const char* identity);
Ice_Status Ice_ObjectAdapter_addFacet(Ice_ObjectAdapterPtr adapter, Ice_ObjectPtr servant,
                                      const char* identity, const char* facet);
/* Answers for every identity of the category that has no servant; "" for every category. */
Ice_Status Ice_ObjectAdapter_addDefaultServant(Ice_ObjectAdapterPtr adapter, Ice_ObjectPtr servant,
                                               const char* category);
Ice_Status Ice_ObjectAdapter_remove(Ice_ObjectAdapterPtr adapter, const char* identity);
Ice_Status Ice_ObjectAdapter_removeFacet(Ice_ObjectAdapterPtr adapter, const char* identity,
                                         const char* facet);
Ice_Status Ice_ObjectAdapter_removeDefaultServant(Ice_ObjectAdapterPtr adapter,
                                                  const char* category);
Ice_ObjectPtr Ice_ObjectAdapter_find(Ice_ObjectAdapterPtr adapter, const char* identity);
void Ice_ObjectAdapter_activate(Ice_ObjectAdapterPtr adapter);
/* Its objects do not exist until it is activated again. */
void Ice_ObjectAdapter_deactivate(Ice_ObjectAdapterPtr adapter);
void Ice_ObjectAdapter_destroy(Ice_ObjectAdapterPtr adapter);
/* A proxy to an object of this adapter, to be passed to a peer. */
Ice_Status Ice_ObjectAdapter_createProxy(Ice_ObjectAdapterPtr adapter, const char* identity,
                                         Ice_ObjectPrxPtr prx);

/* ---- proxies ---- */

enum { ICE_TWOWAY, ICE_ONEWAY, ICE_BATCH_ONEWAY, ICE_DATAGRAM, ICE_BATCH_DATAGRAM };

/* One-way requests that wait to be sent together. `data` is the caller's. */
typedef struct Ice_Batch {
    Ice_OutputStream os;
    Ice_Int count;
    Ice_Status (*keep)(Ice_ObjectPrxPtr prx); /* the run time's */
} Ice_Batch;

/* Members that code uses first: their offsets are short. */
struct Ice_ObjectPrx {
    Ice_CommunicatorPtr communicator;
    int call;          /* the slot of the last call, -1 none */
    int connection;    /* of the last call; a fixed proxy's only one */
    Ice_Int timeoutMs; /* for connecting and for a reply; 10 s unless set */
    Ice_Byte mode, secure;
    Ice_Byte minor;  /* encoding of requests, 1.minor */
    Ice_Byte status; /* Ice_Status of the call being built */
    Ice_Byte identitySize, endpointsSize;
    U16 generation; /* of a fixed proxy's connection; 0: not fixed */
    const Ice_ContextEntry* context;
    Ice_Batch* batch;
    U32* reply; /* 0: ICE_REPLY_MAX bytes of the communicator's */
    Ice_Int replySize;
    Ice_Byte identity[ICE_IDENTITY_MAX];  /* as on the wire: name, category, facet */
    Ice_Byte endpoints[ICE_ENDPOINT_MAX]; /* as on the wire: count, endpoints; or 0, adapter's id */
};

/* What a failed call's reply said: of ICE_OBJECT_NOT_EXIST and its like who and what, else the
 * text. */
typedef struct Ice_Failure {
    Ice_Identity identity;
    Ice_String facet, operation;
    Ice_String unknown;
} Ice_Failure;

/* `proxy`: "identity [-t|-o|-O|-d|-D|-s] [-f facet] [-e 1.0|1.1]:transport options[:...]" or
 * "...@adapter", as in Ice's manual. The minimal configuration takes "name [-t|-o]:transport
 * options". */
Ice_Status Ice_Communicator_stringToProxy(Ice_CommunicatorPtr ic, const char* proxy,
                                          Ice_ObjectPrxPtr prx);
/* Writes a terminated string of at most `size` bytes with the end mark. ICE_LIMIT: it does not fit.
 */
Ice_Status Ice_Communicator_proxyToString(const Ice_ObjectPrx* prx, char* text, Ice_Int size);
int Ice_ObjectPrx_isNull(const Ice_ObjectPrx* prx);
int Ice_ObjectPrx_equals(const Ice_ObjectPrx* a, const Ice_ObjectPrx* b);
Ice_Identity Ice_ObjectPrx_getIdentity(const Ice_ObjectPrx* prx);
Ice_String Ice_ObjectPrx_getFacet(const Ice_ObjectPrx* prx);

/* Changes of a copy: `Ice_ObjectPrx other = *prx; Ice_ObjectPrx_ice_facet(&other, "f");` */
Ice_Status Ice_ObjectPrx_ice_identity(Ice_ObjectPrxPtr prx, const char* identity);
Ice_Status Ice_ObjectPrx_ice_facet(Ice_ObjectPrxPtr prx, const char* facet);
void Ice_ObjectPrx_ice_twoway(Ice_ObjectPrxPtr prx);
void Ice_ObjectPrx_ice_oneway(Ice_ObjectPrxPtr prx);
/* Calls are kept in `data` until flushed, or until it is full. */
void Ice_ObjectPrx_ice_batchOneway(Ice_ObjectPrxPtr prx, Ice_Batch* batch, Ice_Byte* data,
                                   Ice_Int size);
Ice_Status Ice_ObjectPrx_ice_flushBatchRequests(Ice_ObjectPrxPtr prx);
void Ice_ObjectPrx_ice_context(Ice_ObjectPrxPtr prx, const Ice_ContextEntry* context); /* 0: none */
void Ice_ObjectPrx_ice_invocationTimeout(Ice_ObjectPrxPtr prx, Ice_Int ms);
/* Room for larger replies, aligned to 8: `bytes` for the reply and its decoded sequences together.
 */
void Ice_ObjectPrx_setReplyBuffer(Ice_ObjectPrxPtr prx, U32* buffer, Ice_Int bytes);
void Ice_ObjectPrx_ice_encodingVersion(Ice_ObjectPrxPtr prx, Ice_Byte minor);

Ice_Status Ice_ObjectPrx_ice_ping(Ice_ObjectPrxPtr self);
Ice_Status Ice_ObjectPrx_ice_isA(Ice_ObjectPrxPtr self, const char* id, Ice_Bool* result);
Ice_Status Ice_ObjectPrx_ice_id(Ice_ObjectPrxPtr self, Ice_String* result);
/* `self` becomes `from` if the object has the type, else null; the status says whether it could be
 * asked. */
Ice_Status Ice_ObjectPrx_checkedCast(Ice_ObjectPrxPtr self, const Ice_ObjectPrx* from,
                                     const char* id);
/* Opens the connection that a call would use. */
Ice_Status Ice_ObjectPrx_ice_getConnection(Ice_ObjectPrxPtr self, int* connection);
/* Of the last call that was made through this object; until its next call. */
void Ice_ObjectPrx_failure(const Ice_ObjectPrx* self, Ice_Failure* failure);

/* For generated code. A call is begin, writes to the returned stream, invoke, reads, end. begin
 * returns 0, with the reason in self->status, where all calls are taken, and where the mode says
 * that there are results and the proxy is none for them. Between begin and invoke no other call is
 * made. */
#define ICE_RESULTS 0x80 /* in `mode`: the operation has results or exceptions */
Ice_OutputStreamPtr Ice_ObjectPrx_begin(Ice_ObjectPrxPtr self, const char* operation,
                                        Ice_Byte mode);
Ice_Status Ice_ObjectPrx_invoke(Ice_ObjectPrxPtr self, Ice_InputStreamPtr* is);
Ice_Status Ice_ObjectPrx_end(Ice_ObjectPrxPtr self, Ice_Status status);
/* Instead of invoke and end: `callback` gets the reply, from the task that receives, unless this
 * returns another status than ICE_OK. What `is` holds is valid during the callback. */
typedef void (*Ice_Callback)(void* cookie, Ice_Status status, Ice_InputStreamPtr is);
Ice_Status Ice_ObjectPrx_invokeAsync(Ice_ObjectPrxPtr self, Ice_Callback callback, void* cookie);

/* A null proxy is written for 0, and read as one of an empty name. `ic` 0: the stream's. */
void Ice_OutputStream_writePrx(Ice_OutputStreamPtr os, const Ice_ObjectPrx* prx);
void Ice_InputStream_readPrx(Ice_InputStreamPtr is, Ice_CommunicatorPtr ic, Ice_ObjectPrxPtr prx);

/* ---- communicator ---- */

void Ice_initialize(Ice_CommunicatorPtr ic);
/* Before any other call; `os` must stay valid. */
void Ice_Communicator_setOs(Ice_CommunicatorPtr ic, const Ice_Os* os, void* context);
void Ice_Communicator_setEndpoint(Ice_CommunicatorPtr ic, const Ice_Endpoint* endpoint,
                                  void* context);

/* `table`: strings "key=value", 0 ends. Of two with one key the first counts. */
void Ice_Communicator_setProperties(Ice_CommunicatorPtr ic, const char* const* table);
const char* Ice_Communicator_getProperty(Ice_CommunicatorPtr ic,
                                         const char* key); /* 0: not there */
Ice_Int Ice_Communicator_getPropertyAsInt(Ice_CommunicatorPtr ic, const char* key,
                                          Ice_Int otherwise);
Ice_Status Ice_Communicator_propertyToProxy(Ice_CommunicatorPtr ic, const char* key,
                                            Ice_ObjectPrxPtr prx);

/* `endpoints`: name of the transport and its options, "xbee-at" or "tcp -p 10000". */
Ice_Status Ice_Communicator_createObjectAdapterWithEndpoints(Ice_CommunicatorPtr ic,
                                                             const char* name,
                                                             const char* endpoints,
                                                             Ice_ObjectAdapterPtr adapter);
/* With the property <name>.Endpoints; without it only connections that this side makes reach it. */
Ice_Status Ice_Communicator_createObjectAdapter(Ice_CommunicatorPtr ic, const char* name,
                                                Ice_ObjectAdapterPtr adapter);
/* Receives and dispatches until Ice_Communicator_shutdown. Of several tasks one receives. */
void Ice_Communicator_waitForShutdown(Ice_CommunicatorPtr ic);
void Ice_Communicator_shutdown(Ice_CommunicatorPtr ic);
/* Handles at most one event; for programs with a loop of their own. ICE_TIMEOUT: there was none,
 * or another task received all the time. */
Ice_Status Ice_Communicator_poll(Ice_CommunicatorPtr ic, Ice_Int timeoutMs);
/* Closes every connection in good order: tells the peers, and waits up to timeoutMs for them. */
void Ice_Communicator_destroy(Ice_CommunicatorPtr ic, Ice_Int timeoutMs);

/* A proxy to an object of the peer on this connection, whoever made it: calls go back on it. It
 * ends with the connection (ICE_CONNECTION_LOST), and cannot be passed to anybody. */
Ice_Status Ice_Connection_createProxy(Ice_CommunicatorPtr ic, int connection, const char* identity,
                                      Ice_ObjectPrxPtr prx);
/* Closes one connection in good order, without waiting for the peer. */
void Ice_Connection_close(Ice_CommunicatorPtr ic, int connection);

#ifdef ICEC_MINIMAL
#include "minimal/ice_minimal.h"
#else
#include "ice_objects.h"
#endif

#endif
