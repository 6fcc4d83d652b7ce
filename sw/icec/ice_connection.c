/* SPDX-License-Identifier: MIT
 *
 * ice_connection: what arrives on connections, and waiting for it.
 */
#include "ice_private.h"

#include <string.h>

U32 Ice_nowMs(Ice_CommunicatorPtr ic) {
    return ic->endpoint->nowMs(ic->endpointContext);
}

Ice_Status Ice_send(Ice_CommunicatorPtr ic, int connection, Ice_OutputStreamPtr os) {
    Ice_Status status = ic->endpoint->send(ic->endpointContext, connection, os->data, os->size);
    if (ICEC_ASYNC) {
        Ice_lock(ic, ICE_LOCK_STATE);
        ic->connections[connection].spokeMs = Ice_nowMs(ic);
        Ice_unlock(ic, ICE_LOCK_STATE);
    }
    return status;
}

Ice_Status Ice_sendPlain(Ice_CommunicatorPtr ic, int connection, Ice_Byte type) {
    Ice_Byte bytes[ICE_HEADER];
    Ice_OutputStream os;
    Ice_Status status;
    Ice_OutputStream_init(&os, bytes, ICE_HEADER);
    Ice_beginMessage(&os, type);
    Ice_lock(ic, ICE_LOCK_SEND);
    status = Ice_send(ic, connection, &os);
    Ice_unlock(ic, ICE_LOCK_SEND);
    return status;
}

void Ice_openConnection(Ice_CommunicatorPtr ic, int connection, Ice_Int state) {
    Ice_Connection* c = &ic->connections[connection];
    c->state = state;
    if (ICEC_ASYNC) {
        c->pending = 0;
        if (++c->generation == 0)
            c->generation = 1;
    }
}

void Ice_lose(Ice_CommunicatorPtr ic, int connection, Ice_Status status) {
    Ice_lock(ic, ICE_LOCK_STATE);
    ic->connections[connection].state = ICE_FREE;
    Ice_unlock(ic, ICE_LOCK_STATE);
    Ice_failCalls(ic, connection, status);
}

void Ice_Connection_close(Ice_CommunicatorPtr ic, int connection) {
    (void)Ice_sendPlain(ic, connection, ICE_CLOSE);
    Ice_lock(ic, ICE_LOCK_STATE);
    ic->endpoint->close(ic->endpointContext, connection);
    Ice_unlock(ic, ICE_LOCK_STATE);
    Ice_lose(ic, connection, ICE_CONNECTION_LOST);
    ic->endpoint->wake(ic->endpointContext); /* the call that failed may be its receiver's */
}

/* ICE_OK, or why the connection is to be closed; what is malformed loses it. */
static Ice_Status takeMessage(Ice_CommunicatorPtr ic, int connection, const Ice_Byte* in,
                              Ice_Int size) {
    Ice_InputStream own;
    Ice_InputStreamPtr is = &own;
    Ice_Int type;
    Ice_InputStream_init(is, in, size);
    is->communicator = ic;
    if (size < ICE_HEADER || memcmp(in, Ice_head, ICE_TYPE_AT) != 0)
        return ICE_CONNECTION_LOST;
    is->position = ICE_TYPE_AT;
    type = Ice_InputStream_readShort(is) & 0xFEFF; /* and compression: 0 or 1 is none */
    if (Ice_InputStream_readInt(is) != size)
        return ICE_CONNECTION_LOST;
    if (type == ICE_REQUEST)
        return Ice_dispatchRequest(ic, connection, is);
    if (type == ICE_REPLY) {
        Ice_takeReply(ic, connection, is);
    } else if (type == ICE_VALIDATE) {
        Ice_lock(ic, ICE_LOCK_STATE);
        ic->connections[connection].state = ICE_DONE;
        if (ICEC_TASKS)
            Ice_wakeCalls(ic);
        Ice_unlock(ic, ICE_LOCK_STATE);
    } else if (type == ICE_CLOSE) {
        return ICE_CONNECTION_CLOSED;
    } else if (ICEC_BATCH && type == ICE_BATCH) {
        return Ice_dispatchBatch(ic, connection, is);
    } else {
        /* What is compressed cannot be answered; this says that it was not executed. */
        if (ICEC_DETAILS && type > 0xFF)
            (void)Ice_sendPlain(ic, connection, ICE_CLOSE);
        return ICE_CONNECTION_LOST;
    }
    return ICE_OK;
}

/* Signs of life for who waits for an operation; time-outs of asynchronous calls. Returns how long
 * there is nothing of this to do, at most waitMs. */
static Ice_Int keepUp(Ice_CommunicatorPtr ic, Ice_Int waitMs) {
    int c;
    for (c = 0; c < ICE_CONNECTIONS; ++c) {
        Ice_Connection* connection = &ic->connections[c];
        Ice_Int left;
        int counts;
        Ice_lock(ic, ICE_LOCK_STATE);
        counts = connection->state == ICE_DONE && connection->pending;
        left = ICE_HEARTBEAT_MS - (Ice_Int)(Ice_nowMs(ic) - connection->spokeMs);
        Ice_unlock(ic, ICE_LOCK_STATE);
        if (!counts)
            continue;
        if (left <= 0) {
            (void)Ice_sendPlain(ic, c, ICE_VALIDATE);
            left = ICE_HEARTBEAT_MS;
        }
        if (left < waitMs)
            waitMs = left;
    }
    return Ice_expireCalls(ic, waitMs);
}

static Ice_Status takeEvent(Ice_CommunicatorPtr ic, const Ice_Byte* in, const Ice_Event* event) {
    int connection = event->connection;
    Ice_Status end = ICE_CONNECTION_LOST;
    if (event->kind == ICE_EVENT_NONE)
        return ICE_TIMEOUT;
    if (event->kind == ICE_EVENT_OPENED) { /* who accepts a connection speaks first */
        Ice_lock(ic, ICE_LOCK_STATE);
        Ice_openConnection(ic, connection, ICE_DONE);
        Ice_unlock(ic, ICE_LOCK_STATE);
        (void)Ice_sendPlain(ic, connection, ICE_VALIDATE);
        return ICE_OK;
    }
    if (event->kind == ICE_EVENT_MESSAGE) {
        end = takeMessage(ic, connection, in, event->size);
        if (end == ICE_OK)
            return ICE_OK;
        Ice_lock(ic, ICE_LOCK_STATE);
        ic->endpoint->close(ic->endpointContext, connection);
        Ice_unlock(ic, ICE_LOCK_STATE);
    }
    Ice_lose(ic, connection, end);
    return ICE_OK;
}

Ice_Status Ice_receiveOne(Ice_CommunicatorPtr ic, Ice_Int timeoutMs) {
    Ice_Event event;
    Ice_Status status;
    Ice_Byte* in;
    if (ic->depth == ICEC_NESTING)
        return ICE_LIMIT;
    in = ic->in[ICEC_NESTING > 1 ? ic->depth : 0];
    if (ICEC_ASYNC)
        timeoutMs = keepUp(ic, timeoutMs);
    event.kind = ICE_EVENT_NONE;
    ++ic->depth;
    status = ic->endpoint->receive(ic->endpointContext, in, timeoutMs, &event);
    if (status == ICE_OK)
        status = takeEvent(ic, in, &event);
    --ic->depth;
    return status;
}

static Ice_Int stateOf(Ice_CommunicatorPtr ic, const volatile Ice_Int* state) {
    Ice_Int now;
    Ice_lock(ic, ICE_LOCK_STATE);
    now = *state;
    Ice_unlock(ic, ICE_LOCK_STATE);
    return now;
}

Ice_Status Ice_await(Ice_CommunicatorPtr ic, const volatile Ice_Int* state, int slot,
                     Ice_Int timeoutMs) {
    U32 begin = Ice_nowMs(ic);
    Ice_Status status = ICE_OK;
    Ice_Int end;
    int leads = 0;
    while (stateOf(ic, state) == ICE_WAITING) {
        Ice_Int left = timeoutMs - (Ice_Int)(Ice_nowMs(ic) - begin);
        status = ICE_TIMEOUT;
        if (left <= 0)
            break;
        if (ICEC_TASKS && !Ice_mayReceive(ic, &leads))
            (void)ic->os->wait(ic->osContext, slot, left);
        else
            status = Ice_receiveOne(ic, left);
        if (status != ICE_OK && status != ICE_TIMEOUT)
            break;
        status = ICE_OK;
    }
    if (ICEC_TASKS && leads)
        Ice_giveRole(ic); /* the next one takes over */
    end = stateOf(ic, state);
    return end == ICE_WAITING ? status : end == ICE_FREE ? ICE_CONNECTION_LOST : ICE_OK;
}
