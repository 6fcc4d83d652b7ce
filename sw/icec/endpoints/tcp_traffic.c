/* SPDX-License-Identifier: MIT
 *
 * tcp_traffic: traffic of a connection: its use, heartbeats, sending within a bound.
 */
#define _POSIX_C_SOURCE 200809L
#include "tcp_traffic.h"

#include <errno.h>
#include <poll.h>
#include <string.h>
#include <time.h>

U32 TcpEndpoint_nowMs(void* context) {
    struct timespec now;
    (void)context;
    (void)clock_gettime(CLOCK_MONOTONIC, &now);
    return (U32)now.tv_sec * 1000U + (U32)(now.tv_nsec / 1000000);
}

#define TYPE_AT 8

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
    if (type != TCP_VALIDATE)
        c->usedMs = TcpEndpoint_nowMs(0);
    if (type == TCP_REQUEST && size >= TCP_HEAD + 4 && memcmp(message + TCP_HEAD, noId, 4) != 0)
        ++c->owed;
    else if (type == TCP_REPLY && c->owed > 0)
        --c->owed;
}

void TcpEndpoint_sendHead(TcpEndpoint_Connection* c, Ice_Byte type) {
    Ice_Byte head[TCP_HEAD] = {'I', 'c', 'e', 'P', 1, 0, 1, 0, 0, 0, TCP_HEAD, 0, 0, 0};
    head[TYPE_AT] = type;
    if (c->fd >= 0 && !c->sending && !c->over &&
        send(c->fd, head, TCP_HEAD, MSG_NOSIGNAL | MSG_DONTWAIT) != TCP_HEAD)
        (void)shutdown(c->fd, SHUT_RDWR); /* part of a message is useless */
    c->sentMs = TcpEndpoint_nowMs(0);
}

int TcpEndpoint_idlest(TcpEndpoint* self, Ice_Int* idle) {
    U32 now = TcpEndpoint_nowMs(0);
    int i, found = -1;
    *idle = -1;
    for (i = 0; i < ICE_CONNECTIONS; ++i) {
        const TcpEndpoint_Connection* c = &self->connections[i];
        Ice_Int ms = (Ice_Int)(now - c->usedMs);
        if (c->fd >= 0 && c->accepted && !c->over && c->owed == 0 && ms > *idle) {
            *idle = ms;
            found = i;
        }
    }
    return found;
}

int TcpEndpoint_listenerFor(TcpEndpoint* self, Ice_Int* timeoutMs) {
    Ice_Int idle, left;
    if (TcpEndpoint_freeSlot(self) >= 0)
        return self->listener;
    if (TcpEndpoint_idlest(self, &idle) < 0)
        return -1;
    left = self->idleMs - idle;
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
            TcpEndpoint_sendHead(c, TCP_VALIDATE);
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
