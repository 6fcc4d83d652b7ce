/* SPDX-License-Identifier: MIT
 *
 * tcp_endpoint: IceC's transport over TCP on a POSIX host: any ZeroC program can be the peer.
 *
 * Options: -h numeric IPv4 address (default 127.0.0.1), -p port (0: the system chooses).
 */
#ifndef TCP_ENDPOINT_H
#define TCP_ENDPOINT_H

#include "icec.h"

#define TCP_ENDPOINT_TYPE 1

typedef struct TcpConnection {
    int fd; /* -1: free */
    Ice_Byte accepted, told; /* told: OPENED has been reported */
    Ice_Int have;
    Ice_Byte data[ICE_MESSAGE_MAX];
} TcpConnection;

typedef struct TcpEndpoint {
    int listener; /* -1: none */
    int port;     /* that it listens on */
    int pipe[2];
    TcpConnection connections[ICE_CONNECTIONS];
} TcpEndpoint;

/* ICE_NO_ENDPOINT if the system refuses. */
Ice_Status TcpEndpoint_init(Ice_CommunicatorPtr ic, TcpEndpoint *self);
void TcpEndpoint_destroy(TcpEndpoint *self);

#endif
