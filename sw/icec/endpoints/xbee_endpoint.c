/* SPDX-License-Identifier: MIT
 *
 * xbee_endpoint: passes messages between IceC's tasks and the link, which runs in the radio task.
 */
#include "xbee_endpoint.h"

#include "ice_message.h"
#include "xbee_peers.h"

#include <string.h>

#define NOBODY 255
#define HEAD 8
#define BODY 7
/* Number of attempts to send while the link has no room, 20 ms apart: 20 s in total. This is less
 * than 27 s (LINK_AGE_LAST): a fragment that is not acknowledged for this time ends the session and
 * all its connections. Two replies of 8 KB take 4 s if three of ten packets are lost. */
#define RETRIES 1000
/* number of attempts to send to a peer other than the first ground station; smaller than RETRIES,
 * because messages to the first ground station wait during these attempts */
#define OTHER_RETRIES 100

/* Beginning of an encoded endpoint: type, encapsulation of 13 bytes, encoding 1.1. */
static const Ice_Byte head[HEAD] = {
    XBEE_ENDPOINT_TYPE & 0xFF, XBEE_ENDPOINT_TYPE >> 8, 6 + BODY, 0, 0, 0, 1, 1};

/* Bit of a pending event in `events`. The event with the lowest bit is delivered first. Bit 0 is
 * the event of a message. */
#define EVENT(kind, channel) \
    (2U << (((U32)(kind) - ICE_EVENT_CLOSED) * XBEE_CONNECTIONS + (U32)(channel)))

/* Peer of a connection, and channel of the connection on this peer's link. */
#define PEER_OF(connection) ((int)((U32)(connection) / LINK_CHANNELS))
#define CHANNEL_OF(connection) ((int)((U32)(connection) % LINK_CHANNELS))

static int isOwnOpen(const XBeeATEndpoint* self, int peer) {
    return self->ownOpen >> peer & 1;
}

static void setOwnOpen(XBeeATEndpoint* self, int peer, int isOpen) {
    self->ownOpen = (Ice_Byte)((self->ownOpen & ~(1 << peer)) | isOpen << peer);
}

static int isOwn(const XBeeATEndpoint* self, int connection) {
    return connection == self->own[PEER_OF(connection)];
}

/* Records whether the link keeps a message that could not be delivered. Returns the previous
 * value. */
static int setHeld(XBeeATEndpoint* self, Ice_Byte held) {
    const int before = self->held;
    if (held != before)
        self->held = held;
    return before;
}

static void lock(XBeeATEndpoint* self) {
    self->port->lock(self->context);
}

static void unlock(XBeeATEndpoint* self) {
    self->port->unlock(self->context);
}

static void report(XBeeATEndpoint* self, U32 events) {
    self->events |= events;
    self->port->signal(self->context);
}

/* Cancels a pending event. Returns 1 if the event was still pending. */
static int cancel(XBeeATEndpoint* self, Ice_EventKind kind, int channel) {
    if (!(self->events & EVENT(kind, channel)))
        return 0;
    self->events ^= EVENT(kind, channel);
    return 1;
}

/* Records the end of a connection. Nothing more may be sent on the connection, because its channel
 * may soon belong to another connection. */
static void end(XBeeATEndpoint* self, int channel) {
    if (isOwn(self, channel)) {
        setOwnOpen(self, PEER_OF(channel), 0);
        (void)XBeePeers_setDialed(self, PEER_OF(channel), 0);
    }
    if (self->offered == channel)
        self->offered = NOBODY;
}

int XBeeATEndpoint_onMessage(void* context, int channel, const U8* data, U32 size) {
    XBeeATEndpoint* self = context;
    /* The events OPENED and CLOSED are delivered before messages. A message is therefore only
     * accepted while no other event is pending. */
    if (!self->buffer || self->events) {
        (void)setHeld(self, 1);
        return 1;
    }
    memcpy(self->buffer, data, size);
    self->buffer = 0;
    self->size = (Ice_Int)size;
    self->from = (Ice_Byte)channel;
    report(self, 1U);
    return 0;
}

void XBeeATEndpoint_onChannel(void* context, int channel, int isOpen) {
    XBeeATEndpoint* self = context;
    if (isOwn(self, channel)) {
        if (isOpen)
            return;
        if (XBeePeers_isDialedOn(self, PEER_OF(channel))) {
            setOwnOpen(self, PEER_OF(channel), 0);
            return;
        }
    }
    if (!isOpen)
        end(self, channel);
    /* If OPENED is still pending when the channel closes, neither OPENED nor CLOSED is delivered.
     * For each channel, at most one CLOSED and one later OPENED are therefore pending, even if the
     * ground station restarts often. */
    if (isOpen || !cancel(self, ICE_EVENT_OPENED, channel))
        report(self, EVENT(isOpen ? ICE_EVENT_OPENED : ICE_EVENT_CLOSED, channel));
}

/* Waits for one event. The link may write to `buffer` only during this wait; at other times the
 * link keeps messages. */
static Ice_Status receive(void* context, Ice_Byte* buffer, Ice_Int timeoutMs, Ice_Event* event) {
    XBeeATEndpoint* self = context;
    U32 first = 0;
    lock(self);
    if (!self->events) {
        int held = setHeld(self, 0);
        self->buffer = buffer;
        unlock(self);
        if (held)
            self->port->kick(self->context);
        (void)self->port->wait(self->context, timeoutMs);
        lock(self);
        self->buffer = 0;
    }
    if (self->events) {
        while (!(self->events >> first & 1U))
            ++first;
        self->events &= self->events - 1U; /* removes the lowest pending event */
        first = first ? first + XBEE_CONNECTIONS - 1U : self->from;
        event->kind = (Ice_EventKind)(ICE_EVENT_MESSAGE + first / XBEE_CONNECTIONS);
        event->connection = (int)(first % XBEE_CONNECTIONS);
        event->size = self->size;
    }
    unlock(self);
    return ICE_OK;
}

/* Opens this side's channel to a peer. If the peer is a vehicle without a session, dials the
 * vehicle; the channel is then opened later, and the first message of the vehicle ends the caller's
 * wait. */
static Link_Status openOwn(XBeeATEndpoint* self, int peer) {
    Link_Status status = LINK_OK;
    const int own = self->own[peer];
    if (!isOwnOpen(self, peer)) {
        status = Link_openChannel(self->links[peer], CHANNEL_OF(own));
        /* an event CLOSED that is still pending belongs to the previous connection, so it is
         * cancelled */
        if (status == LINK_OK) {
            setOwnOpen(self, peer, 1);
            self->events &= ~EVENT(ICE_EVENT_CLOSED, own);
        }
        if (status == LINK_DOWN && XBeePeers_setDialed(self, peer, 1))
            status = LINK_OK;
    }
    return status;
}

void XBeeATEndpoint_dial(XBeeATEndpoint* self, int peer, U32 nowUs) {
    Link* link = self->links[peer];
    const Link_State state = Link_state(link);
    const U32 tookMs = self->port->nowMs(self->context) - self->dialedAt[peer];
    if (tookMs >= (U32)ICE_TIMEOUT_MS)
        (void)XBeePeers_setDialed(self, peer, 0);
    if (self->dialed >> peer & 1) {
        if (state == LINK_STATE_UP)
            (void)openOwn(self, peer);
        Link_start(link, nowUs);
    } else if (state == LINK_STATE_CONNECTING) {
        Link_stop(link, nowUs);
    }
}

/* Returns whether the connection of the message that is being sent has ended. The receiving task
 * may not know this yet, and the channel may already belong to another connection. */
static int hasEnded(const XBeeATEndpoint* self, int connection) {
    return (self->events & EVENT(ICE_EVENT_CLOSED, connection)) || self->offered != connection;
}

/* Ends a connection because the link has no room for a message of this connection. */
static void giveUp(XBeeATEndpoint* self, int connection) {
    (void)Link_closeChannel(self->links[PEER_OF(connection)], CHANNEL_OF(connection));
    XBeeATEndpoint_onChannel(self, connection, 0);
}

static int mostTries(int connection) {
    return PEER_OF(connection) ? OTHER_RETRIES : RETRIES;
}

/* Sends a message; without a message, opens this side's channel. Tries again while the link has no
 * room. If the last attempt fails, ends the connection; the link then informs the peer. */
static Ice_Status offer(XBeeATEndpoint* self, int connection, const Ice_Byte* message,
                        Ice_Int size) {
    Link_Status status;
    int tries = 0;
    lock(self);
    if (message)
        /* only one message at a time is being sent, because the caller holds ICE_LOCK_SEND */
        self->offered = (Ice_Byte)connection;
    for (;;) {
        if (!message)
            status = openOwn(self, PEER_OF(connection));
        else if (hasEnded(self, connection))
            status = LINK_CLOSED;
        else
            status = Link_send(self->links[PEER_OF(connection)], CHANNEL_OF(connection), message,
                               (U32)size, 0);
        if (status == LINK_FULL && message && tries == mostTries(connection))
            giveUp(self, connection);
        unlock(self);
        self->port->kick(self->context);
        if (status != LINK_FULL || tries++ == mostTries(connection))
            break;
        (void)self->port->wait(self->context, 20);
        lock(self);
    }
    /* The waits above may have consumed a signal for the receiving task, so the signal is sent
     * again. */
    if (tries)
        self->port->signal(self->context);
    return status == LINK_OK ? ICE_OK : status == LINK_TOO_LONG ? ICE_LIMIT : ICE_CONNECTION_LOST;
}

static Ice_Status sendMessage(void* context, int connection, const Ice_Byte* message,
                              Ice_Int size) {
    return offer(context, connection, message, size);
}

/* Returns the peer with the address in an encoded endpoint; -1 if no such peer exists. */
static int peerOf(const XBeeATEndpoint* self, const Ice_Byte* encoded, Ice_Int size) {
    if (size < HEAD + 2)
        return 0;
    return XBeePeers_find(self, (U16)(encoded[HEAD] | encoded[HEAD + 1] << 8));
}

static Ice_Status connectTo(void* context, const Ice_Byte* encoded, Ice_Int size, int* connection) {
    XBeeATEndpoint* self = context;
    const int peer = peerOf(self, encoded, size);
    if (size < 2 || encoded[0] != head[0] || encoded[1] != head[1] || peer < 0)
        return ICE_NO_ENDPOINT;
    *connection = self->own[peer];
    /* `offer` opens the channel, and tries again while the previous connection is still being
     * closed */
    return offer(self, *connection, 0, 0);
}

static void closeChannel(void* context, int connection) {
    XBeeATEndpoint* self = context;
    lock(self);
    /* The peer may have closed the connection already. The channel may then belong to a new
     * connection and must stay open. */
    if (!cancel(self, ICE_EVENT_CLOSED, connection)) {
        (void)Link_closeChannel(self->links[PEER_OF(connection)], CHANNEL_OF(connection));
        end(self, connection);
    }
    unlock(self);
    self->port->kick(self->context);
}

static Ice_Status listenTo(void* context, const char* options) {
    (void)context;
    (void)options; /* the radio always receives, so there is nothing to do */
    return ICE_OK;
}

static void encode(void* context, const char* options, Ice_OutputStreamPtr os) {
    XBeeATEndpoint* self = context;
    U32 address = options ? Ice_numberOption(options, 'a', 0) : self->address;
    if (options && (!Ice_areOptions(options, "apt") || address > 0xFFFFU ||
                    Ice_numberOption(options, 'p', 255) > 255U ||
                    Ice_numberOption(options, 't', 0) > 0x7FFFFFFFU))
        os->failed = ICE_FAILED_MALFORMED;
    Ice_OutputStream_writeBlob(os, head, HEAD);
    Ice_OutputStream_writeShort(os, (Ice_Short)address);
    Ice_OutputStream_writeByte(os, (Ice_Byte)Ice_numberOption(options, 'p', 255));
    Ice_OutputStream_writeInt(os, (Ice_Int)Ice_numberOption(options, 't', 10000));
}

static Ice_Bool print(void* context, const Ice_Byte* encoded, Ice_Int size,
                      Ice_OutputStreamPtr text) {
    Ice_InputStream is;
    Ice_Byte channel;
    (void)context;
    Ice_InputStream_init(&is, encoded, size);
    if (Ice_InputStream_readShort(&is) != XBEE_ENDPOINT_TYPE || size != HEAD + BODY)
        return 0;
    is.position = HEAD;
    icec_put(text, "xbee-at -a ");
    icec_putNumber(text, (U16)Ice_InputStream_readShort(&is));
    channel = Ice_InputStream_readByte(&is);
    if (channel != 255) {
        icec_put(text, " -p ");
        icec_putNumber(text, channel);
    }
    icec_put(text, " -t ");
    icec_putNumber(text, (U32)Ice_InputStream_readInt(&is));
    return 1;
}

Ice_Status XBeeATEndpoint_makeProxy(Ice_ObjectAdapterPtr adapter, const char* identity, U16 address,
                                    Ice_ObjectPrxPtr prx) {
    const Ice_Status status = Ice_ObjectAdapter_createProxy(adapter, identity, prx);
    /* endpoints[0] is the number of endpoints: 1. The encoded endpoint follows; its address is
     * after `head`. */
    prx->endpoints[1 + HEAD] = (Ice_Byte)address;
    prx->endpoints[2 + HEAD] = (Ice_Byte)(address >> 8);
    return status;
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
                         U16 address, const XBeeATEndpoint_Port* port, void* context) {
    static const Ice_Endpoint endpoint = {"xbee-at", receive, sendMessage, connectTo, closeChannel,
                                          listenTo,  encode,  wakeUp,      nowMs,     print};
    (void)name;
    memset(self, 0, sizeof *self);
    self->links[0] = link;
    self->own[0] = XBEE_OWN_CHANNEL;
    self->address = address;
    self->port = port;
    self->context = context;
    Ice_Communicator_setEndpoint(ic, &endpoint, self);
}
