/* SPDX-License-Identifier: MIT
 *
 * tcp_endpoint: sockets, cut into IceP messages by the size in their heads.
 */
#define _POSIX_C_SOURCE 200809L
#include "tcp_endpoint.h"

#include <arpa/inet.h>
#include <errno.h>
#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <time.h>
#include <unistd.h>

static int freeSlot(TcpEndpoint* self) {
    int c;
    for (c = 0; c < ICE_CONNECTIONS; ++c)
        if (self->connections[c].fd < 0)
            return c;
    return -1;
}

static void lock(TcpEndpoint* self) {
    (void)pthread_mutex_lock(&self->lock);
}

static void unlock(TcpEndpoint* self) {
    (void)pthread_mutex_unlock(&self->lock);
}

/* Under the lock. Where a task is sending, the number stays taken until it has noticed. */
static void closeOne(TcpConnection* c) {
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

static void use(TcpConnection* c, int fd, Ice_Byte accepted) {
    c->fd = fd;
    c->accepted = accepted;
    c->told = !accepted;
    c->sending = c->over = 0;
    c->have = 0;
}

/* Size of the message at the front; 0: not whole yet, -1: it is none, or too long. */
static Ice_Int frontSize(const TcpConnection* c) {
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
static int ready(TcpEndpoint* self, Ice_Byte* buffer, Ice_Event* event) {
    int i;
    for (i = 0; i < ICE_CONNECTIONS; ++i) {
        TcpConnection* c = &self->connections[i];
        Ice_Int size;
        event->connection = i;
        if (c->fd < 0 || c->over)
            continue;
        if (!c->told) {
            c->told = 1;
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
            memmove(c->data, c->data + size, (size_t)(c->have - size));
            c->have -= size;
            event->kind = ICE_EVENT_MESSAGE;
            event->size = size;
            return 1;
        }
    }
    return 0;
}

static void acceptOne(TcpEndpoint* self) {
    int fd = accept(self->listener, 0, 0), slot = freeSlot(self);
    if (fd >= 0 && slot >= 0)
        use(&self->connections[slot], fd, 1);
    else if (fd >= 0)
        (void)close(fd); /* a task of ours has connected meanwhile and has the last number */
}

static void takeBytes(TcpEndpoint* self, int connection, Ice_Event* event) {
    TcpConnection* c = &self->connections[connection];
    long got = (long)recv(c->fd, c->data + c->have, (size_t)(ICE_MESSAGE_MAX - c->have), 0);
    if (got > 0) {
        c->have += (Ice_Int)got;
        return;
    }
    closeOne(c);
    event->kind = ICE_EVENT_CLOSED;
    event->connection = connection;
}

static Ice_Status receive(void* context, Ice_Byte* buffer, Ice_Int timeoutMs, Ice_Event* event) {
    TcpEndpoint* self = context;
    struct pollfd fds[ICE_CONNECTIONS + 2];
    int i, is;
    lock(self);
    is = ready(self, buffer, event);
    for (i = 0; i < ICE_CONNECTIONS; ++i) {
        fds[i].fd = self->connections[i].over ? -1 : self->connections[i].fd;
        fds[i].events = POLLIN;
    }
    fds[ICE_CONNECTIONS].fd = freeSlot(self) >= 0 ? self->listener : -1;
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
    if (fds[ICE_CONNECTIONS].revents & POLLIN)
        acceptOne(self);
    event->kind = ICE_EVENT_NONE;
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
    TcpConnection* c = &self->connections[connection];
    int fd, ends;
    lock(self);
    fd = c->over ? -1 : c->fd;
    c->sending = fd >= 0;
    unlock(self);
    if (fd < 0)
        return ICE_CONNECTION_LOST;
    while (size > 0) {
        long sent = (long)send(fd, message, (size_t)size, MSG_NOSIGNAL);
        if (sent <= 0)
            break;
        message += sent;
        size -= (Ice_Int)sent;
    }
    lock(self);
    c->sending = 0;
    ends = size > 0 || c->over;
    if (c->over)
        closeOne(c);
    else if (ends)
        (void)shutdown(fd, SHUT_RDWR); /* the receiver will see the end, and tell */
    unlock(self);
    return ends ? ICE_CONNECTION_LOST : ICE_OK;
}

/* A numeric address or a name; the first answer counts. */
static int resolve(const char* host, Ice_Int size, U32 port, struct sockaddr_storage* to,
                   socklen_t* length) {
    struct addrinfo hints, *found;
    char name[256], service[8];
    if (size <= 0 || size >= (Ice_Int)sizeof name || port > 65535)
        return 0;
    memcpy(name, host, (size_t)size);
    name[size] = 0;
    sprintf(service, "%u", port);
    memset(&hints, 0, sizeof hints);
    hints.ai_socktype = SOCK_STREAM;
    if (getaddrinfo(name, service, &hints, &found) != 0)
        return 0;
    memcpy(to, found->ai_addr, found->ai_addrlen);
    *length = found->ai_addrlen;
    freeaddrinfo(found);
    return 1;
}

/* connect with a time limit; the socket blocks again afterwards. */
static int openSocket(const struct sockaddr_storage* to, socklen_t length, Ice_Int timeoutMs) {
    struct pollfd wait;
    int failed = 1, on = 1;
    socklen_t size = sizeof failed;
    wait.fd = socket(to->ss_family, SOCK_STREAM, 0);
    wait.events = POLLOUT;
    if (wait.fd < 0)
        return -1;
    (void)fcntl(wait.fd, F_SETFL, O_NONBLOCK);
    (void)setsockopt(wait.fd, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    if (connect(wait.fd, (const struct sockaddr*)to, length) == 0)
        failed = 0;
    else if (errno == EINPROGRESS && poll(&wait, 1, timeoutMs) == 1)
        (void)getsockopt(wait.fd, SOL_SOCKET, SO_ERROR, &failed, &size);
    if (failed) {
        (void)close(wait.fd);
        return -1;
    }
    (void)fcntl(wait.fd, F_SETFL, 0);
    return wait.fd;
}

/* One connection a peer is kept and used again. */
static Ice_Status connectTo(void* context, const Ice_Byte* encoded, Ice_Int size, int* connection) {
    TcpEndpoint* self = context;
    struct sockaddr_storage to;
    socklen_t length;
    Ice_InputStream is;
    Ice_String host;
    Ice_Int timeoutMs;
    U32 port;
    int slot, fd, found = -1;
    Ice_InputStream_init(&is, encoded, size);
    if (Ice_InputStream_readShort(&is) != TCP_ENDPOINT_TYPE)
        return ICE_NO_ENDPOINT;
    (void)Ice_InputStream_readBlob(&is, 6);
    host = Ice_InputStream_readString(&is);
    port = (U32)Ice_InputStream_readInt(&is);
    timeoutMs = Ice_InputStream_readInt(&is);
    if (is.failed || !resolve(host.data, host.size, port, &to, &length))
        return ICE_NO_ENDPOINT;
    lock(self);
    for (slot = 0; slot < ICE_CONNECTIONS && found < 0; ++slot) {
        const TcpConnection* c = &self->connections[slot];
        if (c->fd >= 0 && !c->over && !c->accepted && c->peerSize == length &&
            memcmp(&c->peer, &to, length) == 0)
            found = slot;
    }
    slot = freeSlot(self);
    unlock(self);
    *connection = found;
    if (found >= 0)
        return ICE_OK;
    if (slot < 0)
        return ICE_LIMIT;
    fd = openSocket(&to, length, timeoutMs);
    if (fd < 0)
        return ICE_CONNECTION_LOST;
    lock(self);
    slot = freeSlot(self); /* the other side of another connection may have been faster */
    if (slot >= 0) {
        use(&self->connections[slot], fd, 0);
        self->connections[slot].peer = to;
        self->connections[slot].peerSize = length;
    } else {
        (void)close(fd);
    }
    unlock(self);
    *connection = slot;
    wakeUp(self); /* a task that receives waits on the others only */
    return slot >= 0 ? ICE_OK : ICE_LIMIT;
}

static Ice_Status listenTo(void* context, const char* options) {
    TcpEndpoint* self = context;
    struct sockaddr_storage at;
    socklen_t length;
    Ice_Int size = 9;
    const char* host = Ice_findOption(options, 'h', &size);
    int on = 1;
    if (self->listener >= 0)
        return ICE_LIMIT; /* one port a communicator */
    if (!host) {
        host = "127.0.0.1";
        size = 9;
    }
    if (size >= (Ice_Int)sizeof self->host ||
        !resolve(host, size, Ice_numberOption(options, 'p', 0), &at, &length))
        return ICE_NO_ENDPOINT;
    memcpy(self->host, host, (size_t)size);
    self->host[size] = 0;
    self->listener = socket(at.ss_family, SOCK_STREAM, 0);
    if (self->listener < 0)
        return ICE_NO_ENDPOINT;
    (void)setsockopt(self->listener, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
    if (bind(self->listener, (struct sockaddr*)&at, length) != 0 ||
        listen(self->listener, 4) != 0 ||
        getsockname(self->listener, (struct sockaddr*)&at, &length) != 0) {
        (void)close(self->listener);
        self->listener = -1;
        return ICE_NO_ENDPOINT;
    }
    self->port = ntohs(at.ss_family == AF_INET6 ? ((struct sockaddr_in6*)&at)->sin6_port
                                                : ((struct sockaddr_in*)&at)->sin_port);
    return ICE_OK;
}

static void encode(void* context, const char* options, Ice_OutputStreamPtr os) {
    TcpEndpoint* self = context;
    const char* timeout;
    Ice_Int size;
    int infinite;
    Ice_String host;
    host.data = Ice_findOption(options, 'h', &host.size);
    if (!host.data || host.size > 200)
        host = Ice_String_from(self->host);
    Ice_OutputStream_writeShort(os, TCP_ENDPOINT_TYPE);
    Ice_OutputStream_writeInt(os, 6 + 1 + host.size + 9);
    Ice_OutputStream_writeShort(os, 0x0101); /* encoding 1.1 */
    Ice_OutputStream_writeString(os, host);
    Ice_OutputStream_writeInt(
        os, (Ice_Int)Ice_numberOption(options, 'p', options ? 0 : (U32)self->port));
    timeout = Ice_findOption(options, 't', &size);
    infinite = timeout && size == 8 && memcmp(timeout, "infinite", 8) == 0;
    Ice_OutputStream_writeInt(os, infinite ? -1 : (Ice_Int)Ice_numberOption(options, 't', 60000));
    Ice_OutputStream_writeBool(os, 0); /* no compression */
}

static Ice_Bool print(void* context, const Ice_Byte* encoded, Ice_Int size,
                      Ice_OutputStreamPtr text) {
    Ice_InputStream is;
    Ice_String host;
    Ice_Int port, timeoutMs;
    char line[64];
    (void)context;
    Ice_InputStream_init(&is, encoded, size);
    if (Ice_InputStream_readShort(&is) != TCP_ENDPOINT_TYPE)
        return 0;
    (void)Ice_InputStream_readBlob(&is, 6);
    host = Ice_InputStream_readString(&is);
    port = Ice_InputStream_readInt(&is);
    timeoutMs = Ice_InputStream_readInt(&is);
    if (is.failed)
        return 0;
    Ice_OutputStream_writeBlob(text, (const Ice_Byte*)"tcp -h ", 7);
    if (memchr(host.data, ':', (size_t)host.size))
        Ice_OutputStream_writeByte(text, '"');
    Ice_OutputStream_writeBlob(text, (const Ice_Byte*)host.data, host.size);
    if (memchr(host.data, ':', (size_t)host.size))
        Ice_OutputStream_writeByte(text, '"');
    if (timeoutMs < 0)
        sprintf(line, " -p %d -t infinite", port);
    else
        sprintf(line, " -p %d -t %d", port, timeoutMs);
    Ice_OutputStream_writeBlob(text, (const Ice_Byte*)line, (Ice_Int)strlen(line));
    return 1;
}

static U32 nowMs(void* context) {
    struct timespec now;
    (void)context;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (U32)now.tv_sec * 1000U + (U32)(now.tv_nsec / 1000000);
}

Ice_Status TcpEndpoint_init(Ice_CommunicatorPtr ic, TcpEndpoint* self) {
    static const Ice_Endpoint endpoint = {"tcp",    receive, sendAll, connectTo, closeConnection,
                                          listenTo, encode,  wakeUp,  nowMs,     print};
    int c;
    memset(self, 0, sizeof *self);
    strcpy(self->host, "127.0.0.1");
    self->listener = -1;
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
    if (self->listener >= 0)
        (void)close(self->listener);
    (void)close(self->pipe[0]);
    (void)close(self->pipe[1]);
    (void)pthread_mutex_destroy(&self->lock);
}
