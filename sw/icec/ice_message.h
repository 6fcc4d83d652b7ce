/* SPDX-License-Identifier: MIT
 *
 * ice_message: functions that the full and the minimal run time share. They write and read the
 * parts of Ice messages (headers, requests, replies, encapsulations), and make proxies.
 */
#pragma once

#include "icec.h"

/* Types of messages, with their numbers in the protocol. */
enum { ICEC_REQUEST, ICEC_BATCH, ICEC_REPLY, ICEC_VALIDATE, ICEC_CLOSE };
#define ICEC_HEADER 14
#define ICEC_REPLY_BODY 19 /* offset of a reply's encapsulation, after header, id and status */
#define ICEC_REPLY_HEAD 25 /* offset of a reply's results */

/* Empties a stream, and writes the header of a message. icec_endMessage later writes the size
 * into the header. */
void icec_beginMessage(Ice_OutputStreamPtr os, Ice_Byte type);
void icec_endMessage(Ice_OutputStreamPtr os);
/* Returns the size of a message from its header (ICEC_HEADER bytes), and whether the message is
 * compressed. Returns -1 if magic bytes or versions of the header differ from Ice 3, or if the
 * size is too small. */
Ice_Int icec_messageSize(const Ice_Byte* header, int* isCompressed);
/* Checks and skips the header of a message of is->size bytes. Returns the type of the message; a
 * value above 0xFF means that the message is compressed. Returns -1 if this is not a message of
 * IceP 1.0. */
Ice_Int icec_readHead(Ice_InputStreamPtr is);

/* Writes the size and the encoding of an encapsulation. Returns the start position, which
 * icec_endEncapsulation needs in order to write the size. */
Ice_Int icec_beginEncapsulation(Ice_OutputStreamPtr os);
void icec_endEncapsulation(Ice_OutputStreamPtr os, Ice_Int begin);
/* Restricts `is` to the encapsulation that follows. Returns ICE_MARSHAL if the encapsulation is
 * malformed, and ICE_PROTOCOL if its encoding is neither 1.0 nor 1.1. */
Ice_Status icec_enterEncapsulation(Ice_InputStreamPtr is);

/* Write and read a facet, which is encoded as a sequence of strings with one element, or without
 * elements if the facet is empty. A longer sequence is malformed, as in Ice. */
void icec_writeFacet(Ice_OutputStreamPtr os, const Ice_String* facet);
void icec_readFacet(Ice_InputStreamPtr is, Ice_String* facet);
void icec_skipStrings(Ice_InputStreamPtr is, U32 count);

/* Identity, facet and operation of a request, as bytes. Replies that report certain failures repeat
 * these three fields. */
typedef struct Icec_Target {
    const Ice_Byte* data;
    Ice_Int size;
} Icec_Target;

/* Writes the id of a reply, and the fields that precede the results. */
void icec_beginReply(Ice_OutputStreamPtr os, Ice_Int id);
/* Sets the status of a reply. A failure replaces the results, and has an empty text as its
 * reason. */
void icec_endReply(Ice_OutputStreamPtr os, Ice_Status status, const Icec_Target* target);
/* Reads the status of a reply, and restricts `is` to the results or the exception. Returns the
 * status of the reply, or the reason why the reply is malformed. */
Ice_Status icec_readReply(Ice_InputStreamPtr is);

/* ---- ice_proxy ---- */

/* Makes a null proxy. */
void icec_initProxy(Ice_ObjectPrxPtr prx, Ice_CommunicatorPtr ic);
/* Sets name, category and facet; the last two may be 0. Returns ICE_LIMIT if they are longer
 * than ICE_IDENTITY_MAX. */
Ice_Status icec_setIdentity(Ice_ObjectPrxPtr prx, const Ice_String* name,
                            const Ice_String* category, const Ice_String* facet);
/* Prints an endpoint with the transport that supports it (see Ice_Endpoint.print). Returns 0 if
 * no transport supports it. */
int icec_printEndpoint(Ice_CommunicatorPtr ic, const Ice_Byte* encoded, Ice_Int size,
                       Ice_OutputStreamPtr text);
/* Append text, or a number in decimal, without a size in front of it. */
void icec_put(Ice_OutputStreamPtr os, const char* text);
void icec_putNumber(Ice_OutputStreamPtr os, U32 value);
/* Splits "category/name" or "name" into an identity. */
Ice_Identity icec_parseIdentity(const char* text);
