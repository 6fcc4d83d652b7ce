/* SPDX-License-Identifier: MIT
 *
 * loop_endpoint: a queue of events for each of two communicators.
 *
 * Proxies: "loop [-c n]", n 0 or 1: which of the two connections of this side.
 */
#include "loop_endpoint.h"

#include <string.h>

Ice_Status LoopEndpoint_inject(LoopEndpoint* self, Ice_EventKind kind, int connection,
                               const Ice_Byte* message, Ice_Int size) {
    unsigned at = (self->head + self->count) % LOOP_EVENTS;
    if (self->count == LOOP_EVENTS || size > ICE_MESSAGE_MAX)
        return ICE_LIMIT;
    self->events[at].kind = kind;
    self->events[at].connection = connection;
    self->events[at].size = size;
    if (size > 0)
        memcpy(self->data[at], message, (size_t)size);
    if (kind != ICE_EVENT_MESSAGE)
        self->open[connection] = kind == ICE_EVENT_OPENED;
    ++self->count;
    return ICE_OK;
}

static Ice_Status receive(void* context, Ice_Byte* buffer, Ice_Int timeoutMs, Ice_Event* event) {
    LoopEndpoint* self = context;
    U32 begin = *self->nowMs;
    while (self->count == 0 && (Ice_Int)(*self->nowMs - begin) < timeoutMs) {
        /* Runs the peer, unless the peer is waiting for this side. */
        if (self->peer && !self->running) {
            Ice_Status status;
            self->running = 1;
            status = Ice_Communicator_poll(self->peer->ic, 0);
            self->running = 0;
            if (status == ICE_OK)
                continue;
        }
        if (self->count == 0)
            ++*self->nowMs;
    }
    if (self->count) {
        *event = self->events[self->head];
        if (event->kind == ICE_EVENT_MESSAGE)
            memcpy(buffer, self->data[self->head], (size_t)event->size);
        self->head = (self->head + 1) % LOOP_EVENTS;
        --self->count;
    }
    return ICE_OK;
}

static Ice_Status sendMessage(void* context, int connection, const Ice_Byte* message,
                              Ice_Int size) {
    LoopEndpoint* self = context;
    if (!self->open[connection])
        return ICE_CONNECTION_LOST;
    if (self->tap)
        self->tap(self->tapContext, connection, message, size);
    return self->peer
               ? LoopEndpoint_inject(self->peer, ICE_EVENT_MESSAGE, connection, message, size)
               : ICE_OK;
}

static Ice_Status connectTo(void* context, const Ice_Byte* encoded, Ice_Int size, int* connection) {
    LoopEndpoint* self = context;
    if (size != 9 || encoded[0] != (LOOP_ENDPOINT_TYPE & 0xFF) ||
        encoded[1] != LOOP_ENDPOINT_TYPE >> 8)
        return ICE_NO_ENDPOINT;
    *connection = self->first + 2 * (encoded[8] & 1);
    if (self->open[*connection])
        return ICE_OK;
    if (!self->peer && !self->silent)
        return ICE_CONNECTION_LOST;
    self->open[*connection] = 1;
    return self->peer ? LoopEndpoint_inject(self->peer, ICE_EVENT_OPENED, *connection, 0, 0)
                      : ICE_OK;
}

/* Returns 1 if the peer has closed already, and takes its report back, since the connection may be
 * a new one by now. */
static int isOver(LoopEndpoint* self, int connection) {
    unsigned i;
    for (i = 0; i < self->count; ++i) {
        Ice_Event* event = &self->events[(self->head + i) % LOOP_EVENTS];
        if (event->kind == ICE_EVENT_CLOSED && event->connection == connection) {
            event->kind = ICE_EVENT_NONE;
            return 1;
        }
    }
    return 0;
}

static void closeConnection(void* context, int connection) {
    LoopEndpoint* self = context;
    if (isOver(self, connection))
        return;
    if (self->open[connection] && self->peer)
        (void)LoopEndpoint_inject(self->peer, ICE_EVENT_CLOSED, connection, 0, 0);
    self->open[connection] = 0;
}

static Ice_Status listenTo(void* context, const char* options) {
    (void)context;
    (void)options;
    return ICE_OK;
}

static void encode(void* context, const char* options, Ice_OutputStreamPtr os) {
    (void)context;
    Ice_OutputStream_writeShort(os, LOOP_ENDPOINT_TYPE);
    Ice_OutputStream_writeInt(os, 7);
    Ice_OutputStream_writeShort(os, 0x0101); /* encoding 1.1 */
    Ice_OutputStream_writeByte(os, (Ice_Byte)Ice_numberOption(options, 'c', 0));
}

static Ice_Bool print(void* context, const Ice_Byte* encoded, Ice_Int size,
                      Ice_OutputStreamPtr text) {
    (void)context;
    if (size != 9 || encoded[0] != (LOOP_ENDPOINT_TYPE & 0xFF) ||
        encoded[1] != LOOP_ENDPOINT_TYPE >> 8)
        return 0;
    Ice_OutputStream_writeBlob(text, (const Ice_Byte*)(encoded[8] ? "loop -c 1" : "loop -c 0"), 9);
    return 1;
}

static void wakeUp(void* context) {
    (void)context; /* one task: it is awake */
}

static U32 nowMs(void* context) {
    LoopEndpoint* self = context;
    return *self->nowMs;
}

void LoopEndpoint_init(Ice_CommunicatorPtr ic, LoopEndpoint* self) {
    static const Ice_Endpoint endpoint = {"loop",          receive,  sendMessage, connectTo,
                                          closeConnection, listenTo, encode,      wakeUp,
                                          nowMs,           print};
    memset(self, 0, sizeof *self);
    self->ic = ic;
    self->nowMs = &self->ownNowMs;
    Ice_Communicator_setEndpoint(ic, &endpoint, self);
}

void LoopEndpoint_join(LoopEndpoint* a, LoopEndpoint* b) {
    a->peer = b;
    b->peer = a;
    b->nowMs = a->nowMs;
    b->first = 1;
}
