/* SPDX-License-Identifier: MIT
 *
 * ice_dispatch: requests that come in, from the message to the servant and back.
 */
#ifndef ICE_DISPATCH_H
#define ICE_DISPATCH_H

#include "icec.h"

/* Executes a request, or a batch of them, read behind its head, and answers. ICE_OK whatever became
 * of it; ICE_CONNECTION_LOST: the message is malformed. */
Ice_Status icec_dispatchRequest(Ice_CommunicatorPtr ic, int connection, Ice_InputStreamPtr is);
Ice_Status icec_dispatchBatch(Ice_CommunicatorPtr ic, int connection, Ice_InputStreamPtr is);

#endif
