/* SPDX-License-Identifier: MIT
 *
 * tcp_endpoint: sockets, cut into IceP messages by the size in their heads.
 */
#define _POSIX_C_SOURCE 200809L
#include "tcp_endpoint.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <poll.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/socket.h>
#include <unistd.h>

static int freeSlot(TcpEndpoint *self) {
    int c;
    for (c = 0; c < ICE_CONNECTIONS; ++c)
        if (self->connections[c].fd < 0)
            return c;
    return -1;
}

static void closeOne(void *context, int connection) {
    TcpEndpoint *self = context;
    TcpConnection *c = &self->connections[connection];
    if (c->fd >= 0)
        (void)close(c->fd);
    c->fd = -1;
    c->have = 0;
}

static void use(TcpConnection *c, int fd, Ice_Byte accepted) {
    c->fd = fd;
    c->accepted = accepted;
    c->told = !accepted;
    c->have = 0;
}

/* Size of the message at the front; 0: not whole yet, -1: it is none, or too long. */
static Ice_Int frontSize(const TcpConnection *c) {
    Ice_InputStream is;
    Ice_Int size;
    if (c->have < 14)
        return 0;
    Ice_InputStream_init(&is, c->data + 10, 4);
    size = Ice_InputStream_readInt(&is);
    if (memcmp(c->data, "IceP", 4) != 0 || size < 14 || size > ICE_MESSAGE_MAX)
        return -1;
    return size <= c->have ? size : 0;
}

/* One event that needs no waiting. 1: there was one. */
static int ready(TcpEndpoint *self, Ice_Byte *buffer, Ice_Event *event) {
    int i;
    for (i = 0; i < ICE_CONNECTIONS; ++i) {
        TcpConnection *c = &self->connections[i];
        Ice_Int size;
        event->connection = i;
        if (c->fd < 0)
            continue;
        if (!c->told) {
            c->told = 1;
            event->kind = ICE_EVENT_OPENED;
            return 1;
        }
        size = frontSize(c);
        if (size < 0) {
            closeOne(self, i);
            event->kind = ICE_EVENT_CLOSED;
            return 1;
        }
        if (size > 0) {
            memcpy(buffer, c->data, (size_t)size);
            memmove(c->data, c->data + size, (size_t)(c->have - size));
            c->have -= size;
            event->kind = ICE_EVENT_MESSAGE;
            event->size = size;
            return 1;
        }
    }
    return 0;
}

static Ice_Status receive(void *context, Ice_Byte *buffer, Ice_Int timeoutMs, Ice_Event *event) {
    TcpEndpoint *self = context;
    struct pollfd fds[ICE_CONNECTIONS + 2];
    int i, slot;
    if (ready(self, buffer, event))
        return ICE_OK;
    for (i = 0; i < ICE_CONNECTIONS; ++i) {
        fds[i].fd = self->connections[i].fd;
        fds[i].events = POLLIN;
    }
    fds[ICE_CONNECTIONS].fd = freeSlot(self) >= 0 ? self->listener : -1;
    fds[ICE_CONNECTIONS].events = POLLIN;
    fds[ICE_CONNECTIONS + 1].fd = self->pipe[0];
    fds[ICE_CONNECTIONS + 1].events = POLLIN;
    if (poll(fds, ICE_CONNECTIONS + 2, timeoutMs) <= 0)
        return ICE_OK;
    if (fds[ICE_CONNECTIONS + 1].revents) {
        char byte;
        (void)!read(self->pipe[0], &byte, 1);
    }
    if (fds[ICE_CONNECTIONS].revents & POLLIN) {
        int fd = accept(self->listener, 0, 0);
        slot = freeSlot(self);
        if (fd >= 0 && slot >= 0)
            use(&self->connections[slot], fd, 1);
    }
    for (i = 0; i < ICE_CONNECTIONS; ++i) {
        TcpConnection *c = &self->connections[i];
        long got;
        if (c->fd < 0 || c->fd != fds[i].fd || !fds[i].revents)
            continue;
        got = (long)recv(c->fd, c->data + c->have, (size_t)(ICE_MESSAGE_MAX - c->have), 0);
        if (got <= 0) {
            closeOne(self, i);
            event->kind = ICE_EVENT_CLOSED;
            event->connection = i;
            return ICE_OK;
        }
        c->have += (Ice_Int)got;
    }
    (void)ready(self, buffer, event);
    return ICE_OK;
}

static Ice_Status sendAll(void *context, int connection, const Ice_Byte *message, Ice_Int size) {
    TcpEndpoint *self = context;
    int fd = self->connections[connection].fd;
    while (size > 0 && fd >= 0) {
        long sent = (long)send(fd, message, (size_t)size, MSG_NOSIGNAL);
        if (sent <= 0) {
            closeOne(self, connection);
            return ICE_CONNECTION_LOST;
        }
        message += sent;
        size -= (Ice_Int)sent;
    }
    return fd >= 0 ? ICE_OK : ICE_CONNECTION_LOST;
}

/* One connection a peer is kept and used again. */
static Ice_Status connectTo(void *context, const Ice_Byte *encoded, Ice_Int size, int *connection) {
    TcpEndpoint *self = context;
    struct sockaddr_in to, other;
    Ice_InputStream is;
    Ice_String host;
    char text[64];
    int slot, fd;
    socklen_t length;
    Ice_InputStream_init(&is, encoded, size);
    if (Ice_InputStream_readShort(&is) != TCP_ENDPOINT_TYPE)
        return ICE_NO_ENDPOINT;
    (void)Ice_InputStream_readBlob(&is, 6);
    host = Ice_InputStream_readString(&is);
    memset(&to, 0, sizeof to);
    to.sin_family = AF_INET;
    to.sin_port = htons((U16)Ice_InputStream_readInt(&is));
    if (is.failed || host.size >= (Ice_Int)sizeof text)
        return ICE_NO_ENDPOINT;
    memcpy(text, host.data, (size_t)host.size);
    text[host.size] = 0;
    if (inet_pton(AF_INET, text, &to.sin_addr) != 1)
        return ICE_NO_ENDPOINT;
    for (slot = 0; slot < ICE_CONNECTIONS; ++slot) {
        TcpConnection *c = &self->connections[slot];
        length = sizeof other;
        if (c->fd >= 0 && !c->accepted && getpeername(c->fd, (struct sockaddr *)&other, &length) == 0 &&
            other.sin_port == to.sin_port && other.sin_addr.s_addr == to.sin_addr.s_addr) {
            *connection = slot;
            return ICE_OK;
        }
    }
    slot = freeSlot(self);
    if (slot < 0)
        return ICE_LIMIT;
    fd = socket(AF_INET, SOCK_STREAM, 0);
    if (fd < 0 || connect(fd, (struct sockaddr *)&to, sizeof to) != 0) {
        if (fd >= 0)
            (void)close(fd);
        return ICE_CONNECTION_LOST;
    }
    use(&self->connections[slot], fd, 0);
    *connection = slot;
    return ICE_OK;
}

static const char *value(const char *options, const char *flag) {
    const char *at = options ? strstr(options, flag) : 0;
    return at ? at + strlen(flag) : 0;
}

static Ice_Status listenTo(void *context, const char *options) {
    TcpEndpoint *self = context;
    const char *port = value(options, "-p ");
    struct sockaddr_in at;
    socklen_t length = sizeof at;
    int on = 1;
    memset(&at, 0, sizeof at);
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    at.sin_port = htons((U16)(port ? atoi(port) : 0));
    self->listener = socket(AF_INET, SOCK_STREAM, 0);
    if (self->listener < 0)
        return ICE_NO_ENDPOINT;
    (void)setsockopt(self->listener, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    if (bind(self->listener, (struct sockaddr *)&at, sizeof at) != 0 || listen(self->listener, 4) != 0 ||
        getsockname(self->listener, (struct sockaddr *)&at, &length) != 0)
        return ICE_NO_ENDPOINT;
    self->port = ntohs(at.sin_port);
    return ICE_OK;
}

static void encode(void *context, const char *options, Ice_OutputStreamPtr os) {
    TcpEndpoint *self = context;
    const char *host = value(options, "-h ");
    const char *port = value(options, "-p ");
    Ice_String name = Ice_String_from(host ? host : "127.0.0.1");
    if (host)
        name.size = (Ice_Int)strcspn(host, " ");
    Ice_OutputStream_writeShort(os, TCP_ENDPOINT_TYPE);
    Ice_OutputStream_writeInt(os, 6 + 1 + name.size + 9);
    Ice_OutputStream_writeByte(os, 1);
    Ice_OutputStream_writeByte(os, 1);
    Ice_OutputStream_writeString(os, name);
    Ice_OutputStream_writeInt(os, port ? atoi(port) : self->port);
    Ice_OutputStream_writeInt(os, 60000);
    Ice_OutputStream_writeBool(os, 0);
}

static void wakeUp(void *context) {
    TcpEndpoint *self = context;
    (void)!write(self->pipe[1], "", 1);
}

Ice_Status TcpEndpoint_init(Ice_CommunicatorPtr ic, TcpEndpoint *self) {
    static const Ice_Endpoint endpoint = {"tcp", receive, sendAll, connectTo, closeOne, listenTo, encode, wakeUp};
    int c;
    memset(self, 0, sizeof *self);
    self->listener = -1;
    for (c = 0; c < ICE_CONNECTIONS; ++c)
        self->connections[c].fd = -1;
    if (pipe(self->pipe) != 0)
        return ICE_NO_ENDPOINT;
    Ice_Communicator_setEndpoint(ic, &endpoint, self);
    return ICE_OK;
}

void TcpEndpoint_destroy(TcpEndpoint *self) {
    int c;
    for (c = 0; c < ICE_CONNECTIONS; ++c)
        closeOne(self, c);
    if (self->listener >= 0)
        (void)close(self->listener);
    (void)close(self->pipe[0]);
    (void)close(self->pipe[1]);
}
