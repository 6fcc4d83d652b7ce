/* SPDX-License-Identifier: MIT
 *
 * xbee_endpoint: messages between IceC's tasks and the radio task's link.
 */
#include "xbee_endpoint.h"

#include "ice_message.h"

#include <string.h>

#define NOBODY 255
#define HEAD 8
#define BODY 7
/* Retries while the link has no room, 20 ms apart, for 20 s: 27 s after a fragment that no peer
 * takes, the session ends, and with it every other connection. Two replies of 8 KB take 4 s with a
 * loss of 30 %. */
#define RETRIES 1000
#define OTHER_RETRIES 100 /* for another ground station, because the first one waits for it */

/* The head of an encoded endpoint: type, 13 bytes of encapsulation, encoding 1.1. */
static const Ice_Byte head[HEAD] = {
    XBEE_ENDPOINT_TYPE & 0xFF, XBEE_ENDPOINT_TYPE >> 8, 6 + BODY, 0, 0, 0, 1, 1};

/* Pending events, one bit each, delivered lowest bit first: a message has bit 0. */
#define EVENT(kind, channel) \
    (2U << (((U32)(kind) - ICE_EVENT_CLOSED) * XBEE_CONNECTIONS + (U32)(channel)))

/* A connection's ground and its channel there; a ground's connection that this side opens. */
#define GROUND_OF(connection) (XBEE_PEERS > 1 ? (int)((U32)(connection) / LINK_CHANNELS) : 0)
#define CHANNEL_OF(connection) \
    (XBEE_PEERS > 1 ? (int)((U32)(connection) % LINK_CHANNELS) : (connection))
static int isOwnOpen(const XBeeATEndpoint* self, int ground) {
    return XBEE_PEERS > 1 ? self->ownOpen >> ground & 1 : self->ownOpen;
}

static void setOwnOpen(XBeeATEndpoint* self, int ground, int isOpen) {
    const int others = XBEE_PEERS > 1 ? self->ownOpen & ~(1 << ground) : 0;
    self->ownOpen = (Ice_Byte)(XBEE_PEERS > 1 ? others | isOpen << ground : isOpen);
}

#if XBEE_PEERS > 1
#define OWN_OF(self, ground) ((self)->own[ground])

/* Starts or stops connecting to a vehicle. Returns 0 for a ground station, which is never
 * dialled. */
static int setSought(XBeeATEndpoint* self, int ground, int isSought) {
    const int bit = isSought ? self->vehicles & 1 << ground : 0;
    self->sought = (Ice_Byte)((self->sought & ~(1 << ground)) | bit);
    self->soughtAt[ground] = self->port->nowMs(self->context);
    self->seen[ground] = Link_statistics(self->links[ground])->messagesReceived;
    return bit;
}

/* Returns 1 if a vehicle's session has ended before any message arrived in it, as when both sides
 * have begun one: dialling continues, and no task is informed. */
static int isSoughtOn(XBeeATEndpoint* self, int ground) {
    const Link* link = self->links[ground];
    if (!(self->sought >> ground & 1) || Link_state(link) == LINK_STATE_UP ||
        Link_statistics(link)->messagesReceived != self->seen[ground])
        return 0;
    setOwnOpen(self, ground, 0);
    return 1;
}
#else
#define OWN_OF(self, ground) XBEE_OWN_CHANNEL
#define setSought(self, ground, isSought) 0
#define isSoughtOn(self, ground) 0
#endif

static int isOwn(const XBeeATEndpoint* self, int connection) {
    (void)self;
    return connection == OWN_OF(self, GROUND_OF(connection));
}

/* ---- several tasks ----
 * The minimal run time has one task, which polls the link while it waits, and needs none of this.
 */

/* Calls a function of the port. */
static void tell(XBeeATEndpoint* self, void (*function)(void* context)) {
    if (ICEC_FULL)
        function(self->context);
}

/* Records whether the link keeps a message that was not taken. Returns the previous state. */
static int setHeld(XBeeATEndpoint* self, Ice_Byte held) {
    int before = ICEC_FULL && self->held;
    if (ICEC_FULL && held != before)
        self->held = held;
    return before;
}

/* Records the connection of the message that is being sent: one at a time, under ICE_LOCK_SEND. */
static void setOffered(XBeeATEndpoint* self, int connection) {
    if (ICEC_FULL)
        self->offered = (Ice_Byte)connection;
}

static int isOffered(const XBeeATEndpoint* self, int connection) {
    return !ICEC_FULL || self->offered == connection;
}

static void lock(XBeeATEndpoint* self) {
    tell(self, self->port->lock);
}

static void unlock(XBeeATEndpoint* self) {
    tell(self, self->port->unlock);
}

static void report(XBeeATEndpoint* self, U32 events) {
    self->events |= events;
    tell(self, self->port->signal);
}

/* Withdraws a report. Returns 1 if it was not delivered yet. */
static int takeBack(XBeeATEndpoint* self, Ice_EventKind kind, int channel) {
    if (!(self->events & EVENT(kind, channel)))
        return 0;
    self->events ^= EVENT(kind, channel);
    return 1;
}

/* Records that a connection has ended: nothing more may be sent on its channel, which may soon
 * belong to another connection. */
static void end(XBeeATEndpoint* self, int channel) {
    if (isOwn(self, channel)) {
        setOwnOpen(self, GROUND_OF(channel), 0);
        (void)setSought(self, GROUND_OF(channel), 0);
    }
    if (isOffered(self, channel))
        setOffered(self, NOBODY);
}

int XBeeATEndpoint_onMessage(void* context, int channel, const U8* data, U32 size) {
    XBeeATEndpoint* self = context;
    /* Opening and closing come first, so no other event can be pending. */
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
    if (isOwn(self, channel) && (isOpen || isSoughtOn(self, GROUND_OF(channel))))
        return;
    if (!isOpen)
        end(self, channel);
    /* A closing withdraws an unseen opening, so at most a closing and then an opening wait for a
     * channel, however often the ground station restarts. */
    if (isOpen || !takeBack(self, ICE_EVENT_OPENED, channel))
        report(self, EVENT(isOpen ? ICE_EVENT_OPENED : ICE_EVENT_CLOSED, channel));
}

#if XBEE_PEERS > 1

void XBeeATEndpoint_addPeer(XBeeATEndpoint* self, int ground, Link* link, U16 address) {
    self->links[ground] = link;
    self->grounds[ground] = address;
    self->own[ground] = (Ice_Byte)(ground * LINK_CHANNELS + XBEE_OWN_CHANNEL);
}

void XBeeATEndpoint_setVehicle(XBeeATEndpoint* self, int ground, int isGround) {
    self->vehicles = (Ice_Byte)(self->vehicles | 1 << ground);
    if (isGround)
        self->own[ground] = (Ice_Byte)(ground * LINK_CHANNELS);
}

#endif

/* Waits for one event. Only during this wait may the link write `buffer`; otherwise the link keeps
 * messages. */
static Ice_Status receive(void* context, Ice_Byte* buffer, Ice_Int timeoutMs, Ice_Event* event) {
    XBeeATEndpoint* self = context;
    U32 first = 0;
    lock(self);
    if (!self->events) {
        int held = setHeld(self, 0);
        self->buffer = buffer;
        unlock(self);
        if (held)
            tell(self, self->port->kick);
        (void)self->port->wait(self->context, timeoutMs);
        lock(self);
        self->buffer = 0;
    }
    if (self->events) {
        while (!(self->events >> first & 1U))
            ++first;
        self->events &= self->events - 1U; /* without the lowest one */
        first = first ? first + XBEE_CONNECTIONS - 1U : self->from;
        event->kind = (Ice_EventKind)(ICE_EVENT_MESSAGE + first / XBEE_CONNECTIONS);
        event->connection = (int)(first % XBEE_CONNECTIONS);
        event->size = self->size;
    }
    unlock(self);
    return ICE_OK;
}

/* Opens the channel of this side to a ground station. A vehicle without a session is dialled, and
 * the channel opens later: its first message ends the caller's wait. */
static Link_Status openOwn(XBeeATEndpoint* self, int ground) {
    Link_Status status = LINK_OK;
    int own = OWN_OF(self, ground);
    if (!isOwnOpen(self, ground)) {
        status = Link_openChannel(self->links[ground], CHANNEL_OF(own));
        if (status == LINK_OK) { /* the end of the last connection is not the end of this one */
            setOwnOpen(self, ground, 1);
            self->events &= ~EVENT(ICE_EVENT_CLOSED, own);
        }
        if (status == LINK_DOWN && setSought(self, ground, 1))
            status = LINK_OK;
    }
    return status;
}

#if XBEE_PEERS > 1

void XBeeATEndpoint_seek(XBeeATEndpoint* self, int ground, U32 nowUs) {
    Link* link = self->links[ground];
    Link_State state = Link_state(link);
    const U32 tookMs = self->port->nowMs(self->context) - self->soughtAt[ground];
    if (tookMs >= (U32)ICE_TIMEOUT_MS)
        (void)setSought(self, ground, 0);
    if (self->sought >> ground & 1) {
        if (state == LINK_STATE_UP)
            (void)openOwn(self, ground);
        Link_start(link, nowUs);
    } else if (state == LINK_STATE_CONNECTING) {
        Link_stop(link, nowUs);
    }
}

#endif

/* Returns whether the connection of the offered message has ended, whether or not the receiver has
 * seen it: its channel may already belong to another one. */
static int hasEnded(const XBeeATEndpoint* self, int connection) {
    return (self->events & EVENT(ICE_EVENT_CLOSED, connection)) || !isOffered(self, connection);
}

/* Ends a connection if the link has no room for its message; in the minimal run time the caller may
 * retry. */
static void giveUp(XBeeATEndpoint* self, int connection) {
    if (ICEC_FULL) {
        (void)Link_closeChannel(self->links[GROUND_OF(connection)], CHANNEL_OF(connection));
        XBeeATEndpoint_onChannel(self, connection, 0);
    }
}

static int mostTries(int connection) {
    return GROUND_OF(connection) ? OTHER_RETRIES : RETRIES;
}

/* Sends a message, or opens the channel of this side (no message). Retries while the link has no
 * room; finally the connection ends, and the link informs the peer as soon as it can. */
static Ice_Status offer(XBeeATEndpoint* self, int connection, const Ice_Byte* message,
                        Ice_Int size) {
    Link_Status status;
    int tries = 0;
    lock(self);
    if (message)
        setOffered(self, connection);
    for (;;) {
        if (!message)
            status = openOwn(self, GROUND_OF(connection));
        else if (hasEnded(self, connection))
            status = LINK_CLOSED;
        else
            status = Link_send(self->links[GROUND_OF(connection)], CHANNEL_OF(connection), message,
                               (U32)size, 0);
        if (status == LINK_FULL && message && tries == mostTries(connection))
            giveUp(self, connection);
        unlock(self);
        tell(self, self->port->kick);
        if (status != LINK_FULL || tries++ == mostTries(connection))
            break;
        (void)self->port->wait(self->context, 20);
        lock(self);
    }
    /* A wait here may have taken an event that the receiver waits for. */
    if (tries)
        tell(self, self->port->signal);
    return status == LINK_OK ? ICE_OK : status == LINK_TOO_LONG ? ICE_LIMIT : ICE_CONNECTION_LOST;
}

static Ice_Status sendMessage(void* context, int connection, const Ice_Byte* message,
                              Ice_Int size) {
    return offer(context, connection, message, size);
}

/* Returns the ground station with the address in an encoded endpoint; -1 if there is none. */
static int groundOf(const XBeeATEndpoint* self, const Ice_Byte* encoded, Ice_Int size) {
    int ground = XBEE_PEERS - 1;
    if (size < HEAD + 2)
        return 0;
    while (ground >= 0 && (!self->links[ground] ||
                           self->grounds[ground] != (encoded[HEAD] | encoded[HEAD + 1] << 8)))
        --ground;
    return ground;
}

static Ice_Status connectTo(void* context, const Ice_Byte* encoded, Ice_Int size, int* connection) {
    int ground = XBEE_PEERS > 1 ? groundOf(context, encoded, size) : 0;
    if (size < 2 || encoded[0] != head[0] || encoded[1] != head[1] || ground < 0)
        return ICE_NO_ENDPOINT;
    *connection = OWN_OF((XBeeATEndpoint*)context, ground);
    /* The last closing may still be pending. */
    return offer(context, XBEE_PEERS > 1 ? *connection : 0, 0, 0);
}

static void closeChannel(void* context, int connection) {
    XBeeATEndpoint* self = context;
    lock(self);
    /* The peer may have closed already; the channel may already be a new one. */
    if (!takeBack(self, ICE_EVENT_CLOSED, connection)) {
        (void)Link_closeChannel(self->links[GROUND_OF(connection)], CHANNEL_OF(connection));
        end(self, connection);
    }
    unlock(self);
    tell(self, self->port->kick);
}

static Ice_Status listenTo(void* context, const char* options) {
    (void)context;
    (void)options; /* the radio is always open */
    return ICE_OK;
}

static void encode(void* context, const char* options, Ice_OutputStreamPtr os) {
    XBeeATEndpoint* self = context;
    U32 address = options ? Ice_numberOption(options, 'a', 0) : self->address;
    if (ICEC_FULL && options &&
        (!Ice_areOptions(options, "apt") || address > 0xFFFFU ||
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

static U32 nowMs(void* context) {
    XBeeATEndpoint* self = context;
    return self->port->nowMs(self->context);
}

static void wakeUp(void* context) {
    XBeeATEndpoint* self = context;
    tell(self, self->port->signal);
}

void XBeeATEndpoint_init(Ice_CommunicatorPtr ic, const char* name, XBeeATEndpoint* self, Link* link,
                         U16 address, const XBeeATEndpoint_Port* port, void* context) {
    static const Ice_Endpoint endpoint = {
        "xbee-at", receive, sendMessage, connectTo, closeChannel,
        listenTo,  encode,  wakeUp,      nowMs,     ICEC_FULL ? print : 0};
    (void)name;
    memset(self, 0, sizeof *self);
    self->links[0] = link;
#if XBEE_PEERS > 1
    self->own[0] = XBEE_OWN_CHANNEL;
#endif
    self->address = address;
    self->port = port;
    self->context = context;
    Ice_Communicator_setEndpoint(ic, &endpoint, self);
}
