/* SPDX-License-Identifier: MIT
 *
 * ice_call: calls made through proxies: request, wait, reply.
 */
#include "ice_private.h"

#include <string.h>

void Ice_wakeCalls(Ice_CommunicatorPtr ic) {
    int c;
    for (c = 0; ICEC_TASKS && c < ICE_CALLS; ++c)
        if (ic->calls[c].state != ICE_FREE)
            ic->os->wake(ic->osContext, c);
}

/* Ends the call `id` if it still waits: tells the waiting task, or calls back. */
static void finish(Ice_CommunicatorPtr ic, Ice_Call* call, Ice_Int id, Ice_Status status,
                   Ice_InputStreamPtr is) {
    Ice_Callback callback = 0;
    void* cookie = 0;
    Ice_lock(ic, ICE_LOCK_STATE);
    if (!ICEC_TASKS || (call->state == ICE_WAITING && call->id == id)) {
        if (ICEC_ASYNC)
            callback = call->callback, cookie = call->cookie;
        call->status = status;
        call->state = callback ? ICE_FREE : ICE_DONE; /* the callback may make the next call */
        if (ICEC_TASKS && !callback)
            ic->os->wake(ic->osContext, (int)(call - ic->calls));
    }
    Ice_unlock(ic, ICE_LOCK_STATE);
    if (callback)
        callback(cookie, status, is);
}

void Ice_failCalls(Ice_CommunicatorPtr ic, int connection, Ice_Status status) {
    Ice_InputStream none;
    int c;
    if (ICEC_ASYNC)
        Ice_InputStream_init(&none, Ice_head, 0);
    for (c = 0; c < ICE_CALLS; ++c) {
        Ice_Call* call = &ic->calls[c];
        Ice_Int id = 0;
        int counts;
        Ice_lock(ic, ICE_LOCK_STATE);
        counts = call->state == ICE_WAITING && call->connection == connection;
        if (ICEC_TASKS && counts)
            id = call->id;
        else if (ICEC_TASKS && call->state != ICE_FREE)
            ic->os->wake(ic->osContext, c); /* it may wait for the connection */
        Ice_unlock(ic, ICE_LOCK_STATE);
        if (counts)
            finish(ic, call, id, status, &none);
    }
}

Ice_Int Ice_expireCalls(Ice_CommunicatorPtr ic, Ice_Int waitMs) {
    Ice_InputStream none;
    int c;
    Ice_InputStream_init(&none, Ice_head, 0);
    for (c = 0; c < ICE_CALLS; ++c) {
        Ice_Call* call = &ic->calls[c];
        Ice_Int left = 1, id = 0;
        int counts;
        Ice_lock(ic, ICE_LOCK_STATE);
        counts = call->state == ICE_WAITING && call->callback;
        if (counts) {
            id = call->id;
            left = call->timeoutMs - (Ice_Int)(Ice_nowMs(ic) - call->begunMs);
        }
        Ice_unlock(ic, ICE_LOCK_STATE);
        if (left <= 0)
            finish(ic, call, id, ICE_TIMEOUT, &none);
        else if (counts && left < waitMs)
            waitMs = left;
    }
    return waitMs;
}

/* From a reply's status byte on. */
static Ice_Status readReply(Ice_InputStreamPtr is, Ice_Failure* failure) {
    Ice_Byte code = Ice_InputStream_readByte(is);
    Ice_Status entered;
    if (is->failed || code > ICE_UNKNOWN_EXCEPTION)
        return ICE_MARSHAL;
    if (code <= ICE_USER_EXCEPTION) {
        entered = Ice_enterEncapsulation(is);
        return entered != ICE_OK ? entered : (Ice_Status)code;
    }
    if (ICEC_DETAILS && code <= ICE_OPERATION_NOT_EXIST) {
        failure->identity.name = Ice_InputStream_readString(is);
        failure->identity.category = Ice_InputStream_readString(is);
        Ice_readFacet(is, &failure->facet);
        failure->operation = Ice_InputStream_readString(is);
    } else if (ICEC_DETAILS) {
        failure->unknown = Ice_InputStream_readString(is);
    }
    return (Ice_Status)code;
}

/* Copies what is left of the message, for the task that waits. */
static void keepReply(Ice_Call* call, Ice_InputStreamPtr is) {
    Ice_Int size = is->size - is->position;
    if (size > call->replySize) {
        is->failed = 1;
        return;
    }
    memcpy(call->reply, is->data + is->position, (size_t)size);
    Ice_InputStream_init(is, (const Ice_Byte*)call->reply, size);
    size = (size + 7) / 8 * 2; /* in words: the arena begins at a multiple of 8 */
    is->arena = call->reply + size;
    is->arenaSize = call->replySize / 4 - size;
}

static Ice_Call* waitingCall(Ice_CommunicatorPtr ic, int connection, Ice_Int id) {
    Ice_Call* call;
    for (call = ic->calls; call < ic->calls + ICE_CALLS; ++call)
        if (call->state == ICE_WAITING && call->id == id && call->connection == connection)
            return call;
    return 0; /* it timed out, or there never was one */
}

void Ice_takeReply(Ice_CommunicatorPtr ic, int connection, Ice_InputStreamPtr is) {
    Ice_Int id = Ice_InputStream_readInt(is);
    Ice_Call* call;
    Ice_Status status;
    Ice_giveArena(ic, is);
    Ice_lock(ic, ICE_LOCK_STATE); /* so that it does not time out meanwhile */
    call = waitingCall(ic, connection, id);
    if (call && ICEC_ASYNC && call->callback) {
        Ice_unlock(ic, ICE_LOCK_STATE);
        status = readReply(is, &call->failure);
        finish(ic, call, id, status, is);
        return;
    }
    if (call) {
        if (ICEC_COPY_REPLIES)
            keepReply(call, is);
        is->communicator = ic;
        call->status = readReply(is, &call->failure);
        call->is = *is;
        call->state = ICE_DONE;
        if (ICEC_TASKS)
            ic->os->wake(ic->osContext, (int)(call - ic->calls));
    }
    Ice_unlock(ic, ICE_LOCK_STATE);
}

/* ---- making a call ---- */

void Ice_initRequest(Ice_CommunicatorPtr ic) {
    Ice_OutputStream_init(&ic->request, ICEC_TASKS ? ic->requestData : ic->out,
                          ICEC_TASKS ? ICE_REQUEST_MAX : ICE_MESSAGE_MAX);
}

/* Connects to one endpoint, or to what is there already. */
static Ice_Status open(Ice_ObjectPrxPtr self, const Ice_Byte* endpoint, Ice_Int size) {
    Ice_CommunicatorPtr ic = self->communicator;
    Ice_Status status;
    Ice_lock(ic, ICE_LOCK_STATE);
    status = ic->endpoint->connect(ic->endpointContext, endpoint, size, &self->connection);
    if (status == ICE_OK && ic->connections[self->connection].state == ICE_FREE)
        Ice_openConnection(ic, self->connection, ICE_WAITING);
    Ice_unlock(ic, ICE_LOCK_STATE);
    return status;
}

/* Tries the proxy's endpoints in turn. */
static Ice_Status connect(Ice_ObjectPrxPtr self, int slot) {
    Ice_CommunicatorPtr ic = self->communicator;
    Ice_Status status = ICE_NO_ENDPOINT;
    Ice_InputStream is;
    int n;
    if (self->mode >= ICE_DATAGRAM)
        return ICE_NO_ENDPOINT;
    if (ICEC_ASYNC && self->generation) {
        return Ice_countPending(ic, self->connection, self->generation, 0) ? ICE_OK
                                                                           : ICE_CONNECTION_LOST;
    }
    Ice_InputStream_init(&is, self->endpoints + 1, self->endpointsSize - 1);
    for (n = self->endpoints[0]; n > 0 && status != ICE_OK; --n) {
        Ice_Int begin = is.position;
        (void)Ice_InputStream_readShort(&is);
        (void)Ice_InputStream_readBlob(&is, Ice_InputStream_readInt(&is) - 4);
        status = open(self, is.data + begin, is.position - begin);
    }
    if (status == ICE_OK)
        status = Ice_await(ic, &ic->connections[self->connection].state, slot, self->timeoutMs);
    return status;
}

Ice_Status Ice_ObjectPrx_ice_getConnection(Ice_ObjectPrxPtr self, int* connection) {
    Ice_OutputStreamPtr os = Ice_ObjectPrx_begin(self, "", 0); /* for a slot to wait in */
    if (!os)
        return (Ice_Status)self->status;
    Ice_unlock(self->communicator, ICE_LOCK_SEND);
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

static int takeSlot(Ice_ObjectPrxPtr self) {
    Ice_CommunicatorPtr ic = self->communicator;
    int c;
    self->call = -1;
    Ice_lock(ic, ICE_LOCK_STATE);
    for (c = 0; c < ICE_CALLS && self->call < 0; ++c)
        if (ic->calls[c].state == ICE_FREE) {
            ic->calls[c].state = ICE_BUILDING;
            self->call = c;
        }
    Ice_unlock(ic, ICE_LOCK_STATE);
    return self->call;
}

Ice_OutputStreamPtr Ice_ObjectPrx_begin(Ice_ObjectPrxPtr self, const char* operation,
                                        Ice_Byte mode) {
    Ice_CommunicatorPtr ic = self->communicator;
    Ice_OutputStreamPtr os = &ic->request;
    Ice_Call* call;
    self->status = self->mode != ICE_TWOWAY && mode & ICE_RESULTS ? ICE_TWOWAY_ONLY : ICE_LIMIT;
    if (self->status == ICE_TWOWAY_ONLY || takeSlot(self) < 0)
        return 0;
    call = Ice_callOf(ic, self);
    if (ICEC_ASYNC)
        call->callback = 0;
    self->status = ICE_OK;
    if (!(ICEC_BATCH && self->batch))
        self->status = (Ice_Byte)connect(self, self->call);
    Ice_lock(ic, ICE_LOCK_SEND);
    Ice_initRequest(ic);
    os->minor = self->minor;
    if (!(ICEC_BATCH && self->batch)) {
        call->id = 0;
        if (self->mode == ICE_TWOWAY) {
            ic->lastId = (ic->lastId & 0x3FFFFFFF) + 1; /* never 0: that is a one-way request */
            call->id = ic->lastId;
        }
        Ice_beginMessage(os, ICE_REQUEST);
        Ice_OutputStream_writeInt(os, call->id);
    }
    Ice_OutputStream_writeBlob(os, self->identity, self->identitySize);
    Ice_OutputStream_writeText(os, operation);
    mode = mode & (Ice_Byte)~ICE_RESULTS;
    if (ICEC_CONTEXTS) {
        Ice_OutputStream_writeByte(os, mode);
        writeContext(os, self->context);
    } else {
        Ice_OutputStream_writeShort(os, mode); /* and no context */
    }
    ic->requestBody = Ice_beginEncapsulation(os);
    return os;
}

Ice_Status Ice_sendRequest(Ice_ObjectPrxPtr self, Ice_Callback callback, void* cookie) {
    Ice_CommunicatorPtr ic = self->communicator;
    Ice_OutputStreamPtr os = &ic->request;
    Ice_Call* call = Ice_callOf(ic, self);
    Ice_Status status = (Ice_Status)self->status;
    Ice_endEncapsulation(os, ic->requestBody);
    if (ICEC_BATCH && self->batch) {
        status = self->batch->keep(self);
    } else {
        Ice_endMessage(os);
        if (status == ICE_OK && os->failed)
            status = ICE_MARSHAL;
        if (status == ICE_OK) {
            Ice_lock(ic, ICE_LOCK_STATE);
            call->connection = self->connection;
            if (ICEC_ASYNC) {
                call->callback = callback;
                call->cookie = cookie;
                call->timeoutMs = self->timeoutMs;
                call->begunMs = Ice_nowMs(ic);
            }
            if (ICEC_COPY_REPLIES) {
                call->reply = self->reply ? self->reply : call->replyData;
                call->replySize = self->reply ? self->replySize : (Ice_Int)sizeof call->replyData;
            }
            if (ICEC_DETAILS)
                memset(&call->failure, 0, sizeof call->failure);
            if (self->mode == ICE_TWOWAY)
                call->state = ICE_WAITING; /* before the reply can be there */
            Ice_unlock(ic, ICE_LOCK_STATE);
            status = Ice_send(ic, self->connection, os);
        }
    }
    Ice_unlock(ic, ICE_LOCK_SEND);
    return status;
}

Ice_Status Ice_ObjectPrx_invoke(Ice_ObjectPrxPtr self, Ice_InputStreamPtr* is) {
    Ice_CommunicatorPtr ic = self->communicator;
    Ice_Call* call = Ice_callOf(ic, self);
    Ice_Status status = Ice_sendRequest(self, 0, 0);
    if (status != ICE_OK || self->mode != ICE_TWOWAY)
        return status;
    status = Ice_await(ic, &call->state, self->call, self->timeoutMs);
    Ice_lock(ic, ICE_LOCK_STATE);
    if (call->state == ICE_DONE)
        status = (Ice_Status)call->status;
    Ice_unlock(ic, ICE_LOCK_STATE);
    *is = &call->is;
    return status;
}

Ice_Status Ice_ObjectPrx_end(Ice_ObjectPrxPtr self, Ice_Status status) {
    Ice_CommunicatorPtr ic = self->communicator;
    Ice_Call* call = Ice_callOf(ic, self);
    if ((status == ICE_OK || status == ICE_USER_EXCEPTION) && call->state == ICE_DONE &&
        call->is.failed)
        status = ICE_MARSHAL;
    Ice_lock(ic, ICE_LOCK_STATE);
    call->state = ICE_FREE;
    Ice_unlock(ic, ICE_LOCK_STATE);
    return status;
}

void Ice_ObjectPrx_failure(const Ice_ObjectPrx* self, Ice_Failure* failure) {
    if (self->call >= 0)
        *failure = self->communicator->calls[self->call].failure;
    else
        memset(failure, 0, sizeof *failure);
}
