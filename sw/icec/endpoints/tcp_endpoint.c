/* SPDX-License-Identifier: MIT
 *
 * tcp_endpoint: transports IceP messages over TCP sockets. The size in a message's header shows
 * where the message ends.
 */
#define _POSIX_C_SOURCE 200809L
#include "tcp_endpoint.h"
#include "ice_message.h"
#include "tcp_private.h"

#include <errno.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <poll.h>
#include <string.h>
#include <unistd.h>

static void lock(TcpEndpoint* self) {
    (void)pthread_mutex_lock(&self->lock);
}

static void unlock(TcpEndpoint* self) {
    (void)pthread_mutex_unlock(&self->lock);
}

/* Closes a connection; the caller holds the lock. If another task is sending on this connection,
 * only shuts the socket down; when the other task notices this, it frees the slot. */
static void closeOne(TcpEndpoint_Connection* c) {
    if (c->fd >= 0 && c->sending) {
        (void)shutdown(c->fd, SHUT_RDWR);
        c->over = 1;
        return;
    }
    if (c->fd >= 0)
        (void)close(c->fd);
    c->fd = -1;
    c->have = 0;
}

static void closeConnection(void* context, int connection) {
    TcpEndpoint* self = context;
    lock(self);
    closeOne(&self->connections[connection]);
    unlock(self);
}

static void wakeUp(void* context) {
    TcpEndpoint* self = context;
    (void)!write(self->pipe[1], "", 1);
}

static void use(TcpEndpoint_Connection* c, int fd, Ice_Byte accepted) {
    memset(c, 0, sizeof *c);
    c->fd = fd;
    c->accepted = accepted;
    c->reported = !accepted;
    c->usedMs = TcpEndpoint_nowMs(0);
    TcpEndpoint_tune(fd);
}

/* Returns the size of the first message in the buffer. Returns 0 if this message is incomplete, or
 * if it was refused and the connection continues. Returns -1 if the message is malformed, or if it
 * was refused and the connection must be closed. */
static Ice_Int frontSize(TcpEndpoint_Connection* c) {
    Ice_Int size;
    int isCompressed;
    if (c->have < ICEC_HEADER)
        return 0;
    size = icec_messageSize(c->data, &isCompressed);
    if (size < 0)
        return -1;
    if (size <= ICE_MESSAGE_MAX && !isCompressed)
        return size <= c->have ? size : 0;
    if (c->have < ICEC_HEADER + 4) /* the refusal needs the request id, which has not arrived yet */
        return 0;
    return TcpEndpoint_refuse(c, size) ? 0 : -1;
}

/* Fetches one event that has already occurred, without waiting. Returns 0 if none has. */
static int ready(TcpEndpoint* self, Ice_Byte* buffer, Ice_Event* event) {
    int i;
    for (i = 0; i < ICE_CONNECTIONS; ++i) {
        TcpEndpoint_Connection* c = &self->connections[i];
        Ice_Int size;
        event->connection = i;
        if (c->fd < 0 || c->over)
            continue;
        if (!c->reported) {
            c->reported = 1;
            event->kind = ICE_EVENT_OPENED;
            return 1;
        }
        size = frontSize(c);
        if (size < 0) {
            closeOne(c);
            event->kind = ICE_EVENT_CLOSED;
            return 1;
        }
        if (size > 0) {
            memcpy(buffer, c->data, (size_t)size);
            TcpEndpoint_note(c, buffer, size);
            memmove(c->data, c->data + size, (size_t)(c->have - size));
            c->have -= size;
            event->kind = ICE_EVENT_MESSAGE;
            event->size = size;
            return 1;
        }
    }
    return 0;
}

/* Accepts a connection; if no slot is free, closes another connection first. */
static void acceptOne(TcpEndpoint* self, Ice_Event* event) {
    int slot = TcpEndpoint_freeSlot(self), fd;
    Ice_Int left;
    if (slot < 0) {
        slot = TcpEndpoint_idlest(self, &left);
        if (slot < 0 || left > 0)
            return;
        TcpEndpoint_sendHead(&self->connections[slot], ICEC_CLOSE);
        closeOne(&self->connections[slot]);
        event->kind = ICE_EVENT_CLOSED;
        event->connection = slot;
        return;
    }
    fd = accept(self->listener, 0, 0);
    if (fd < 0)
        return;
    (void)fcntl(fd, F_SETFL, O_NONBLOCK);
    use(&self->connections[slot], fd, 1);
}

static void takeBytes(TcpEndpoint* self, int connection, Ice_Event* event) {
    TcpEndpoint_Connection* c = &self->connections[connection];
    Ice_Int room = ICE_MESSAGE_MAX - c->have;
    int skips = c->skip > 0;
    long got =
        (long)recv(c->fd, c->data + c->have, (size_t)(skips && c->skip < room ? c->skip : room), 0);
    if (got > 0 && skips)
        c->skip -= (Ice_Int)got;
    else if (got > 0)
        c->have += (Ice_Int)got;
    if (got > 0 || (got < 0 && (errno == EAGAIN || errno == EINTR)))
        return;
    closeOne(c);
    event->kind = ICE_EVENT_CLOSED;
    event->connection = connection;
}

static Ice_Status receive(void* context, Ice_Byte* buffer, Ice_Int timeoutMs, Ice_Event* event) {
    TcpEndpoint* self = context;
    struct pollfd fds[ICE_CONNECTIONS + 2];
    int i, is;
    lock(self);
    timeoutMs = TcpEndpoint_keepUp(self, timeoutMs);
    is = ready(self, buffer, event);
    for (i = 0; i < ICE_CONNECTIONS; ++i) {
        fds[i].fd = self->connections[i].over ? -1 : self->connections[i].fd;
        fds[i].events = POLLIN;
    }
    fds[ICE_CONNECTIONS].fd = TcpEndpoint_listenerFor(self, &timeoutMs);
    unlock(self);
    if (is)
        return ICE_OK;
    fds[ICE_CONNECTIONS].events = POLLIN;
    fds[ICE_CONNECTIONS + 1].fd = self->pipe[0];
    fds[ICE_CONNECTIONS + 1].events = POLLIN;
    if (poll(fds, ICE_CONNECTIONS + 2, timeoutMs) <= 0)
        return ICE_OK;
    if (fds[ICE_CONNECTIONS + 1].revents) {
        char byte;
        (void)!read(self->pipe[0], &byte, 1);
    }
    lock(self);
    event->kind = ICE_EVENT_NONE;
    if (fds[ICE_CONNECTIONS].revents & POLLIN)
        acceptOne(self, event);
    for (i = 0; i < ICE_CONNECTIONS && event->kind == ICE_EVENT_NONE; ++i)
        if (self->connections[i].fd == fds[i].fd && fds[i].fd >= 0 && fds[i].revents)
            takeBytes(self, i, event);
    if (event->kind == ICE_EVENT_NONE)
        (void)ready(self, buffer, event);
    unlock(self);
    return ICE_OK;
}

static Ice_Status sendAll(void* context, int connection, const Ice_Byte* message, Ice_Int size) {
    TcpEndpoint* self = context;
    TcpEndpoint_Connection* c = &self->connections[connection];
    int fd, ends;
    lock(self);
    fd = c->over ? -1 : c->fd;
    c->sending = fd >= 0;
    if (c->sending) {
        c->spoke = 1;
        TcpEndpoint_note(c, message, size);
    }
    unlock(self);
    if (fd < 0)
        return ICE_CONNECTION_LOST;
    size -= TcpEndpoint_sendSome(fd, message, size, self->sendMs);
    lock(self);
    c->sending = 0;
    c->sentMs = TcpEndpoint_nowMs(0);
    ends = size > 0 || c->over;
    if (c->over)
        closeOne(c);
    else if (ends)
        /* the receiving task then detects the end of the connection and reports the event */
        (void)shutdown(fd, SHUT_RDWR);
    unlock(self);
    return ends ? ICE_CONNECTION_LOST : ICE_OK;
}

/* Returns the number of an open connection that this side has made to this peer; -1 if there is
 * none. */
static int connectionTo(TcpEndpoint* self, const TcpEndpoint_Place* to) {
    int slot, found = -1;
    lock(self);
    for (slot = 0; slot < ICE_CONNECTIONS && found < 0; ++slot) {
        const TcpEndpoint_Connection* c = &self->connections[slot];
        if (c->fd >= 0 && !c->over && !c->accepted && c->peerSize == to->size &&
            memcmp(&c->peer, &to->at, to->size) == 0)
            found = slot;
    }
    unlock(self);
    return found;
}

/* Returns the open connection to this peer, or opens a connection. If a host name has several
 * addresses, tries them in order: the server may listen on only one of them, such as 127.0.0.1 if
 * localhost also means ::1. */
static Ice_Status connectTo(void* context, const Ice_Byte* encoded, Ice_Int size, int* connection) {
    TcpEndpoint* self = context;
    TcpEndpoint_Place places[TCP_PLACES];
    TcpEndpoint_Address address;
    int slot, count, turn, fd = -1;
    if (!TcpEndpoint_decode(encoded, size, &address))
        return ICE_NO_ENDPOINT;
    count = TcpEndpoint_resolve(&address, places);
    if (count == 0)
        return ICE_NO_ENDPOINT;
    *connection = -1;
    for (turn = 0; *connection < 0 && turn < count; ++turn)
        *connection = connectionTo(self, &places[turn]);
    if (*connection >= 0)
        return ICE_OK;
    lock(self);
    slot = TcpEndpoint_freeSlot(self);
    unlock(self);
    if (slot < 0)
        return ICE_LIMIT;
    for (turn = 0; fd < 0 && turn < count; ++turn)
        fd = TcpEndpoint_open(&places[turn], address.timeoutMs);
    if (fd < 0)
        return ICE_CONNECTION_LOST;
    lock(self);
    /* another task may have taken the free slot in the meantime */
    slot = TcpEndpoint_freeSlot(self);
    if (slot >= 0) {
        use(&self->connections[slot], fd, 0);
        self->connections[slot].peer = places[turn - 1].at;
        self->connections[slot].peerSize = places[turn - 1].size;
    } else {
        (void)close(fd);
    }
    unlock(self);
    *connection = slot;
    wakeUp(self); /* wakes the receiving task, which must also wait for the new connection */
    return slot >= 0 ? ICE_OK : ICE_LIMIT;
}

static void stopListening(TcpEndpoint* self) {
    lock(self);
    if (self->listener >= 0) {
        /* wakes the receiving task, which may be waiting for this socket */
        (void)shutdown(self->listener, SHUT_RDWR);
        (void)close(self->listener);
    }
    self->listener = -1;
    unlock(self);
}

static Ice_Status listenTo(void* context, const char* options) {
    TcpEndpoint* self = context;
    TcpEndpoint_Place places[TCP_PLACES], *at = &places[0];
    TcpEndpoint_Address here;
    int on = 1;
    if (!options) {
        stopListening(self);
        return ICE_OK;
    }
    if (self->listener >= 0)
        return ICE_LIMIT; /* a communicator can listen on only one port */
    if (!TcpEndpoint_readOptions(options, &here))
        return ICE_PARSE;
    if (!here.host.data)
        here.host = Ice_String_from("127.0.0.1");
    if (here.host.size >= (Ice_Int)sizeof self->host || !TcpEndpoint_resolve(&here, places))
        return ICE_NO_ENDPOINT;
    memcpy(self->host, here.host.data, (size_t)here.host.size);
    self->host[here.host.size] = 0;
    self->listener = socket(at->at.ss_family, SOCK_STREAM, 0);
    if (self->listener < 0)
        return ICE_NO_ENDPOINT;
    (void)setsockopt(self->listener, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    /* non-blocking: if a peer disconnects before accept is called, accept must return at once */
    (void)fcntl(self->listener, F_SETFL, O_NONBLOCK);
    if (bind(self->listener, (struct sockaddr*)&at->at, at->size) != 0 ||
        listen(self->listener, SOMAXCONN) != 0 ||
        getsockname(self->listener, (struct sockaddr*)&at->at, &at->size) != 0) {
        (void)close(self->listener);
        self->listener = -1;
        return ICE_NO_ENDPOINT;
    }
    self->port = ntohs(at->at.ss_family == AF_INET6 ? ((struct sockaddr_in6*)&at->at)->sin6_port
                                                    : ((struct sockaddr_in*)&at->at)->sin_port);
    return ICE_OK;
}

Ice_Status TcpEndpoint_init(Ice_CommunicatorPtr ic, TcpEndpoint* self) {
    static const Ice_Endpoint endpoint = {"tcp",
                                          receive,
                                          sendAll,
                                          connectTo,
                                          closeConnection,
                                          listenTo,
                                          TcpEndpoint_encode,
                                          wakeUp,
                                          TcpEndpoint_nowMs,
                                          TcpEndpoint_print};
    int c;
    memset(self, 0, sizeof *self);
    strcpy(self->host, "127.0.0.1");
    self->listener = -1;
    self->sendMs = 2000;
    self->heartbeatMs = ICE_HEARTBEAT_MS;
    self->idleMs = 1000;
    for (c = 0; c < ICE_CONNECTIONS; ++c)
        self->connections[c].fd = -1;
    if (pthread_mutex_init(&self->lock, 0) != 0 || pipe(self->pipe) != 0)
        return ICE_NO_ENDPOINT;
    Ice_Communicator_setEndpoint(ic, &endpoint, self);
    return ICE_OK;
}

void TcpEndpoint_destroy(TcpEndpoint* self) {
    int c;
    for (c = 0; c < ICE_CONNECTIONS; ++c)
        closeOne(&self->connections[c]);
    stopListening(self);
    (void)close(self->pipe[0]);
    (void)close(self->pipe[1]);
    (void)pthread_mutex_destroy(&self->lock);
}
