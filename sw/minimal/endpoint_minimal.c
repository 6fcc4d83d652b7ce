/* SPDX-License-Identifier: MIT
 *
 * endpoint_minimal: passes messages between IceC and the link, in one task.
 */
#include "endpoint_minimal.h"

#include "ice_message.h"

#include <string.h>

#define HEAD 8
#define BODY 7
#define RETRIES 1000 /* number of attempts to send while the link has no room, 20 ms apart */

/* Beginning of an encoded endpoint: type, encapsulation of 13 bytes, encoding 1.1. */
static const Ice_Byte head[HEAD] = {
    XBEE_ENDPOINT_TYPE & 0xFF, XBEE_ENDPOINT_TYPE >> 8, 6 + BODY, 0, 0, 0, 1, 1};

/* Bit of a pending event in `events`. The event with the lowest bit is delivered first. Bit 0 is
 * the event of a message. */
#define EVENT(kind, channel) \
    (2U << (((U32)(kind) - ICE_EVENT_CLOSED) * LINK_CHANNELS + (U32)(channel)))

/* Cancels a pending event. Returns 1 if the event was still pending. */
static int cancel(XBeeATEndpoint* self, Ice_EventKind kind, int channel) {
    if (!(self->events & EVENT(kind, channel)))
        return 0;
    self->events ^= EVENT(kind, channel);
    return 1;
}

/* Records the end of a connection. */
static void end(XBeeATEndpoint* self, int channel) {
    if (channel == XBEE_OWN_CHANNEL)
        self->ownOpen = 0;
}

int XBeeATEndpoint_onMessage(void* context, int channel, const U8* data, U32 size) {
    XBeeATEndpoint* self = context;
    /* The events OPENED and CLOSED are delivered before messages. A message is therefore only
     * accepted while no other event is pending. */
    if (!self->buffer || self->events)
        return 1;
    memcpy(self->buffer, data, size);
    self->buffer = 0;
    self->size = (Ice_Int)size;
    self->from = (Ice_Byte)channel;
    self->events |= 1U;
    return 0;
}

void XBeeATEndpoint_onChannel(void* context, int channel, int isOpen) {
    XBeeATEndpoint* self = context;
    if (channel == XBEE_OWN_CHANNEL && isOpen)
        return;
    if (!isOpen)
        end(self, channel);
    /* If OPENED is still pending when the channel closes, neither OPENED nor CLOSED is delivered.
     * For each channel, at most one CLOSED and one later OPENED are therefore pending, even if the
     * ground station restarts often. */
    if (isOpen || !cancel(self, ICE_EVENT_OPENED, channel))
        self->events |= EVENT(isOpen ? ICE_EVENT_OPENED : ICE_EVENT_CLOSED, channel);
}

/* Waits for one event. The link may write to `buffer` only during this wait; at other times the
 * link keeps messages. */
static Ice_Status receive(void* context, Ice_Byte* buffer, Ice_Int timeoutMs, Ice_Event* event) {
    XBeeATEndpoint* self = context;
    U32 first = 0;
    if (!self->events) {
        self->buffer = buffer;
        (void)self->port->wait(self->context, timeoutMs);
        self->buffer = 0;
    }
    if (self->events) {
        while (!(self->events >> first & 1U))
            ++first;
        self->events &= self->events - 1U; /* removes the lowest pending event */
        first = first ? first + LINK_CHANNELS - 1U : self->from;
        event->kind = (Ice_EventKind)(ICE_EVENT_MESSAGE + first / LINK_CHANNELS);
        event->connection = (int)(first % LINK_CHANNELS);
        event->size = self->size;
    }
    return ICE_OK;
}

/* Opens this side's channel. */
static Link_Status openOwn(XBeeATEndpoint* self) {
    Link_Status status = LINK_OK;
    if (!self->ownOpen) {
        status = Link_openChannel(self->link, XBEE_OWN_CHANNEL);
        /* an event CLOSED that is still pending belongs to the previous connection, so it is
         * cancelled */
        if (status == LINK_OK) {
            self->ownOpen = 1;
            self->events &= ~EVENT(ICE_EVENT_CLOSED, XBEE_OWN_CHANNEL);
        }
    }
    return status;
}

/* Sends a message; without a message, opens this side's channel. Tries again while the link has no
 * room. */
static Ice_Status offer(XBeeATEndpoint* self, int channel, const Ice_Byte* message, Ice_Int size) {
    Link_Status status;
    int tries = 0;
    for (;;) {
        if (!message)
            status = openOwn(self);
        else if (self->events & EVENT(ICE_EVENT_CLOSED, channel))
            status = LINK_CLOSED;
        else
            status = Link_send(self->link, channel, message, (U32)size, 0);
        if (status != LINK_FULL || tries++ == RETRIES)
            break;
        (void)self->port->wait(self->context, 20);
    }
    return status == LINK_OK ? ICE_OK : status == LINK_TOO_LONG ? ICE_LIMIT : ICE_CONNECTION_LOST;
}

static Ice_Status sendMessage(void* context, int channel, const Ice_Byte* message, Ice_Int size) {
    return offer(context, channel, message, size);
}

static Ice_Status connectTo(void* context, const Ice_Byte* encoded, Ice_Int size, int* connection) {
    if (size < 2 || encoded[0] != head[0] || encoded[1] != head[1])
        return ICE_NO_ENDPOINT;
    *connection = XBEE_OWN_CHANNEL;
    return offer(context, 0, 0, 0);
}

static void closeChannel(void* context, int channel) {
    XBeeATEndpoint* self = context;
    /* The ground station may have closed the channel already. The channel may then belong to a new
     * connection and must stay open. */
    if (!cancel(self, ICE_EVENT_CLOSED, channel)) {
        (void)Link_closeChannel(self->link, channel);
        end(self, channel);
    }
}

static Ice_Status listenTo(void* context, const char* options) {
    (void)context;
    (void)options; /* the radio always receives, so there is nothing to do */
    return ICE_OK;
}

static void encode(void* context, const char* options, Ice_OutputStreamPtr os) {
    XBeeATEndpoint* self = context;
    const U32 address = options ? Ice_numberOption(options, 'a', 0) : self->address;
    Ice_OutputStream_writeBlob(os, head, HEAD);
    Ice_OutputStream_writeShort(os, (Ice_Short)address);
    Ice_OutputStream_writeByte(os, (Ice_Byte)Ice_numberOption(options, 'p', 255));
    Ice_OutputStream_writeInt(os, (Ice_Int)Ice_numberOption(options, 't', 10000));
}

static U32 nowMs(void* context) {
    XBeeATEndpoint* self = context;
    return self->port->nowMs(self->context);
}

static void wakeUp(void* context) {
    (void)context; /* there is only one task, so no task waits */
}

void XBeeATEndpoint_init(Ice_CommunicatorPtr ic, const char* name, XBeeATEndpoint* self, Link* link,
                         U16 address, const XBeeATEndpoint_Port* port, void* context) {
    static const Ice_Endpoint endpoint = {"xbee-at", receive, sendMessage, connectTo, closeChannel,
                                          listenTo,  encode,  wakeUp,      nowMs,     0};
    (void)name;
    memset(self, 0, sizeof *self);
    self->link = link;
    self->address = address;
    self->port = port;
    self->context = context;
    Ice_Communicator_setEndpoint(ic, &endpoint, self);
}
