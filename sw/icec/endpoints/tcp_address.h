/* SPDX-License-Identifier: MIT
 *
 * tcp_address: endpoints on the wire, names and sockets, for tcp_endpoint.c.
 */
#ifndef TCP_ADDRESS_H
#define TCP_ADDRESS_H

#include "tcp_endpoint.h"

typedef struct TcpEndpoint_Address {
    Ice_String host; /* a numeric address or a name, in the encoded endpoint */
    Ice_Int port;
    Ice_Int timeoutMs; /* for connecting; negative: none */
} TcpEndpoint_Address;

/* `encode` and `print` of Ice_Endpoint. */
void TcpEndpoint_encode(void* context, const char* options, Ice_OutputStreamPtr os);
Ice_Bool TcpEndpoint_print(void* context, const Ice_Byte* encoded, Ice_Int size,
                           Ice_OutputStreamPtr text);
/* Decodes an endpoint. Returns 0 if it is another transport's, or malformed. */
int TcpEndpoint_decode(const Ice_Byte* encoded, Ice_Int size, TcpEndpoint_Address* address);

/* Resolves a numeric address or a name to its first TCP_PLACES addresses, those of IPv4 first as in
 * Ice. Returns how
 * many; 0: there is none. */
#define TCP_PLACES 8
typedef struct TcpEndpoint_Place {
    struct sockaddr_storage at;
    socklen_t size;
} TcpEndpoint_Place;
int TcpEndpoint_resolve(const TcpEndpoint_Address* address, TcpEndpoint_Place* places);
/* Connects with a time limit. Returns the socket; -1: refused, or not in time. */
int TcpEndpoint_open(const TcpEndpoint_Place* to, Ice_Int timeoutMs);

/* Sets a connection's options: no delay, and a vanished peer is noticed. */
void TcpEndpoint_tune(int fd);

#endif
