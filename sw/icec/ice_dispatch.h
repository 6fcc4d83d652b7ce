/* SPDX-License-Identifier: MIT
 *
 * ice_dispatch: incoming requests, from the message to the servant, and the full run time's
 * replies.
 */
#ifndef ICE_DISPATCH_H
#define ICE_DISPATCH_H

#include "ice_message.h"

/* Executes a request, or a batch of them, and answers. Returns ICE_OK whatever the result;
 * ICE_CONNECTION_LOST: the message is malformed. */
Ice_Status icec_dispatchRequest(Ice_CommunicatorPtr ic, int connection, Ice_InputStreamPtr is);
Ice_Status icec_dispatchBatch(Ice_CommunicatorPtr ic, int connection, Ice_InputStreamPtr is);

/* Sends the results at ICEC_REPLY_HEAD of `os`, or the failure `status` with its reason in words;
 * under ICE_LOCK_SEND. `target` 0: the target is no longer known. */
Ice_Status icec_sendReply(Ice_CommunicatorPtr ic, int connection, Ice_OutputStreamPtr os,
                          Ice_Int id, Ice_Status status, const Icec_Target* target);

#endif
