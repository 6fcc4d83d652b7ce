/* SPDX-License-Identifier: MIT
 *
 * ice_message: what the full and the minimal run time share: IceP's messages as bytes (their heads,
 * their check, requests, replies, encapsulations), and functions that make proxies.
 */
#pragma once

#include "icec.h"

enum { ICEC_REQUEST, ICEC_BATCH, ICEC_REPLY, ICEC_VALIDATE, ICEC_CLOSE }; /* types of messages */
#define ICEC_HEADER 14
#define ICEC_REPLY_BODY 19 /* start of a reply's encapsulation, after header, id and status */
#define ICEC_REPLY_HEAD 25 /* start of a reply's results */

/* Empties a stream, and writes the head of a message; icec_endMessage fills its size in. */
void icec_beginMessage(Ice_OutputStreamPtr os, Ice_Byte type);
void icec_endMessage(Ice_OutputStreamPtr os);
/* Checks the head of a message of is->size bytes, and skips it. Returns the type of the message,
 * greater than 0xFF if it is compressed; -1 if it is not a message of IceP 1.0. */
Ice_Int icec_readHead(Ice_InputStreamPtr is);

/* Writes size and encoding of an encapsulation, and returns its begin, which icec_endEncapsulation
 * takes to fill the size in. */
Ice_Int icec_beginEncapsulation(Ice_OutputStreamPtr os);
void icec_endEncapsulation(Ice_OutputStreamPtr os, Ice_Int begin);
/* Narrows `is` to the encapsulation that follows. ICE_MARSHAL: malformed; ICE_PROTOCOL: the
 * encoding is neither 1.0 nor 1.1. */
Ice_Status icec_enterEncapsulation(Ice_InputStreamPtr is);

/* Writes and reads a facet in the wire's form: a sequence of no string or one. More are malformed,
 * as for Ice. */
void icec_writeFacet(Ice_OutputStreamPtr os, const Ice_String* facet);
void icec_readFacet(Ice_InputStreamPtr is, Ice_String* facet);
void icec_skipStrings(Ice_InputStreamPtr is, U32 count);

/* Identity, facet and operation of a request as its bytes: failed replies repeat them. */
typedef struct Icec_Target {
    const Ice_Byte* data;
    Ice_Int size;
} Icec_Target;

/* Writes a reply from its id to the begin of its results. */
void icec_beginReply(Ice_OutputStreamPtr os, Ice_Int id);
/* Sets the reply's status. A failure replaces the results; its reason text is empty. */
void icec_endReply(Ice_OutputStreamPtr os, Ice_Status status, const Icec_Target* target);
/* Reads a reply's status, and narrows `is` to its results or exception. Returns the status, or why
 * the reply is malformed. */
Ice_Status icec_readReply(Ice_InputStreamPtr is);

/* ---- ice_proxy ---- */

/* Makes a null proxy. */
void icec_initProxy(Ice_ObjectPrxPtr prx, Ice_CommunicatorPtr ic);
/* Sets name, category and facet; the last two may be 0. ICE_LIMIT: longer than ICE_IDENTITY_MAX. */
Ice_Status icec_setIdentity(Ice_ObjectPrxPtr prx, const Ice_String* name,
                            const Ice_String* category, const Ice_String* facet);
/* Prints an endpoint with the transport that supports it, as Ice_Endpoint's print; returns 0 if
 * none does. */
int icec_printEndpoint(Ice_CommunicatorPtr ic, const Ice_Byte* encoded, Ice_Int size,
                       Ice_OutputStreamPtr text);
/* Write characters, and a number in decimal, without a size before them. */
void icec_put(Ice_OutputStreamPtr os, const char* text);
void icec_putNumber(Ice_OutputStreamPtr os, U32 value);
/* Splits "category/name", or "name". */
Ice_Identity icec_parseIdentity(const char* text);
