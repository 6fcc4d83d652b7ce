/* SPDX-License-Identifier: MIT
 *
 * ice_invoke: makes calls through proxies: connects, sends the request, waits for the reply.
 */
#include "ice_private.h"

#include <string.h>

/* Records for Ice_ObjectPrx_failure which limit was reached, or which other failure occurred.
 * `bound` is the field of the stream. */
static Ice_Status fail(Ice_ObjectPrxPtr self, Ice_Status status, int why, const char* bound) {
    self->reason = Ice_Failed_text((Ice_Byte)why, bound);
    return status;
}

static int isValidating(Ice_CommunicatorPtr ic, int connection) {
    return icec_connectionState(ic, connection) == ICE_CONNECTION_VALIDATING;
}

/* Connects to one endpoint with the transport that supports it, or uses the existing connection. */
static Ice_Status open(Ice_ObjectPrxPtr self, const Ice_Byte* endpoint, Ice_Int size) {
    Ice_CommunicatorPtr ic = self->communicator;
    Ice_Status status = ICE_NO_ENDPOINT;
    int t;
    icec_lock(ic, ICE_LOCK_STATE);
    for (t = 0; t < ICEC_TRANSPORTS(ic) && status == ICE_NO_ENDPOINT; ++t) {
        status = ic->transports[t].endpoint->connect(ic->transports[t].context, endpoint, size,
                                                     &self->connection);
        if (status == ICE_OK)
            self->connection += t * ICE_CONNECTIONS;
    }
    if (status == ICE_OK && ic->connections[self->connection].state == ICE_CONNECTION_NONE)
        icec_openConnection(ic, self->connection, ICE_CONNECTION_VALIDATING);
    icec_unlock(ic, ICE_LOCK_STATE);
    return status;
}

/* Tries the endpoints of the proxy in turn, and waits for the first message of the peer. */
static Ice_Status connect(Ice_ObjectPrxPtr self) {
    Ice_CommunicatorPtr ic = self->communicator;
    Ice_Status status = ICE_NO_ENDPOINT;
    Ice_ConnectionState state;
    Ice_InputStream is;
    int n;
    if (self->mode >= ICE_DATAGRAM)
        return ICE_NO_ENDPOINT;
    if (self->versions[0] != 1 || self->versions[2] != 1)
        return ICE_PROTOCOL; /* the proxy's versions of protocol and encoding are not supported */
    if (self->generation)    /* a fixed proxy can only use its own connection */
        return icec_countPending(ic, self->connection, self->generation, 0) ? ICE_OK
                                                                            : ICE_CONNECTION_LOST;
    Ice_InputStream_init(&is, self->endpoints + 1, self->endpointsSize - 1);
    for (n = self->endpoints[0]; n > 0 && status != ICE_OK; --n) {
        Ice_Int begin = is.position;
        (void)Ice_InputStream_readShort(&is);
        (void)Ice_InputStream_readBlob(&is, Ice_InputStream_readInt(&is) - 4);
        status = open(self, is.data + begin, is.position - begin);
    }
    if (status != ICE_OK)
        return status == ICE_LIMIT ? fail(self, status, ICE_FAILED_CONNECTIONS, 0) : status;
    status = icec_await(ic, isValidating, self->connection, self->call, self->timeoutMs);
    state = icec_connectionState(ic, self->connection);
    if (state == ICE_CONNECTION_VALIDATING)
        return status == ICE_LIMIT ? fail(self, status, ICE_FAILED_NESTING, 0) : status;
    return state == ICE_CONNECTION_OPEN ? ICE_OK : ICE_CONNECTION_LOST;
}

Ice_Status Ice_ObjectPrx_ice_getConnection(Ice_ObjectPrxPtr self, int* connection) {
    /* begins a call, because only a call has a slot in which this task can wait */
    Ice_OutputStreamPtr os = Ice_ObjectPrx_begin(self, "", 0);
    if (!os)
        return (Ice_Status)self->status;
    icec_unlock(self->communicator, ICE_LOCK_SEND);
    *connection = self->connection;
    return Ice_ObjectPrx_end(self, (Ice_Status)self->status);
}

static void writeContext(Ice_OutputStreamPtr os, const Ice_ContextEntry* context) {
    Ice_Int n = 0;
    while (context && context[n].key)
        ++n;
    Ice_OutputStream_writeSize(os, n);
    for (; n > 0; --n, ++context) {
        Ice_OutputStream_writeText(os, context->key);
        Ice_OutputStream_writeText(os, context->value);
    }
}

/* Writes a request up to its parameters. In a batch, a request has neither header nor id. */
static void beginRequest(Ice_ObjectPrxPtr self, const char* operation, Ice_Byte mode) {
    Ice_CommunicatorPtr ic = self->communicator;
    Ice_OutputStreamPtr os = &ic->request;
    Ice_OutputStream_init(os, ic->requestData, ICE_REQUEST_MAX);
    if (!self->batch) {
        if (self->mode == ICE_TWOWAY) {
            /* keeps ids above 0, because 0 marks a one-way request */
            ic->lastId = (ic->lastId & 0x3FFFFFFF) + 1;
            self->id = ic->lastId;
        }
        icec_beginMessage(os, ICEC_REQUEST);
        Ice_OutputStream_writeInt(os, self->id);
    }
    os->minor = self->minor;
    Ice_OutputStream_writeBlob(os, self->identity, self->identitySize);
    Ice_OutputStream_writeText(os, operation);
    Ice_OutputStream_writeByte(os, mode & (Ice_Byte)~ICE_RESULTS);
    writeContext(os, self->context);
    ic->requestBody = icec_beginEncapsulation(os);
}

Ice_OutputStreamPtr Ice_ObjectPrx_begin(Ice_ObjectPrxPtr self, const char* operation,
                                        Ice_Byte mode) {
    Ice_CommunicatorPtr ic = self->communicator;
    self->operation = operation;
    self->reason = 0;
    self->id = 0;
    self->status = ICE_TWOWAY_ONLY;
    if (self->mode != ICE_TWOWAY && mode & ICE_RESULTS)
        return 0;
    self->call = icec_takeCall(ic);
    if (self->call < 0) {
        self->status = (Ice_Byte)fail(self, ICE_LIMIT, ICE_FAILED_CALLS, 0);
        return 0;
    }
    self->status = self->batch ? ICE_OK : (Ice_Byte)connect(self);
    icec_lock(ic, ICE_LOCK_SEND);
    beginRequest(self, operation, mode);
    return &ic->request;
}

/* Enters the call into the table, before its reply can arrive. */
static void registerCall(Ice_ObjectPrxPtr self, Ice_Callback callback, void* cookie) {
    Ice_CommunicatorPtr ic = self->communicator;
    Ice_Call* call = &ic->calls[self->call];
    icec_lock(ic, ICE_LOCK_STATE);
    call->id = self->id;
    call->connection = self->connection;
    call->callback = callback;
    call->cookie = cookie;
    call->timeoutMs = self->timeoutMs;
    call->begunMs = icec_nowMs(ic);
    call->reply = self->reply ? self->reply : call->replyData;
    call->replySize = self->reply ? self->replySize : (Ice_Int)sizeof call->replyData;
    if (self->mode == ICE_TWOWAY)
        call->state = ICE_CALL_WAITING;
    /* an asynchronous call stores its status in the slot, because the proxy may no longer exist
     * when the call ends */
    self->status = ICE_LATER;
    icec_unlock(ic, ICE_LOCK_STATE);
}

static Ice_Status sendRequest(Ice_ObjectPrxPtr self, Ice_Callback callback, void* cookie) {
    Ice_OutputStreamPtr os = &self->communicator->request;
    icec_endEncapsulation(os, self->communicator->requestBody);
    if (self->batch)
        return self->batch->keep(self);
    icec_endMessage(os);
    if (self->status != ICE_OK)
        return (Ice_Status)self->status;
    if (os->failed)
        return fail(self, ICE_MARSHAL,
                    os->failed == ICE_FAILED_RESULT ? ICE_FAILED_REQUEST : os->failed, os->bound);
    registerCall(self, callback, cookie);
    return icec_send(self->communicator, self->connection, os);
}

/* Sends the request, and releases the request buffer. */
static Ice_Status sendAndUnlock(Ice_ObjectPrxPtr self, Ice_Callback callback, void* cookie) {
    Ice_Status status = sendRequest(self, callback, cookie);
    icec_unlock(self->communicator, ICE_LOCK_SEND);
    return status;
}

static int isWaiting(Ice_CommunicatorPtr ic, int slot) {
    return icec_callState(ic, slot) == ICE_CALL_WAITING;
}

Ice_Status Ice_ObjectPrx_invoke(Ice_ObjectPrxPtr self, Ice_InputStreamPtr* is) {
    Ice_CommunicatorPtr ic = self->communicator;
    Ice_Call* call = &ic->calls[self->call];
    Ice_Status status = sendAndUnlock(self, 0, 0);
    if (status != ICE_OK || self->mode != ICE_TWOWAY)
        return status;
    status = icec_await(ic, isWaiting, self->call, self->call, self->timeoutMs);
    if (status == ICE_OK || icec_callState(ic, self->call) == ICE_CALL_DONE)
        status = call->status;
    else if (status == ICE_LIMIT)
        status = fail(self, status, ICE_FAILED_NESTING, 0);
    *is = &call->is;
    return status;
}

/* Withdraws an asynchronous call that could not be sent. Returns 0 if the call has already ended:
 * another task noticed first that the connection was lost, and made the callback. */
static int withdraw(Ice_ObjectPrxPtr self) {
    Ice_CommunicatorPtr ic = self->communicator;
    Ice_Call* call = &ic->calls[self->call];
    int isOwn;
    icec_lock(ic, ICE_LOCK_STATE);
    /* before the call is in the table, its slot belongs to this task */
    isOwn = self->status != ICE_LATER || (call->state == ICE_CALL_WAITING && call->id == self->id);
    if (isOwn)
        call->state = ICE_CALL_BUILDING;
    icec_unlock(ic, ICE_LOCK_STATE);
    return isOwn;
}

Ice_Status Ice_ObjectPrx_invokeAsync(Ice_ObjectPrxPtr self, Ice_Callback callback, void* cookie) {
    Ice_CommunicatorPtr ic = self->communicator;
    int slot = self->call;
    Ice_Status status = sendAndUnlock(self, callback, cookie);
    if (self->mode != ICE_TWOWAY || (status != ICE_OK && withdraw(self)))
        return Ice_ObjectPrx_end(self, status);
    /* Wakes the receiving task, which then waits at most until the time-out of this call. */
    if (isWaiting(ic, slot))
        icec_wake(ic);
    return ICE_OK;
}

/* Largest body of a reply with results that need not be kept, because no pointer refers into it:
 * status, encapsulation, and a result of one byte. */
#define NOTHING_KEPT 8

Ice_Status Ice_ObjectPrx_end(Ice_ObjectPrxPtr self, Ice_Status status) {
    Ice_CommunicatorPtr ic = self->communicator;
    Ice_Call* call = &ic->calls[self->call];
    Ice_CallState left = ICE_CALL_FREE;
    icec_lock(ic, ICE_LOCK_STATE);
    if (call->state == ICE_CALL_DONE) {
        if (status <= ICE_USER_EXCEPTION && call->is.failed)
            status = fail(self, ICE_MARSHAL, call->is.failed, call->is.bound);
        if (!self->reply && call->is.size > NOTHING_KEPT)
            left = ICE_CALL_KEPT;
    }
    call->state = left;
    icec_unlock(ic, ICE_LOCK_STATE);
    self->status = (Ice_Byte)status;
    return status;
}

void Ice_ObjectPrx_failure(const Ice_ObjectPrx* self, Ice_Failure* failure) {
    Ice_Status status = (Ice_Status)self->status;
    memset(failure, 0, sizeof *failure);
    if (self->reason)
        failure->unknown = Ice_String_from(self->reason);
    else if (self->id != 0) {
        const Ice_Call* call = &self->communicator->calls[self->call];
        icec_lock(self->communicator, ICE_LOCK_STATE);
        if (call->id == self->id) { /* the slot still holds the reply to this call */
            failure->unknown = call->unknown;
            if (status == ICE_LATER)
                status = call->status;
        }
        icec_unlock(self->communicator, ICE_LOCK_STATE);
    }
    if (status >= ICE_OBJECT_NOT_EXIST && status <= ICE_OPERATION_NOT_EXIST) {
        failure->identity = Ice_ObjectPrx_getIdentity(self);
        failure->facet = Ice_ObjectPrx_getFacet(self);
        failure->operation = Ice_String_from(self->operation);
    }
}
