/* SPDX-License-Identifier: MIT
 *
 * ice_config: all numbers of IceC that a program may choose, with unit, default and limits. They
 * are set with the compiler's -D.
 *
 * IceC and all code that includes icec.h must use the same values. -DICEC_MINIMAL selects the
 * minimal run time (docs/icec.md): sw/minimal/ice_minimal.c replaces the files of the full one. The
 * numbers of the link are in link_config.h; the limits of a TCP server are set at run time
 * (tcp_endpoint.h).
 */
#pragma once

/* Size of a received message, header included, bytes: 8192, at least 64. The radio link takes up to
 * LINK_MAX_MESSAGE. A communicator has ICE_NESTING buffers of this size. */
#ifndef ICE_MESSAGE_MAX
#define ICE_MESSAGE_MAX 8192
#endif

/* Bytes of a request that this side makes, and of a later reply: as ICE_MESSAGE_MAX, from 64. */
#ifndef ICE_REQUEST_MAX
#define ICE_REQUEST_MAX ICE_MESSAGE_MAX
#endif

/* Size of a reply made by this side, bytes: default as ICE_MESSAGE_MAX, at least 64. */
#ifndef ICE_RESULT_MAX
#define ICE_RESULT_MAX ICE_MESSAGE_MAX
#endif

/* Size of a reply kept for its task, decoded sequences included, bytes: 1024, a multiple of 8.
 * There are ICE_CALLS such buffers; a proxy can have a separate one (setReplyBuffer). */
#ifndef ICE_REPLY_MAX
#define ICE_REPLY_MAX 1024
#endif

/* Room for decoded sequences of the requests in progress, bytes: 2048, a multiple of 8. */
#ifndef ICE_ARENA_BYTES
#define ICE_ARENA_BYTES 2048
#endif

/* Servants per adapter: 8, at least 1. The build raises it if the chip has more cores. */
#ifndef ICE_SERVANTS
#define ICE_SERVANTS 8
#endif

/* Characters of name, category and facet of a proxy together: at most 255 (default 52). */
#ifndef ICE_IDENTITY_MAX
#define ICE_IDENTITY_MAX 52
#endif

/* Bytes of a proxy's encoded endpoints: 96, up to 255. */
#ifndef ICE_ENDPOINT_MAX
#define ICE_ENDPOINT_MAX 96
#endif

/* Connections of a transport, in both directions: 4, at least 1; over the radio 4 per ground
 * station that a vehicle serves (at most three). */
#ifndef ICE_CONNECTIONS
#define ICE_CONNECTIONS 4
#endif

/* Transports of a communicator: 1, up to 8. The minimal run time has one. */
#ifndef ICE_TRANSPORTS
#define ICE_TRANSPORTS 1
#endif

/* Time for which the receiver listens to a silent transport before it turns to the next one, ms: 2,
 * at least 1. A message may wait that long while the others are silent. */
#ifndef ICE_TURN_MS
#define ICE_TURN_MS 2
#endif

/* Calls in progress, including tasks that keep the results of their last call: 4, at least 1. */
#ifndef ICE_CALLS
#define ICE_CALLS 4
#endif

/* Messages handled at once, 1 + calls made from within an operation: 2, at least 1. */
#ifndef ICE_NESTING
#define ICE_NESTING 2
#endif

/* Instances of classes in one message: 32, from 1. */
#ifndef ICE_VALUES_MAX
#define ICE_VALUES_MAX 32
#endif

/* Different types among them, their bases included: 16, from 1. */
#ifndef ICE_VALUE_TYPES_MAX
#define ICE_VALUE_TYPES_MAX 16
#endif

/* Time-out of a call for connection and reply, unless set for the proxy, ms: 10000, at least 1. */
#ifndef ICE_TIMEOUT_MS
#define ICE_TIMEOUT_MS 10000
#endif

/* Interval of heartbeats during an operation, ms: 15000, at least 1. Stock Ice closes a silent
 * connection after 60 s. */
#ifndef ICE_HEARTBEAT_MS
#define ICE_HEARTBEAT_MS 15000
#endif
