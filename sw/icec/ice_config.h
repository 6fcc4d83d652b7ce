/* SPDX-License-Identifier: MIT
 *
 * ice_config: all numbers of IceC that a program may choose, each with its unit, default and
 * limits. The compiler's -D sets them.
 *
 * The same values must be used for IceC and for all that includes icec.h. -DICEC_MINIMAL chooses
 * the minimal run time (docs/icec.md): sw/minimal/ice_minimal.c instead of the full one's files.
 * Those of the link are in link_config.h; a TCP server's are set at run time (tcp_endpoint.h).
 */
#pragma once

/* Bytes of a message that comes in, header included: 8192, from 64. The radio link takes up to
 * LINK_MAX_MESSAGE. A communicator has ICE_NESTING buffers of this size. */
#ifndef ICE_MESSAGE_MAX
#define ICE_MESSAGE_MAX 8192
#endif

/* Bytes of a request that this side makes, and of a later reply: as ICE_MESSAGE_MAX, from 64. */
#ifndef ICE_REQUEST_MAX
#define ICE_REQUEST_MAX ICE_MESSAGE_MAX
#endif

/* Bytes of a reply that this side makes when the operation ends: as ICE_MESSAGE_MAX, from 64. */
#ifndef ICE_RESULT_MAX
#define ICE_RESULT_MAX ICE_MESSAGE_MAX
#endif

/* Bytes of a reply that is kept for its task, decoded sequences included: 1024, a multiple of 8.
 * There are ICE_CALLS of them; a proxy can have a buffer of its own (setReplyBuffer). */
#ifndef ICE_REPLY_MAX
#define ICE_REPLY_MAX 1024
#endif

/* Bytes for decoded sequences of the requests under way: 2048, a multiple of 8. */
#ifndef ICE_ARENA_BYTES
#define ICE_ARENA_BYTES 2048
#endif

/* Servants an adapter: 8, from 1. The build sets more where the chip has more cores. */
#ifndef ICE_SERVANTS
#define ICE_SERVANTS 8
#endif

/* Characters of a proxy's name, category and facet together: 52, up to 255. */
#ifndef ICE_IDENTITY_MAX
#define ICE_IDENTITY_MAX 52
#endif

/* Bytes of a proxy's encoded endpoints: 96, up to 255. */
#ifndef ICE_ENDPOINT_MAX
#define ICE_ENDPOINT_MAX 96
#endif

/* Connections of a transport, of both directions: 4, from 1; over the radio 4 for each ground that
 * a vehicle serves, of which there are three at most. */
#ifndef ICE_CONNECTIONS
#define ICE_CONNECTIONS 4
#endif

/* Transports of a communicator: 1, up to 8. The minimal run time has one. */
#ifndef ICE_TRANSPORTS
#define ICE_TRANSPORTS 1
#endif

/* Milliseconds for which the receiver listens to a silent transport before it turns to the next, of
 * several: 2, from 1. A message waits as long where the others are silent. */
#ifndef ICE_TURN_MS
#define ICE_TURN_MS 2
#endif

/* Calls under way, and tasks that keep what their last call returned: 4, from 1. */
#ifndef ICE_CALLS
#define ICE_CALLS 4
#endif

/* Messages handled at once, 1 + calls made from within an operation: 2, from 1. */
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

/* Milliseconds that a call waits for its connection and reply, unless its proxy says otherwise:
 * 10000, from 1. */
#ifndef ICE_TIMEOUT_MS
#define ICE_TIMEOUT_MS 10000
#endif

/* Milliseconds between heartbeats while an operation is under way: 15000, from 1. Stock Ice gives
 * a silent connection up after 60 s. */
#ifndef ICE_HEARTBEAT_MS
#define ICE_HEARTBEAT_MS 15000
#endif
