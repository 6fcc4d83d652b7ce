/* SPDX-License-Identifier: MIT
 *
 * ice_loop: handles arriving events, and waits for them.
 */
#ifndef ICE_LOOP_H
#define ICE_LOOP_H

#include "icec.h"

/* Handles at most one event; for the task that has the role of the receiver. ICE_TIMEOUT: there was
 * none; ICE_LIMIT: ICE_NESTING. */
Ice_Status icec_receiveOne(Ice_CommunicatorPtr ic, Ice_Int timeoutMs);

/* Receives, or lets another task receive, while `waits(ic, which)` holds; from within an operation,
 * too. `slot` belongs to the call that the task sleeps on. ICE_TIMEOUT, ICE_LIMIT. */
Ice_Status icec_await(Ice_CommunicatorPtr ic, int (*waits)(Ice_CommunicatorPtr ic, int which),
                      int which, int slot, Ice_Int timeoutMs);

#endif
