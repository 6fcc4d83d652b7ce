/* SPDX-License-Identifier: MIT
 *
 * tcp_private: declarations that the files of the tcp transport share.
 */
#pragma once

#include "tcp_endpoint.h"

/* ---- tcp_address: endpoints in messages, host names and sockets ---- */

typedef struct TcpEndpoint_Address {
    Ice_String host; /* host in the encoded endpoint: a numeric address or a name */
    Ice_Int port;
    Ice_Int timeoutMs;   /* time-out for connecting, ms; negative: unlimited */
    Ice_Bool compresses; /* 1: the endpoint offers compression, which this side does not use */
} TcpEndpoint_Address;

/* Reads the options of an endpoint; without -h, `host` is empty. Returns 0 if an option is unknown
 * or a value is out of range. */
Ice_Bool TcpEndpoint_readOptions(const char* options, TcpEndpoint_Address* address);

/* The functions `encode` and `print` of Ice_Endpoint. */
void TcpEndpoint_encode(void* context, const char* options, Ice_OutputStreamPtr os);
Ice_Bool TcpEndpoint_print(void* context, const Ice_Byte* encoded, Ice_Int size,
                           Ice_OutputStreamPtr text);
/* Decodes an endpoint. Returns 0 if it is malformed or belongs to another transport. */
int TcpEndpoint_decode(const Ice_Byte* encoded, Ice_Int size, TcpEndpoint_Address* address);

/* Resolves a numeric address or a name to its first TCP_PLACES addresses, IPv4 first as in Ice.
 * Returns their number. */
#define TCP_PLACES 8
typedef struct TcpEndpoint_Place {
    struct sockaddr_storage at;
    socklen_t size;
} TcpEndpoint_Place;
int TcpEndpoint_resolve(const TcpEndpoint_Address* address, TcpEndpoint_Place* places);
/* Connects within a time limit. Returns the socket; -1 if the peer refuses or the time-out
 * expires. */
int TcpEndpoint_open(const TcpEndpoint_Place* to, Ice_Int timeoutMs);

/* Sets the options of a connection: no delay, and detection of a peer that has vanished. */
void TcpEndpoint_tune(int fd);

/* ---- tcp_traffic: messages on a connection. The caller holds the lock, except for nowMs and
 * sendSome. ---- */

U32 TcpEndpoint_nowMs(void* context);
/* Returns a free slot; -1 if all slots are taken. */
int TcpEndpoint_freeSlot(const TcpEndpoint* self);

/* Records that a message was sent or received on a connection. A heartbeat does not count as
 * use. */
void TcpEndpoint_note(TcpEndpoint_Connection* c, const Ice_Byte* message, Ice_Int size);
/* Sends a message without a body, if the system accepts it without waiting. */
void TcpEndpoint_sendHead(TcpEndpoint_Connection* c, Ice_Byte type);
/* Sends the heartbeats that are due. Returns the time until the next heartbeat, at most
 * timeoutMs. */
Ice_Int TcpEndpoint_keepUp(TcpEndpoint* self, Ice_Int timeoutMs);
/* Sends for at most `ms` milliseconds. Returns the number of bytes that the system accepted. */
Ice_Int TcpEndpoint_sendSome(int fd, const Ice_Byte* message, Ice_Int size, Ice_Int ms);

/* Refuses the message that begins in c->data; `have` bytes of it have arrived. If the caller waits
 * for a reply, sends an error, skips the rest of the message and returns 1. Otherwise returns 0;
 * the connection must then be closed. */
int TcpEndpoint_refuse(TcpEndpoint_Connection* c, Ice_Int size);
/* Returns the connection that can be displaced first by a new connection, and sets `left` to the
 * time until it can be displaced. Returns -1 if no connection can be displaced. */
int TcpEndpoint_idlest(TcpEndpoint* self, Ice_Int* left);
/* Returns the listening socket if a connection can be accepted now. Otherwise returns -1, and
 * reduces timeoutMs to the time after which a connection can be accepted. */
int TcpEndpoint_listenerFor(TcpEndpoint* self, Ice_Int* timeoutMs);
