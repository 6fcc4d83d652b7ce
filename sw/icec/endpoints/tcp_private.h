/* SPDX-License-Identifier: MIT
 *
 * tcp_private: declares what the files of the tcp transport share.
 */
#pragma once

#include "tcp_endpoint.h"

/* ---- tcp_address: endpoints on the wire, names and sockets ---- */

typedef struct TcpEndpoint_Address {
    Ice_String host; /* a numeric address or a name, in the encoded endpoint */
    Ice_Int port;
    Ice_Int timeoutMs;   /* for connecting; negative: unlimited */
    Ice_Bool compresses; /* offered, but not used by this side */
} TcpEndpoint_Address;

/* Reads the options of an endpoint; `host` is empty without -h. Returns 0 for unknown options,
 * or values out of range. */
Ice_Bool TcpEndpoint_readOptions(const char* options, TcpEndpoint_Address* address);

/* `encode` and `print` of Ice_Endpoint. */
void TcpEndpoint_encode(void* context, const char* options, Ice_OutputStreamPtr os);
Ice_Bool TcpEndpoint_print(void* context, const Ice_Byte* encoded, Ice_Int size,
                           Ice_OutputStreamPtr text);
/* Decodes an endpoint. Returns 0 for another transport's endpoint, or a malformed one. */
int TcpEndpoint_decode(const Ice_Byte* encoded, Ice_Int size, TcpEndpoint_Address* address);

/* Resolves a numeric address or a name to its first TCP_PLACES addresses, IPv4 first as in Ice.
 * Returns their number. */
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

/* ---- tcp_traffic: traffic of a connection; all but nowMs and sendSome under the lock ---- */

U32 TcpEndpoint_nowMs(void* context);
/* Returns a free slot; -1 if all are taken. */
int TcpEndpoint_freeSlot(const TcpEndpoint* self);

/* Records a message sent or received; a heartbeat does not count as use of its connection. */
void TcpEndpoint_note(TcpEndpoint_Connection* c, const Ice_Byte* message, Ice_Int size);
/* Sends a message without a body, if the system takes it at once. */
void TcpEndpoint_sendHead(TcpEndpoint_Connection* c, Ice_Byte type);
/* Sends the heartbeats that are due. Returns the time until the next, at most timeoutMs. */
Ice_Int TcpEndpoint_keepUp(TcpEndpoint* self, Ice_Int timeoutMs);
/* Sends for at most `ms`. Returns the number of bytes that the system took. */
Ice_Int TcpEndpoint_sendSome(int fd, const Ice_Byte* message, Ice_Int size, Ice_Int ms);

/* Refuses the message with its first `have` bytes in c->data. A caller that waits for a reply gets
 * one, and the rest of the message is skipped. Otherwise returns 0: the connection ends. */
int TcpEndpoint_refuse(TcpEndpoint_Connection* c, Ice_Int size);
/* Returns the accepted connection that a new one may displace first, and the time until it may; -1
 * if none. */
int TcpEndpoint_idlest(TcpEndpoint* self, Ice_Int* left);
/* Returns the listener if a connection can be accepted now; else -1, and shortens timeoutMs to the
 * time when one may be. */
int TcpEndpoint_listenerFor(TcpEndpoint* self, Ice_Int* timeoutMs);
