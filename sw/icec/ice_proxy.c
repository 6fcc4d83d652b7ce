/* SPDX-License-Identifier: MIT
 *
 * ice_proxy: proxies, and calls made through them.
 */
#include "ice_private.h"

#include <string.h>

#define DEFAULT_TIMEOUT_MS 10000
#define SLICE_MS 20 /* a lone task looks at its reply this often */

static void initProxy(Ice_ObjectPrxPtr prx, Ice_CommunicatorPtr ic) {
    memset(prx, 0, sizeof *prx);
    prx->communicator = ic;
    prx->timeoutMs = DEFAULT_TIMEOUT_MS;
}

static Ice_Status setName(Ice_ObjectPrxPtr prx, const char *name, size_t size) {
    if (size == 0 || size > ICE_NAME_MAX)
        return ICE_LIMIT;
    memcpy(prx->name, name, size);
    prx->nameSize = (Ice_Byte)size;
    return ICE_OK;
}

static Ice_Status encodeEndpoint(Ice_ObjectPrxPtr prx, const char *options) {
    Ice_CommunicatorPtr ic = prx->communicator;
    Ice_OutputStream os;
    Ice_OutputStream_init(&os, prx->encoded, ICE_ENDPOINT_MAX);
    ic->endpoint->encode(ic->endpointContext, options, &os);
    prx->encodedSize = (Ice_Byte)os.size;
    prx->endpointCount = 1;
    return os.failed ? ICE_LIMIT : ICE_OK;
}

Ice_Status Ice_Communicator_stringToProxy(Ice_CommunicatorPtr ic, const char *proxy, Ice_ObjectPrxPtr prx) {
    size_t n = strcspn(proxy, " :");
    const char *colon = strchr(proxy, ':');
    size_t t = ic->endpoint ? strlen(ic->endpoint->name) : 0;
    const char *at;
    initProxy(prx, ic);
    if (!colon || t == 0 || strncmp(colon + 1, ic->endpoint->name, t) != 0 ||
        (colon[1 + t] != ' ' && colon[1 + t] != 0))
        return ICE_NO_ENDPOINT;
    for (at = proxy + n; at < colon; ++at)
        if (at[0] == '-' && at[1] == 'o')
            prx->mode = 1;
    if (setName(prx, proxy, n) != ICE_OK)
        return ICE_LIMIT;
    return encodeEndpoint(prx, colon + 1 + t);
}

Ice_Status Ice_ObjectAdapter_createProxy(Ice_ObjectAdapterPtr adapter, const char *identity,
                                         Ice_ObjectPrxPtr prx) {
    initProxy(prx, adapter->communicator);
    if (setName(prx, identity, strlen(identity)) != ICE_OK)
        return ICE_LIMIT;
    return encodeEndpoint(prx, 0);
}

void Ice_OutputStream_writePrx(Ice_OutputStreamPtr os, const Ice_ObjectPrx *prx) {
    Ice_String name;
    name.size = prx ? prx->nameSize : 0;
    name.data = prx ? prx->name : "";
    Ice_OutputStream_writeString(os, name);
    Ice_OutputStream_writeSize(os, 0); /* category */
    if (name.size == 0)
        return;
    Ice_OutputStream_writeSize(os, 0); /* facet */
    Ice_OutputStream_writeByte(os, prx->mode);
    Ice_OutputStream_writeBool(os, 0); /* secure */
    if (os->minor != 0) {
        static const Ice_Byte versions[4] = {1, 0, 1, 1}; /* protocol 1.0, encoding 1.1 */
        Ice_OutputStream_writeBlob(os, versions, 4);
    }
    Ice_OutputStream_writeSize(os, prx->endpointCount);
    if (prx->endpointCount)
        Ice_OutputStream_writeBlob(os, prx->encoded, prx->encodedSize);
    else
        Ice_OutputStream_writeSize(os, 0); /* adapter id */
}

/* Keeps one endpoint as it is, if it fits. */
static void keepEndpoint(Ice_InputStreamPtr is, Ice_ObjectPrxPtr prx) {
    Ice_Int begin = is->position, size;
    (void)Ice_InputStream_readShort(is);
    size = Ice_InputStream_readInt(is);
    (void)Ice_InputStream_readBlob(is, size < 6 ? -1 : size - 4);
    size = is->position - begin;
    if (is->failed || prx->encodedSize + size > ICE_ENDPOINT_MAX)
        return;
    memcpy(prx->encoded + prx->encodedSize, is->data + begin, (size_t)size);
    prx->encodedSize = (Ice_Byte)(prx->encodedSize + size);
    ++prx->endpointCount;
}

void Ice_InputStream_readPrx(Ice_InputStreamPtr is, Ice_CommunicatorPtr ic, Ice_ObjectPrxPtr prx) {
    Ice_String name = Ice_InputStream_readString(is);
    Ice_String category = Ice_InputStream_readString(is);
    Ice_Int n;
    initProxy(prx, ic);
    if (name.size == 0)
        return;
    if (category.size || setName(prx, name.data, (size_t)name.size) != ICE_OK)
        is->failed = 1;
    for (n = Ice_InputStream_readSequence(is, 1); n > 0; --n)
        (void)Ice_InputStream_readString(is);
    prx->mode = Ice_InputStream_readByte(is);
    (void)Ice_InputStream_readBool(is);
    if (is->minor != 0)
        (void)Ice_InputStream_readBlob(is, 4);
    n = Ice_InputStream_readSequence(is, 8);
    if (n == 0)
        (void)Ice_InputStream_readString(is); /* an adapter id: no locator here */
    while (n-- > 0 && !is->failed)
        keepEndpoint(is, prx);
}

/* ---- calls ---- */

void Ice_wakeCalls(Ice_CommunicatorPtr ic) {
    int c;
    for (c = 0; c < ICE_CALLS; ++c)
        if (ic->calls[c].used)
            ic->os->wake(ic->osContext, c);
}

void Ice_failCalls(Ice_CommunicatorPtr ic, int connection) {
    int c;
    for (c = 0; c < ICE_CALLS; ++c)
        if (ic->calls[c].used && !ic->calls[c].done && ic->calls[c].connection == connection) {
            ic->calls[c].status = ICE_CONNECTION_LOST;
            ic->calls[c].done = 1;
            ic->os->wake(ic->osContext, c);
        }
}

void Ice_takeReply(Ice_CommunicatorPtr ic, Ice_InputStreamPtr is) {
    Ice_Int id = Ice_InputStream_readInt(is);
    Ice_Int size = is->size - is->position;
    int c;
    for (c = 0; c < ICE_CALLS; ++c) {
        Ice_Call *call = &ic->calls[c];
        if (!call->used || call->done || call->id != id || is->failed)
            continue;
        call->status = size <= (Ice_Int)sizeof call->reply ? ICE_OK : ICE_MARSHAL;
        if (call->status == ICE_OK) {
            memcpy(call->reply, is->data + is->position, (size_t)size);
            call->replySize = size;
        }
        call->done = 1;
        ic->os->wake(ic->osContext, c);
    }
}

Ice_OutputStreamPtr Ice_ObjectPrx_begin(Ice_ObjectPrxPtr self, const char *operation, Ice_Byte mode) {
    Ice_CommunicatorPtr ic = self->communicator;
    Ice_Call *call = 0;
    Ice_String name;
    int c;
    ic->os->lock(ic->osContext);
    for (c = 0; c < ICE_CALLS && !call; ++c)
        if (!ic->calls[c].used) {
            call = &ic->calls[c];
            call->used = 1;
            call->done = 0;
            call->connection = -1;
            call->id = self->mode ? 0 : ++ic->lastId;
            self->call = c;
        }
    ic->os->unlock(ic->osContext);
    if (!call)
        return 0;
    Ice_OutputStream_init(&call->os, call->out, sizeof call->out);
    Ice_beginMessage(&call->os, ICE_REQUEST);
    Ice_OutputStream_writeInt(&call->os, call->id);
    name.size = self->nameSize;
    name.data = self->name;
    Ice_OutputStream_writeString(&call->os, name);
    Ice_OutputStream_writeSize(&call->os, 0); /* category */
    Ice_OutputStream_writeSize(&call->os, 0); /* facet */
    Ice_OutputStream_writeString(&call->os, Ice_String_from(operation));
    Ice_OutputStream_writeByte(&call->os, mode);
    Ice_OutputStream_writeSize(&call->os, 0); /* context */
    call->encapsulation = Ice_beginEncapsulation(&call->os);
    return &call->os;
}

/* Waits for a flag that the receiving task sets. */
static Ice_Status await(Ice_CommunicatorPtr ic, int slot, const Ice_Byte *flag, Ice_Int timeoutMs) {
    Ice_Call *call = &ic->calls[slot];
    if (ic->receiver >= 0 && ic->receiver == ic->os->task(ic->osContext))
        return ICE_LIMIT; /* the task that receives cannot wait for what it would receive */
    while (!*flag && !call->done) {
        if (ic->receiver >= 0) {
            if (!ic->os->wait(ic->osContext, slot, timeoutMs))
                return ICE_TIMEOUT;
        } else {
            Ice_Status status = Ice_Communicator_poll(ic, SLICE_MS);
            if (status == ICE_TIMEOUT)
                timeoutMs -= SLICE_MS;
            else if (status != ICE_OK)
                return status;
            if (timeoutMs <= 0)
                return ICE_TIMEOUT;
        }
    }
    return call->done ? call->status : ICE_OK;
}

static Ice_Status readReply(Ice_Call *call) {
    Ice_Byte status;
    Ice_InputStream_init(&call->is, call->reply, call->replySize);
    call->is.arena = call->arena;
    call->is.arenaSize = (Ice_Int)(sizeof call->arena / 4);
    status = Ice_InputStream_readByte(&call->is);
    if (call->is.failed)
        return ICE_MARSHAL;
    if (status <= 1) {
        Ice_Status entered = Ice_enterEncapsulation(&call->is);
        return entered != ICE_OK || status == 0 ? entered : ICE_USER_EXCEPTION;
    }
    if (status <= 4)
        return (Ice_Status)(ICE_OBJECT_NOT_EXIST + (status - 2));
    return ICE_UNKNOWN_EXCEPTION;
}

Ice_Status Ice_ObjectPrx_invoke(Ice_ObjectPrxPtr self, Ice_InputStreamPtr *is) {
    Ice_CommunicatorPtr ic = self->communicator;
    Ice_Call *call = &ic->calls[self->call];
    Ice_Status status;
    Ice_endEncapsulation(&call->os, call->encapsulation);
    Ice_endMessage(&call->os);
    if (call->os.failed)
        return ICE_MARSHAL;
    if (ic->dispatching && ic->receiver == ic->os->task(ic->osContext) && !self->mode)
        return ICE_LIMIT;
    status = ic->endpoint->connect(ic->endpointContext, self->encoded, self->encodedSize,
                                   &call->connection);
    if (status == ICE_OK)
        status = await(ic, self->call, &ic->validated[call->connection], self->timeoutMs);
    if (status == ICE_OK)
        status = ic->endpoint->send(ic->endpointContext, call->connection, call->out, call->os.size);
    if (status != ICE_OK || self->mode)
        return status;
    status = await(ic, self->call, &call->done, self->timeoutMs);
    if (status != ICE_OK)
        return status;
    status = readReply(call);
    *is = &call->is;
    return status;
}

Ice_Status Ice_ObjectPrx_end(Ice_ObjectPrxPtr self, Ice_Status status) {
    Ice_Call *call = &self->communicator->calls[self->call];
    if (status == ICE_OK && !self->mode && call->is.failed)
        status = ICE_MARSHAL;
    call->used = 0;
    return status;
}

Ice_Status Ice_ObjectPrx_ice_ping(Ice_ObjectPrxPtr self) {
    Ice_InputStreamPtr is;
    if (!Ice_ObjectPrx_begin(self, "ice_ping", 2))
        return ICE_LIMIT;
    return Ice_ObjectPrx_end(self, Ice_ObjectPrx_invoke(self, &is));
}
