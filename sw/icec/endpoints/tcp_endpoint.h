/* SPDX-License-Identifier: MIT
 *
 * tcp_endpoint: IceC's transport over TCP on a POSIX host. The peer can be any ZeroC Ice program.
 *
 * Options: -h name or address, IPv4 or IPv6 (default 127.0.0.1), -p port (0: the system chooses),
 * -t time-out for connecting, ms (default 60000). Only one adapter of a communicator can listen.
 *
 * If a peer does not read, sending waits for sendMs; then the connection is closed. A heartbeat is
 * sent on a silent connection every heartbeatMs, because Ice 3.8 closes silent connections after 60
 * s. A peer that has vanished is detected within about a minute.
 *
 * If all connections are in use, a new peer displaces the connection that has been idle longest,
 * among those that peers have made and on which no reply is outstanding. If a request or a reply
 * has already passed on this connection, it can be displaced at once. If none has passed, or if a
 * message is arriving, it can be displaced after idleMs.
 *
 * A message that is too long or compressed is refused, and reported on standard error. A caller
 * that waits for a reply gets an UnknownLocalException that names the limit; otherwise the
 * connection is closed, as by ZeroC Ice.
 */
#pragma once

#include "icec.h"

#include <pthread.h>
#include <sys/socket.h>

#define TCP_ENDPOINT_TYPE 1

typedef struct TcpEndpoint_Connection {
    int fd; /* -1: free */
    /* accepted: 1 if the peer made the connection; reported: 1 if the event OPENED has been
     * delivered */
    Ice_Byte accepted, reported;
    /* sending: 1 while a task sends on the connection; over: 1 if the connection was closed
     * meanwhile, so that the sending task must free the slot */
    Ice_Byte sending, over;
    Ice_Byte spoke;  /* 1 if this side has sent a message */
    Ice_Byte served; /* 1 if a request or reply was sent or received */
    /* number of bytes of a refused message that are still to be skipped */
    Ice_Int skip;
    U32 sentMs; /* time of the last message sent, ms */
    U32 usedMs; /* time of the last request or reply, ms */
    /* number of replies that this side or the peer still has to send */
    Ice_Int owed;
    struct sockaddr_storage peer; /* address of the peer, if this side made the connection */
    socklen_t peerSize;
    Ice_Int have;
    Ice_Byte data[ICE_MESSAGE_MAX];
} TcpEndpoint_Connection;

typedef struct TcpEndpoint {
    int listener; /* listening socket; -1 if not listening */
    int port;     /* port of the listener */
    char host[64];
    int pipe[2];
    Ice_Int sendMs, heartbeatMs, idleMs; /* limits, which may be changed after TcpEndpoint_init */
    pthread_mutex_t lock;                /* protects the following members */
    TcpEndpoint_Connection connections[ICE_CONNECTIONS];
} TcpEndpoint;

/* Registers the transport "tcp" with the communicator. Returns ICE_NO_ENDPOINT if the operating
 * system provides no pipe or lock. */
Ice_Status TcpEndpoint_init(Ice_CommunicatorPtr ic, TcpEndpoint* self);
void TcpEndpoint_destroy(TcpEndpoint* self);
