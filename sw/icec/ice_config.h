/* SPDX-License-Identifier: MIT
 *
 * ice_config: limits of IceC; every one may be set by the compiler's -D.
 *
 * The same values must be used for IceC and for all that includes icec.h. -DICEC_MINIMAL chooses
 * the minimal run time (docs/icec.md): minimal/ice_minimal.c instead of the full one's files.
 */
#ifndef ICE_CONFIG_H
#define ICE_CONFIG_H

#ifndef ICE_MESSAGE_MAX /* bytes of a message that comes in, header included (LINK_MAX_MESSAGE) */
#define ICE_MESSAGE_MAX 8192
#endif
#ifndef ICE_REQUEST_MAX /* bytes of a request that this side makes, and of a later reply */
#define ICE_REQUEST_MAX ICE_MESSAGE_MAX
#endif
#ifndef ICE_RESULT_MAX /* bytes of a reply that this side makes when the operation ends */
#define ICE_RESULT_MAX ICE_MESSAGE_MAX
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
#ifndef ICE_CALLS /* calls under way, and tasks that keep what their last call returned */
#define ICE_CALLS 4
#endif
#ifndef ICE_NESTING /* messages handled at once: 1 + calls made from within an operation */
#define ICE_NESTING 2
#endif
#ifndef ICE_HEARTBEAT_MS /* between heartbeats while an operation is under way */
#define ICE_HEARTBEAT_MS 15000
#endif

#endif
