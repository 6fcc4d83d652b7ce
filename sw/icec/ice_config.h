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

/* Size of a received message in bytes, including its header: default 8192, at least 64. The
 * radio link accepts up to LINK_MAX_MESSAGE. A communicator has ICE_NESTING buffers of this
 * size. */
#ifndef ICE_MESSAGE_MAX
#define ICE_MESSAGE_MAX 8192
#endif

/* Size in bytes of a request of this side, and of a reply that is sent later: default
 * ICE_MESSAGE_MAX, at least 64. */
#ifndef ICE_REQUEST_MAX
#define ICE_REQUEST_MAX ICE_MESSAGE_MAX
#endif

/* Size in bytes of a reply of this side: default ICE_MESSAGE_MAX, at least 64. */
#ifndef ICE_RESULT_MAX
#define ICE_RESULT_MAX ICE_MESSAGE_MAX
#endif

/* Size in bytes of a received reply that is kept for its task, including decoded sequences:
 * default 1024, a multiple of 8. There are ICE_CALLS such buffers; a proxy can have a separate
 * one (setReplyBuffer). */
#ifndef ICE_REPLY_MAX
#define ICE_REPLY_MAX 1024
#endif

/* Room in bytes for decoded sequences of all requests in progress: default 2048, a multiple of
 * 8. */
#ifndef ICE_ARENA_BYTES
#define ICE_ARENA_BYTES 2048
#endif

/* Number of servants per adapter: default 8, at least 1. The build increases it if the chip has
 * more cores. */
#ifndef ICE_SERVANTS
#define ICE_SERVANTS 8
#endif

/* Number of characters of name, category and facet of a proxy together: default 52, at most 255. */
#ifndef ICE_IDENTITY_MAX
#define ICE_IDENTITY_MAX 52
#endif

/* Size in bytes of a proxy's encoded endpoints: default 96, at most 255. */
#ifndef ICE_ENDPOINT_MAX
#define ICE_ENDPOINT_MAX 96
#endif

/* Number of connections of a transport, in both directions: default 4, at least 1. Over the
 * radio, 4 for each ground station that a vehicle serves (at most three). */
#ifndef ICE_CONNECTIONS
#define ICE_CONNECTIONS 4
#endif

/* Number of transports of a communicator: default 1, at most 8. The minimal run time has one. */
#ifndef ICE_TRANSPORTS
#define ICE_TRANSPORTS 1
#endif

/* Time for which the receiver listens to a silent transport before it turns to the next one, in ms:
 * default 2, at least 1. A message may wait for this time while other transports are silent. */
#ifndef ICE_TURN_MS
#define ICE_TURN_MS 2
#endif

/* Number of calls in progress, including tasks that keep the results of their last call: default
 * 4, at least 1. */
#ifndef ICE_CALLS
#define ICE_CALLS 4
#endif

/* Number of messages handled at the same time, which is 1 + the number of calls made from within
 * an operation: default 2, at least 1. */
#ifndef ICE_NESTING
#define ICE_NESTING 2
#endif

/* Number of class instances in one message: default 32, at least 1. */
#ifndef ICE_VALUES_MAX
#define ICE_VALUES_MAX 32
#endif

/* Number of different types of these instances, including their bases: default 16, at least 1. */
#ifndef ICE_VALUE_TYPES_MAX
#define ICE_VALUE_TYPES_MAX 16
#endif

/* Time-out of a call for connection and reply in ms, unless the proxy has another one: default
 * 10000, at least 1. */
#ifndef ICE_TIMEOUT_MS
#define ICE_TIMEOUT_MS 10000
#endif

/* Interval of heartbeats during an operation in ms: default 15000, at least 1. Stock Ice closes
 * a silent connection after 60 s. */
#ifndef ICE_HEARTBEAT_MS
#define ICE_HEARTBEAT_MS 15000
#endif
