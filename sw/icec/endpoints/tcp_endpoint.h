/* SPDX-License-Identifier: MIT
 *
 * tcp_endpoint: IceC's transport over TCP on a POSIX host: any ZeroC program can be the peer.
 *
 * Options: -h name or address, IPv4 or IPv6 (default 127.0.0.1), -p port (0: the system chooses),
 * -t time-out for connecting, ms (default 60000). One adapter of a communicator can listen.
 *
 * Sending to a peer that does not read waits for sendMs, then closes the connection. A silent
 * connection carries a heartbeat every heartbeatMs, because Ice 3.8 closes silent connections after
 * 60 s. If all connections are in use, a new peer displaces the one that has been idle longest: at
 * once if it has been served before, otherwise after idleMs. A peer that has vanished is detected
 * within about a minute.
 *
 * A message that is too long or compressed is refused, and reported on standard error. A caller
 * that waits for a reply gets an UnknownLocalException that names the limit; otherwise the
 * connection is closed, as by stock Ice.
 */
#pragma once

#include "icec.h"

#include <pthread.h>
#include <sys/socket.h>

#define TCP_ENDPOINT_TYPE 1

typedef struct TcpEndpoint_Connection {
    int fd;                      /* -1: free */
    Ice_Byte accepted, reported; /* reported: the event OPENED has been delivered */
    /* over: 1 if the connection is closed, and only a sending task still uses it */
    Ice_Byte sending, over;
    Ice_Byte spoke;               /* this side has sent a message */
    Ice_Byte served;              /* a request or reply was sent or received */
    Ice_Int skip;                 /* remaining bytes of a refused message */
    U32 sentMs;                   /* time of the last message sent */
    U32 usedMs;                   /* time of the last request or reply, ms */
    Ice_Int owed;                 /* number of replies that are due in either direction */
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
    Ice_Int sendMs, heartbeatMs, idleMs; /* limits; they may be changed after TcpEndpoint_init */
    pthread_mutex_t lock;                /* guards the following members */
    TcpEndpoint_Connection connections[ICE_CONNECTIONS];
} TcpEndpoint;

/* Registers the transport "tcp" with the communicator. Returns ICE_NO_ENDPOINT if the system
 * refuses. */
Ice_Status TcpEndpoint_init(Ice_CommunicatorPtr ic, TcpEndpoint* self);
void TcpEndpoint_destroy(TcpEndpoint* self);
