/* SPDX-License-Identifier: MIT
 *
 * tcp_traffic: records the use of a connection, sends heartbeats, and limits the time for sending.
 */
#define _POSIX_C_SOURCE 200809L
#include "ice_message.h"
#include "tcp_private.h"

#include <errno.h>
#include <poll.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

U32 TcpEndpoint_nowMs(void* context) {
    struct timespec now;
    (void)context;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (U32)now.tv_sec * 1000U + (U32)(now.tv_nsec / 1000000);
}

#define TYPE_AT 8
#define COMPRESSION_AT 9
#define REASON_MAX 80

int TcpEndpoint_freeSlot(const TcpEndpoint* self) {
    int c;
    for (c = 0; c < ICE_CONNECTIONS; ++c)
        if (self->connections[c].fd < 0)
            return c;
    return -1;
}

void TcpEndpoint_note(TcpEndpoint_Connection* c, const Ice_Byte* message, Ice_Int size) {
    static const Ice_Byte noId[4] = {0};
    Ice_Byte type = message[TYPE_AT];
    if (type != ICEC_VALIDATE) {
        c->usedMs = TcpEndpoint_nowMs(0);
        c->served = 1;
    }
    if (type == ICEC_REQUEST && size >= ICEC_HEADER + 4 &&
        memcmp(message + ICEC_HEADER, noId, 4) != 0)
        ++c->owed;
    else if (type == ICEC_REPLY && c->owed > 0)
        --c->owed;
}

/* Sends a message if the system accepts it without waiting. */
static void sendNow(TcpEndpoint_Connection* c, const Ice_Byte* message, Ice_Int size) {
    if (c->fd >= 0 && !c->sending && !c->over &&
        send(c->fd, message, (size_t)size, MSG_NOSIGNAL | MSG_DONTWAIT) != size)
        /* only a part of the message was sent, so the connection is unusable */
        (void)shutdown(c->fd, SHUT_RDWR);
    c->sentMs = TcpEndpoint_nowMs(0);
}

void TcpEndpoint_sendHead(TcpEndpoint_Connection* c, Ice_Byte type) {
    Ice_Byte bytes[ICEC_HEADER];
    Ice_OutputStream os;
    Ice_OutputStream_init(&os, bytes, ICEC_HEADER);
    icec_beginMessage(&os, type);
    sendNow(c, bytes, os.size);
}

/* Answers a request with an UnknownLocalException. */
static void sendReason(TcpEndpoint_Connection* c, const char* reason) {
    Ice_Byte bytes[ICEC_HEADER + 6 + REASON_MAX];
    Ice_OutputStream os;
    Ice_OutputStream_init(&os, bytes, (Ice_Int)sizeof bytes);
    icec_beginMessage(&os, ICEC_REPLY);
    Ice_OutputStream_writeBlob(&os, c->data + ICEC_HEADER, 4); /* id of the request */
    Ice_OutputStream_writeByte(&os, ICE_UNKNOWN_LOCAL_EXCEPTION);
    Ice_OutputStream_writeText(&os, reason);
    icec_endMessage(&os);
    sendNow(c, bytes, os.size);
}

int TcpEndpoint_refuse(TcpEndpoint_Connection* c, Ice_Int size) {
    static const char* const types[] = {"request", "batch", "reply"};
    static const Ice_Byte noId[4] = {0};
    Ice_Byte type = c->data[TYPE_AT];
    const char* what = type <= ICEC_REPLY ? types[type] : "message";
    char reason[REASON_MAX];
    if (c->data[COMPRESSION_AT] == 2) {
        fprintf(stderr, "icec: refused a compressed %s: IceC has no bzip2\n", what);
        /* CLOSE informs the caller that the request was not executed */
        TcpEndpoint_sendHead(c, ICEC_CLOSE);
        return 0;
    }
    sprintf(reason, "::Ice::MemoryLimitException: over ICE_MESSAGE_MAX (%d)", ICE_MESSAGE_MAX);
    fprintf(stderr, "icec: refused a %s of %d bytes: %s\n", what, size, reason);
    if (type != ICEC_REQUEST || memcmp(c->data + ICEC_HEADER, noId, 4) == 0)
        return 0; /* no reply can report the error, so the connection is closed */
    sendReason(c, reason);
    c->served = 1;
    c->usedMs = TcpEndpoint_nowMs(0);
    c->skip = size - c->have;
    c->have = 0;
    return 1;
}

/* Returns whether a message is arriving, or has arrived and was not handled yet. */
static int isArriving(const TcpEndpoint_Connection* c) {
    Ice_Byte byte;
    return c->have > 0 || c->skip > 0 || recv(c->fd, &byte, 1, MSG_PEEK | MSG_DONTWAIT) > 0;
}

int TcpEndpoint_idlest(TcpEndpoint* self, Ice_Int* left) {
    U32 now = TcpEndpoint_nowMs(0);
    int i, found = -1;
    for (i = 0; i < ICE_CONNECTIONS; ++i) {
        const TcpEndpoint_Connection* c = &self->connections[i];
        Ice_Int ms = (Ice_Int)(c->usedMs - now);
        if (c->fd < 0 || !c->accepted || c->over || c->owed != 0)
            continue;
        if (!c->served || isArriving(c))
            ms += self->idleMs;
        if (found < 0 || ms < *left) {
            *left = ms;
            found = i;
        }
    }
    return found;
}

int TcpEndpoint_listenerFor(TcpEndpoint* self, Ice_Int* timeoutMs) {
    Ice_Int left;
    if (TcpEndpoint_freeSlot(self) >= 0)
        return self->listener;
    if (TcpEndpoint_idlest(self, &left) < 0)
        return -1;
    if (left <= 0)
        return self->listener;
    if (self->listener >= 0 && left < *timeoutMs)
        *timeoutMs = left;
    return -1;
}

Ice_Int TcpEndpoint_keepUp(TcpEndpoint* self, Ice_Int timeoutMs) {
    U32 now = TcpEndpoint_nowMs(0);
    int i;
    for (i = 0; i < ICE_CONNECTIONS; ++i) {
        TcpEndpoint_Connection* c = &self->connections[i];
        Ice_Int left = self->heartbeatMs - (Ice_Int)(now - c->sentMs);
        if (c->fd < 0 || !c->spoke)
            continue;
        if (left <= 0) {
            TcpEndpoint_sendHead(c, ICEC_VALIDATE);
            left = self->heartbeatMs;
        }
        timeoutMs = left < timeoutMs ? left : timeoutMs;
    }
    return timeoutMs;
}

Ice_Int TcpEndpoint_sendSome(int fd, const Ice_Byte* message, Ice_Int size, Ice_Int ms) {
    U32 begin = TcpEndpoint_nowMs(0);
    Ice_Int done = 0;
    struct pollfd wait;
    wait.fd = fd;
    wait.events = POLLOUT;
    while (done < size) {
        Ice_Int left = ms - (Ice_Int)(TcpEndpoint_nowMs(0) - begin);
        long sent = (long)send(fd, message + done, (size_t)(size - done), MSG_NOSIGNAL);
        if (sent > 0)
            done += (Ice_Int)sent;
        else if (sent == 0 || (errno != EAGAIN && errno != EINTR) || left <= 0)
            break;
        else
            (void)poll(&wait, 1, left);
    }
    return done;
}
