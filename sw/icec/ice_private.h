/* SPDX-License-Identifier: MIT
 *
 * ice_private: what IceC's own files share.
 */
#ifndef ICE_PRIVATE_H
#define ICE_PRIVATE_H

#include "icec.h"

enum { ICE_REQUEST, ICE_BATCH, ICE_REPLY, ICE_VALIDATE, ICE_CLOSE };
#define ICE_HEADER 14

/* The 14 bytes before every message; its size is set by Ice_endMessage. */
void Ice_beginMessage(Ice_OutputStreamPtr os, Ice_Byte type);
void Ice_endMessage(Ice_OutputStreamPtr os);
/* Overwrites four bytes. */
void Ice_patchInt(Ice_OutputStreamPtr os, Ice_Int at, Ice_Int value);
/* Size and encoding of an encapsulation; endEncapsulation fills the size in. */
Ice_Int Ice_beginEncapsulation(Ice_OutputStreamPtr os);
void Ice_endEncapsulation(Ice_OutputStreamPtr os, Ice_Int begin);
/* Narrows `is` to the encapsulation that follows. ICE_PROTOCOL: an encoding other than 1.0 and 1.1. */
Ice_Status Ice_enterEncapsulation(Ice_InputStreamPtr is);

Ice_Status Ice_sendPlain(Ice_CommunicatorPtr ic, int connection, Ice_Byte type);
void Ice_dispatchMessage(Ice_CommunicatorPtr ic, int connection, Ice_InputStreamPtr is);
void Ice_dispatchBatch(Ice_CommunicatorPtr ic, int connection, Ice_InputStreamPtr is);
void Ice_takeReply(Ice_CommunicatorPtr ic, Ice_InputStreamPtr is);
void Ice_failCalls(Ice_CommunicatorPtr ic, int connection);
void Ice_wakeCalls(Ice_CommunicatorPtr ic);

#endif
