/* SPDX-License-Identifier: MIT
 *
 * tcp_endpoint: IceC's transport over TCP on a POSIX host: any ZeroC program can be the peer.
 *
 * Options: -h name or address, IPv4 or IPv6 (default 127.0.0.1), -p port (0: the system chooses),
 * -t milliseconds for connecting (default 60000). One adapter of a communicator can listen.
 */
#ifndef TCP_ENDPOINT_H
#define TCP_ENDPOINT_H

#include "icec.h"

#include <pthread.h>
#include <sys/socket.h>

#define TCP_ENDPOINT_TYPE 1

typedef struct TcpConnection {
    int fd;                       /* -1: free */
    Ice_Byte accepted, told;      /* told: OPENED has been reported */
    Ice_Byte sending, over;       /* over: closed, but for the task that still sends */
    struct sockaddr_storage peer; /* of a connection made by this side */
    socklen_t peerSize;
    Ice_Int have;
    Ice_Byte data[ICE_MESSAGE_MAX];
} TcpConnection;

typedef struct TcpEndpoint {
    int listener; /* -1: none */
    int port;     /* that it listens on */
    char host[64];
    int pipe[2];
    pthread_mutex_t lock; /* of what follows: the receiver's, the sender's and who connects */
    TcpConnection connections[ICE_CONNECTIONS];
} TcpEndpoint;

/* ICE_NO_ENDPOINT if the system refuses. */
Ice_Status TcpEndpoint_init(Ice_CommunicatorPtr ic, TcpEndpoint* self);
void TcpEndpoint_destroy(TcpEndpoint* self);

#endif
