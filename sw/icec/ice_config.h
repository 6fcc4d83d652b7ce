/* SPDX-License-Identifier: MIT
 *
 * ice_config: all limits and times of IceC that a program may choose, each with its unit, default
 * and range. They are set by the compiler option -D.
 *
 * IceC and all code that includes icec.h must use the same values. With -DICEC_MINIMAL, the minimal
 * run time is used (docs/icec.md): sw/minimal/ice_minimal.c replaces the files of the full run
 * time. The constants of the link are in link_config.h; the limits of a TCP server are set at run
 * time (tcp_endpoint.h).
 */
#pragma once

/* Largest size of a received message, including its header, bytes: default 8192, at least 64.
 * The radio link accepts up to LINK_MAX_MESSAGE. A communicator has ICE_NESTING buffers of
 * this size. */
#ifndef ICE_MESSAGE_MAX
#define ICE_MESSAGE_MAX 8192
#endif

/* Largest size of a request of this side, and of a reply that is sent later, bytes: default
 * ICE_MESSAGE_MAX, at least 64. */
#ifndef ICE_REQUEST_MAX
#define ICE_REQUEST_MAX ICE_MESSAGE_MAX
#endif

/* Largest size of a reply of this side, bytes: default ICE_MESSAGE_MAX, at least 64. */
#ifndef ICE_RESULT_MAX
#define ICE_RESULT_MAX ICE_MESSAGE_MAX
#endif

/* Largest size of a received reply that is kept for its task, including decoded sequences, bytes:
 * default 1024, a multiple of 8. There are ICE_CALLS such buffers; a proxy can have a separate
 * buffer (setReplyBuffer). */
#ifndef ICE_REPLY_MAX
#define ICE_REPLY_MAX 1024
#endif

/* Size of the memory for decoded sequences, shared by all requests in progress, bytes: default
 * 2048, a multiple of 8. */
#ifndef ICE_ARENA_BYTES
#define ICE_ARENA_BYTES 2048
#endif

/* Number of servants per adapter: default 8, at least 1. The build increases it if the chip has
 * more cores. */
#ifndef ICE_SERVANTS
#define ICE_SERVANTS 8
#endif

/* Length of name, category and facet of a proxy together, characters: default 52, at most 255. */
#ifndef ICE_IDENTITY_MAX
#define ICE_IDENTITY_MAX 52
#endif

/* Size of a proxy's encoded endpoints, bytes: default 96, at most 255. */
#ifndef ICE_ENDPOINT_MAX
#define ICE_ENDPOINT_MAX 96
#endif

/* Number of connections of a transport, in both directions: default 4, at least 1. The radio needs
 * 4 for each ground station that a vehicle serves (at most three). */
#ifndef ICE_CONNECTIONS
#define ICE_CONNECTIONS 4
#endif

/* Number of transports of a communicator: default 1, at most 8. The minimal run time has one. */
#ifndef ICE_TRANSPORTS
#define ICE_TRANSPORTS 1
#endif

/* Time for which the receiver listens to a silent transport before it turns to the next one, ms:
 * default 2, at least 1. A message may wait for this time while the receiver listens to another
 * transport. */
#ifndef ICE_TURN_MS
#define ICE_TURN_MS 2
#endif

/* Number of calls in progress, including ended calls if a task still keeps their
 * results: default 4, at least 1. */
#ifndef ICE_CALLS
#define ICE_CALLS 4
#endif

/* Number of messages that are handled at the same time: default 2, at least 1. It is 1 plus the
 * number of nested calls, which are calls made while an operation is executed. */
#ifndef ICE_NESTING
#define ICE_NESTING 2
#endif

/* Number of class instances in one message: default 32, at least 1. */
#ifndef ICE_VALUES_MAX
#define ICE_VALUES_MAX 32
#endif

/* Number of different types of the class instances in one message, including their bases: default
 * 16, at least 1. */
#ifndef ICE_VALUE_TYPES_MAX
#define ICE_VALUE_TYPES_MAX 16
#endif

/* Time-out of a call, ms: default 10000, at least 1. It covers the connection and the reply; a
 * proxy may have another time-out. */
#ifndef ICE_TIMEOUT_MS
#define ICE_TIMEOUT_MS 10000
#endif

/* Interval of heartbeats while an operation is executed, ms: default 15000, at least 1. Stock Ice
 * closes a silent connection after 60 s. */
#ifndef ICE_HEARTBEAT_MS
#define ICE_HEARTBEAT_MS 15000
#endif
