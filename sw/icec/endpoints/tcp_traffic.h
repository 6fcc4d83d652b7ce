/* SPDX-License-Identifier: MIT
 *
 * tcp_traffic: traffic of a connection. All functions but nowMs and sendSome are called under the
 * endpoint's lock.
 */
#ifndef TCP_TRAFFIC_H
#define TCP_TRAFFIC_H

#include "tcp_endpoint.h"

enum { TCP_REQUEST, TCP_BATCH, TCP_REPLY, TCP_VALIDATE, TCP_CLOSE }; /* types of messages */
#define TCP_HEAD 14

U32 TcpEndpoint_nowMs(void* context);
/* Returns a free number; -1: there is none. */
int TcpEndpoint_freeSlot(const TcpEndpoint* self);

/* Records a message that came or went; a heartbeat does not count as use of its connection. */
void TcpEndpoint_note(TcpEndpoint_Connection* c, const Ice_Byte* message, Ice_Int size);
/* Sends a message without a body, if the system takes it at once. */
void TcpEndpoint_sendHead(TcpEndpoint_Connection* c, Ice_Byte type);
/* Sends the heartbeats that are due. Returns the time until the next, at most timeoutMs. */
Ice_Int TcpEndpoint_keepUp(TcpEndpoint* self, Ice_Int timeoutMs);
/* Sends for at most `ms`. Returns the number of bytes that the system took. */
Ice_Int TcpEndpoint_sendSome(int fd, const Ice_Byte* message, Ice_Int size, Ice_Int ms);

/* Refuses the message whose first `have` bytes lie in c->data, and passes over the rest of it: the
 * caller is told where it waits, else the connection ends. Returns 0 if it does. */
int TcpEndpoint_refuse(TcpEndpoint_Connection* c, Ice_Int size);
/* Returns the accepted connection that a new one may displace first, and how long it still may not;
 * -1: there is none. */
int TcpEndpoint_idlest(TcpEndpoint* self, Ice_Int* left);
/* Returns the listener if a connection can be accepted now; else -1, and timeoutMs is shortened to
 * when one may be. */
int TcpEndpoint_listenerFor(TcpEndpoint* self, Ice_Int* timeoutMs);

#endif
