/* SPDX-License-Identifier: MIT
 *
 * ice_config: limits and options of IceC; every one may be set by the compiler's -D.
 *
 * The same values must be used for IceC and for all that includes icec.h. Options are 0 or 1 and
 * are tested by plain `if`: the compiler sees all code in every configuration and drops what is
 * off. -DICEC_MINIMAL chooses the minimal run time (docs/icec.md), without any of them.
 */
#ifndef ICE_CONFIG_H
#define ICE_CONFIG_H

#ifdef ICEC_MINIMAL
#define ICEC_DEFAULT 0
#else
#define ICEC_DEFAULT 1
#endif

#ifndef ICEC_TASKS /* several tasks use a communicator (Ice_Os) */
#define ICEC_TASKS ICEC_DEFAULT
#endif
#ifndef ICEC_CONTEXTS /* contexts are sent and can be looked up (they are always tolerated) */
#define ICEC_CONTEXTS ICEC_DEFAULT
#endif
#ifndef ICEC_BATCH /* batches are received and sent */
#define ICEC_BATCH ICEC_DEFAULT
#endif
#ifndef ICEC_ASYNC /* asynchronous calls, answers given later, heartbeats meanwhile */
#define ICEC_ASYNC ICEC_DEFAULT
#endif
#ifndef ICEC_DETAILS /* texts and fields of system exceptions; quoted options; endpoints print */
#define ICEC_DETAILS ICEC_DEFAULT
#endif
#ifndef ICEC_IDS /* ice_id and ice_ids are answered (ice_ping and ice_isA always are) */
#define ICEC_IDS ICEC_DEFAULT
#endif
#ifndef ICEC_NESTING /* messages handled at once: 1 + calls made from within an operation */
#define ICEC_NESTING (1 + ICEC_DEFAULT)
#endif

#ifndef ICE_MESSAGE_MAX /* bytes of one message, header included (LINK_MAX_MESSAGE) */
#define ICE_MESSAGE_MAX 8192
#endif
#ifndef ICE_REQUEST_MAX /* bytes of a request that is made by one of several tasks */
#define ICE_REQUEST_MAX ICE_MESSAGE_MAX
#endif
#ifndef ICE_REPLY_MAX /* bytes of a reply that is kept for the task that waits for it, decoded \
                       * sequences included; a multiple of 8. A proxy can have a buffer of its \
                       * own. */
#define ICE_REPLY_MAX 1024
#endif
#ifndef ICE_ARENA_BYTES /* decoded sequences of the requests under way */
#define ICE_ARENA_BYTES 2048
#endif
#ifndef ICE_SERVANTS /* servants an adapter */
#define ICE_SERVANTS 8
#endif
#ifndef ICE_IDENTITY_MAX /* characters of a proxy's name, category and facet together, at most 255 \
                          */
#define ICE_IDENTITY_MAX 52
#endif
#ifndef ICE_ENDPOINT_MAX /* bytes of a proxy's encoded endpoints, at most 255 */
#define ICE_ENDPOINT_MAX 96
#endif
#ifndef ICE_CONNECTIONS
#define ICE_CONNECTIONS 4
#endif
#ifndef ICE_CALLS /* calls under way */
#define ICE_CALLS (1 + 3 * ICEC_DEFAULT)
#endif
#ifndef ICE_HEARTBEAT_MS /* between signs of life while an operation is under way */
#define ICE_HEARTBEAT_MS 15000
#endif

/* A waiting call's reply is copied unless nobody can receive another message before it is read. */
#define ICEC_COPY_REPLIES (ICEC_TASKS || ICEC_NESTING > 1)

#endif
