/* SPDX-License-Identifier: MIT
 *
 * ice_dispatch: incoming requests, from the message to the servant and back.
 */
#ifndef ICE_DISPATCH_H
#define ICE_DISPATCH_H

#include "icec.h"

/* Executes a request, or a batch of them, and answers. Returns ICE_OK whatever the result;
 * ICE_CONNECTION_LOST: the message is malformed. */
Ice_Status icec_dispatchRequest(Ice_CommunicatorPtr ic, int connection, Ice_InputStreamPtr is);
Ice_Status icec_dispatchBatch(Ice_CommunicatorPtr ic, int connection, Ice_InputStreamPtr is);

#endif
