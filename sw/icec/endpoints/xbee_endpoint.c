/* SPDX-License-Identifier: MIT
 *
 * xbee_endpoint: messages between IceC's tasks and the radio task's link.
 */
#include "xbee_endpoint.h"

#include <string.h>

#define EVENTS (sizeof((XBeeATEndpoint *)0)->events / sizeof(Ice_Event))
#define RETRIES 100 /* of a send while the link's queue is full, 20 ms apart */

static int put(XBeeATEndpoint *self, Ice_EventKind kind, int channel, Ice_Int size) {
    Ice_Event *event;
    if (self->count == EVENTS)
        return 0;
    event = &self->events[(self->head + self->count++) % EVENTS];
    event->kind = kind;
    event->connection = channel;
    event->size = size;
    self->port->signal(self->context);
    return 1;
}

int XBeeATEndpoint_onMessage(XBeeATEndpoint *self, int channel, const U8 *data, U32 size) {
    /* Opening and closing come before it in order, so the queue must be empty. */
    if (!self->buffer || self->count)
        return 1;
    memcpy(self->buffer, data, size);
    self->buffer = 0;
    (void)put(self, ICE_EVENT_MESSAGE, channel, (Ice_Int)size);
    return 0;
}

void XBeeATEndpoint_onChannel(XBeeATEndpoint *self, int channel, int isOpen) {
    if (channel == XBEE_OWN_CHANNEL && isOpen)
        return;
    if (channel == XBEE_OWN_CHANNEL)
        self->ownOpen = 0;
    (void)put(self, isOpen ? ICE_EVENT_OPENED : ICE_EVENT_CLOSED, channel, 0);
}

void XBeeATEndpoint_onState(XBeeATEndpoint *self, Link_State state) {
    if (state != LINK_STATE_UP && self->ownOpen) {
        self->ownOpen = 0;
        (void)put(self, ICE_EVENT_CLOSED, XBEE_OWN_CHANNEL, 0);
    }
}

static Ice_Status receive(void *context, Ice_Byte *buffer, Ice_Int timeoutMs, Ice_Event *event) {
    XBeeATEndpoint *self = context;
    int tries;
    for (tries = 0; tries < 2; ++tries) {
        self->port->lock(self->context);
        if (self->count) {
            *event = self->events[self->head];
            self->head = (self->head + 1U) % EVENTS;
            --self->count;
            self->port->unlock(self->context);
            return ICE_OK;
        }
        self->buffer = buffer;
        self->port->unlock(self->context);
        if (tries == 0) {
            self->port->kick(self->context); /* the link may hold a message */
            (void)self->port->wait(self->context, timeoutMs);
        }
    }
    return ICE_OK; /* nothing came */
}

static Ice_Status statusOf(Link_Status status) {
    return status == LINK_OK ? ICE_OK : status == LINK_TOO_LONG ? ICE_LIMIT : ICE_CONNECTION_LOST;
}

static Ice_Status sendMessage(void *context, int connection, const Ice_Byte *message, Ice_Int size) {
    XBeeATEndpoint *self = context;
    Link_Status status;
    int tries = 0;
    do {
        self->port->lock(self->context);
        status = Link_send(self->link, connection, message, (U32)size, 0, self->port->nowUs(self->context));
        self->port->unlock(self->context);
        self->port->kick(self->context);
        if (status == LINK_FULL)
            (void)self->port->wait(self->context, 20);
    } while (status == LINK_FULL && ++tries < RETRIES);
    return statusOf(status);
}

static Ice_Status connectTo(void *context, const Ice_Byte *encoded, Ice_Int size, int *connection) {
    XBeeATEndpoint *self = context;
    Link_Status status = LINK_OK;
    if (size < 2 || encoded[0] != (XBEE_ENDPOINT_TYPE & 0xFF) || encoded[1] != XBEE_ENDPOINT_TYPE >> 8)
        return ICE_NO_ENDPOINT;
    self->port->lock(self->context);
    if (Link_state(self->link) != LINK_STATE_UP)
        status = LINK_DOWN;
    else if (!self->ownOpen)
        status = Link_openChannel(self->link, XBEE_OWN_CHANNEL, self->port->nowUs(self->context));
    self->ownOpen = status == LINK_OK;
    self->port->unlock(self->context);
    self->port->kick(self->context);
    *connection = XBEE_OWN_CHANNEL;
    return statusOf(status);
}

static void closeChannel(void *context, int connection) {
    XBeeATEndpoint *self = context;
    self->port->lock(self->context);
    (void)Link_closeChannel(self->link, connection, self->port->nowUs(self->context));
    if (connection == XBEE_OWN_CHANNEL)
        self->ownOpen = 0;
    self->port->unlock(self->context);
    self->port->kick(self->context);
}

static Ice_Status listenTo(void *context, const char *options) {
    (void)context;
    (void)options; /* the radio is always open */
    return ICE_OK;
}

/* The number behind "-x", decimal or 0x..., else `fallback`. */
static U32 option(const char *options, char letter, U32 fallback) {
    const char *at;
    for (at = options; *at; ++at)
        if (at[0] == '-' && at[1] == letter && at[2] == ' ') {
            U32 value = 0, base = 10;
            at += 3;
            if (at[0] == '0' && (at[1] == 'x' || at[1] == 'X')) {
                base = 16;
                at += 2;
            }
            for (;; ++at) {
                if (*at >= '0' && *at <= '9')
                    value = value * base + (U32)(*at - '0');
                else if (base == 16 && (*at | 32) >= 'a' && (*at | 32) <= 'f')
                    value = value * base + (U32)((*at | 32) - 'a' + 10);
                else
                    return value;
            }
        }
    return fallback;
}

static void encode(void *context, const char *options, Ice_OutputStreamPtr os) {
    XBeeATEndpoint *self = context;
    U32 address = options ? option(options, 'a', 0) : self->address;
    Ice_OutputStream_writeShort(os, XBEE_ENDPOINT_TYPE);
    Ice_OutputStream_writeInt(os, 6 + 7);
    Ice_OutputStream_writeByte(os, 1);
    Ice_OutputStream_writeByte(os, 1);
    Ice_OutputStream_writeShort(os, (Ice_Short)address);
    Ice_OutputStream_writeByte(os, (Ice_Byte)(options ? option(options, 'p', 255) : 255));
    Ice_OutputStream_writeInt(os, (Ice_Int)(options ? option(options, 't', 10000) : 10000));
}

static void wakeUp(void *context) {
    XBeeATEndpoint *self = context;
    self->port->signal(self->context);
}

void XBeeATEndpoint_init(Ice_CommunicatorPtr ic, const char *name, XBeeATEndpoint *self, Link *link,
                         U16 address, const XBeeATPort *port, void *context) {
    static const Ice_Endpoint endpoint = {"xbee-at", receive, sendMessage, connectTo, closeChannel,
                                          listenTo, encode, wakeUp};
    (void)name;
    memset(self, 0, sizeof *self);
    self->link = link;
    self->address = address;
    self->port = port;
    self->context = context;
    Ice_Communicator_setEndpoint(ic, &endpoint, self);
}
