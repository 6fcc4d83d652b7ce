/* SPDX-License-Identifier: MIT
 *
 * xbee_endpoint: messages between IceC's tasks and the radio task's link.
 */
#include "xbee_endpoint.h"

#include <string.h>

#define EVENTS (sizeof((XBeeATEndpoint*)0)->events / sizeof(Ice_Event))
#define RETRIES 100 /* of a send while the link's queue is full, 20 ms apart */

static void report(XBeeATEndpoint* self, Ice_EventKind kind, int channel, Ice_Int size) {
    Ice_Event* event = &self->events[(self->head + self->count++) % EVENTS];
    event->kind = kind;
    event->connection = channel;
    event->size = size;
    self->port->signal(self->context);
}

/* 1: this report was still waiting, and is taken back. */
static int takeBack(XBeeATEndpoint* self, Ice_EventKind kind, int channel) {
    U32 i = 0;
    while (i < self->count && (self->events[(self->head + i) % EVENTS].kind != kind ||
                               self->events[(self->head + i) % EVENTS].connection != channel))
        ++i;
    if (i == self->count)
        return 0;
    for (--self->count; i < self->count; ++i)
        self->events[(self->head + i) % EVENTS] = self->events[(self->head + i + 1U) % EVENTS];
    return 1;
}

int XBeeATEndpoint_onMessage(XBeeATEndpoint* self, int channel, const U8* data, U32 size) {
    /* Opening and closing come before it in order, so the queue must be empty. */
    if (!self->buffer || self->count)
        return 1;
    memcpy(self->buffer, data, size);
    self->buffer = 0;
    report(self, ICE_EVENT_MESSAGE, channel, (Ice_Int)size);
    return 0;
}

void XBeeATEndpoint_onChannel(XBeeATEndpoint* self, int channel, int isOpen) {
    if (channel == XBEE_OWN_CHANNEL && isOpen)
        return;
    if (channel == XBEE_OWN_CHANNEL)
        self->ownOpen = 0;
    /* A connection that came and went while nobody looked is no news: so a channel has at most a
     * closing and an opening waiting, however often the ground starts again. */
    if (isOpen || !takeBack(self, ICE_EVENT_OPENED, channel))
        report(self, isOpen ? ICE_EVENT_OPENED : ICE_EVENT_CLOSED, channel, 0);
}

void XBeeATEndpoint_onState(XBeeATEndpoint* self, Link_State state) {
    if (state != LINK_STATE_UP && self->ownOpen) {
        self->ownOpen = 0;
        report(self, ICE_EVENT_CLOSED, XBEE_OWN_CHANNEL, 0);
    }
}

/* The buffer is the link's only while this waits: what comes at another time, the link keeps. */
static Ice_Status receive(void* context, Ice_Byte* buffer, Ice_Int timeoutMs, Ice_Event* event) {
    XBeeATEndpoint* self = context;
    self->port->lock(self->context);
    if (self->count == 0) {
        self->buffer = buffer;
        self->port->unlock(self->context);
        self->port->kick(self->context); /* the link may hold a message */
        (void)self->port->wait(self->context, timeoutMs);
        self->port->lock(self->context);
        self->buffer = 0;
    }
    if (self->count) {
        *event = self->events[self->head];
        self->head = (self->head + 1U) % EVENTS;
        --self->count;
    }
    self->port->unlock(self->context);
    return ICE_OK;
}

static Ice_Status statusOf(Link_Status status) {
    return status == LINK_OK ? ICE_OK : status == LINK_TOO_LONG ? ICE_LIMIT : ICE_CONNECTION_LOST;
}

/* 1: the link has no room now, and it is worth another try after this pause. */
static int isFull(XBeeATEndpoint* self, Link_Status status, int* tries) {
    self->port->kick(self->context);
    if (status == LINK_FULL && ++*tries <= RETRIES) {
        (void)self->port->wait(self->context, 20);
        return 1;
    }
    if (*tries)
        self->port->signal(self->context); /* this may have taken what the receiver waits for */
    return 0;
}

static Ice_Status sendMessage(void* context, int connection, const Ice_Byte* message,
                              Ice_Int size) {
    XBeeATEndpoint* self = context;
    Link_Status status;
    int tries = 0;
    do {
        self->port->lock(self->context);
        status = Link_send(self->link, connection, message, (U32)size, 0,
                           self->port->nowUs(self->context));
        self->port->unlock(self->context);
    } while (isFull(self, status, &tries));
    return statusOf(status);
}

static Ice_Status connectTo(void* context, const Ice_Byte* encoded, Ice_Int size, int* connection) {
    XBeeATEndpoint* self = context;
    Link_Status status;
    int tries = 0;
    if (size < 2 || encoded[0] != (XBEE_ENDPOINT_TYPE & 0xFF) ||
        encoded[1] != XBEE_ENDPOINT_TYPE >> 8)
        return ICE_NO_ENDPOINT;
    do { /* the last closing may be on its way still */
        status = LINK_OK;
        self->port->lock(self->context);
        if (Link_state(self->link) != LINK_STATE_UP)
            status = LINK_DOWN;
        else if (!self->ownOpen)
            status =
                Link_openChannel(self->link, XBEE_OWN_CHANNEL, self->port->nowUs(self->context));
        if (status == LINK_OK && !self->ownOpen) /* the end of the last connection, not of this */
            (void)takeBack(self, ICE_EVENT_CLOSED, XBEE_OWN_CHANNEL);
        self->ownOpen = status == LINK_OK;
        self->port->unlock(self->context);
    } while (isFull(self, status, &tries));
    *connection = XBEE_OWN_CHANNEL;
    return statusOf(status);
}

static void closeChannel(void* context, int connection) {
    XBeeATEndpoint* self = context;
    self->port->lock(self->context);
    /* The peer may have closed already; the channel may be a new one by now. */
    if (!takeBack(self, ICE_EVENT_CLOSED, connection)) {
        (void)Link_closeChannel(self->link, connection, self->port->nowUs(self->context));
        if (connection == XBEE_OWN_CHANNEL)
            self->ownOpen = 0;
    }
    self->port->unlock(self->context);
    self->port->kick(self->context);
}

static Ice_Status listenTo(void* context, const char* options) {
    (void)context;
    (void)options; /* the radio is always open */
    return ICE_OK;
}

static void encode(void* context, const char* options, Ice_OutputStreamPtr os) {
    XBeeATEndpoint* self = context;
    U32 address = options ? Ice_numberOption(options, 'a', 0) : self->address;
    Ice_OutputStream_writeShort(os, XBEE_ENDPOINT_TYPE);
    Ice_OutputStream_writeInt(os, 6 + 7);
    Ice_OutputStream_writeShort(os, 0x0101); /* encoding 1.1 */
    Ice_OutputStream_writeShort(os, (Ice_Short)address);
    Ice_OutputStream_writeByte(os, (Ice_Byte)Ice_numberOption(options, 'p', 255));
    Ice_OutputStream_writeInt(os, (Ice_Int)Ice_numberOption(options, 't', 10000));
}

static void put(Ice_OutputStreamPtr text, const char* characters) {
    while (*characters)
        Ice_OutputStream_writeByte(text, (Ice_Byte)*characters++);
}

static void putNumber(Ice_OutputStreamPtr text, U32 value) {
    if (value > 9)
        putNumber(text, value / 10);
    Ice_OutputStream_writeByte(text, (Ice_Byte)('0' + value % 10));
}

static Ice_Bool print(void* context, const Ice_Byte* encoded, Ice_Int size,
                      Ice_OutputStreamPtr text) {
    Ice_InputStream is;
    Ice_Byte channel;
    (void)context;
    Ice_InputStream_init(&is, encoded, size);
    if (Ice_InputStream_readShort(&is) != XBEE_ENDPOINT_TYPE || size != 8 + 7)
        return 0;
    is.position = 8;
    put(text, "xbee-at -a ");
    putNumber(text, (U16)Ice_InputStream_readShort(&is));
    channel = Ice_InputStream_readByte(&is);
    if (channel != 255) {
        put(text, " -p ");
        putNumber(text, channel);
    }
    put(text, " -t ");
    putNumber(text, (U32)Ice_InputStream_readInt(&is));
    return 1;
}

static U32 nowMs(void* context) {
    XBeeATEndpoint* self = context;
    return self->port->nowMs(self->context);
}

static void wakeUp(void* context) {
    XBeeATEndpoint* self = context;
    self->port->signal(self->context);
}

void XBeeATEndpoint_init(Ice_CommunicatorPtr ic, const char* name, XBeeATEndpoint* self, Link* link,
                         U16 address, const XBeeATPort* port, void* context) {
    static const Ice_Endpoint endpoint = {
        "xbee-at", receive, sendMessage, connectTo, closeChannel,
        listenTo,  encode,  wakeUp,      nowMs,     ICEC_DETAILS ? print : 0};
    (void)name;
    memset(self, 0, sizeof *self);
    self->link = link;
    self->address = address;
    self->port = port;
    self->context = context;
    Ice_Communicator_setEndpoint(ic, &endpoint, self);
}
