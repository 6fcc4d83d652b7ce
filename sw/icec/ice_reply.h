/* SPDX-License-Identifier: MIT
 *
 * ice_reply: the full run time's replies.
 */
#ifndef ICE_REPLY_H
#define ICE_REPLY_H

#include "ice_message.h"

/* Sends the results at ICEC_REPLY_HEAD of `os`, or the failure `status` with its reason in words;
 * under ICE_LOCK_SEND. `target` 0: the target is no longer known. */
Ice_Status icec_sendReply(Ice_CommunicatorPtr ic, int connection, Ice_OutputStreamPtr os,
                          Ice_Int id, Ice_Status status, const Icec_Target* target);

#endif
