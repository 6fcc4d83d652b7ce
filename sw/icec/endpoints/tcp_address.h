/* SPDX-License-Identifier: MIT
 *
 * tcp_address: what tcp_endpoint.c needs of endpoints on the wire, of names and of sockets.
 */
#ifndef TCP_ADDRESS_H
#define TCP_ADDRESS_H

#include "tcp_endpoint.h"

typedef struct Tcp_Address {
    Ice_String host; /* a numeric address or a name, in the encoded endpoint */
    Ice_Int port;
    Ice_Int timeoutMs; /* for connecting; negative: none */
} Tcp_Address;

/* `encode` and `print` of Ice_Endpoint. */
void Tcp_encode(void* context, const char* options, Ice_OutputStreamPtr os);
Ice_Bool Tcp_print(void* context, const Ice_Byte* encoded, Ice_Int size, Ice_OutputStreamPtr text);
/* 0: another transport's, or malformed. */
int Tcp_decode(const Ice_Byte* encoded, Ice_Int size, Tcp_Address* address);

/* A numeric address or a name: its first TCP_PLACES addresses, those of IPv4 first as in Ice. How
 * many; 0: there is none. */
#define TCP_PLACES 8
typedef struct Tcp_Place {
    struct sockaddr_storage at;
    socklen_t size;
} Tcp_Place;
int Tcp_resolve(const Tcp_Address* address, Tcp_Place* places);
/* connect with a time limit; the socket blocks again afterwards. -1: refused, or not in time. */
int Tcp_open(const Tcp_Place* to, Ice_Int timeoutMs);

#endif
