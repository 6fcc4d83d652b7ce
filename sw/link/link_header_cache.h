/* SPDX-License-Identifier: MIT
 *
 * link_header_cache: compresses the heads of IceP messages. The first message with a head carries
 * all of it; later messages carry one byte that names it.
 *
 * This is the only part of the layer that knows Ice's messages ("The Ice Protocol" in the manual of
 * ZeroC Ice 3.7). It does not change a message that it does not recognise. docs/link.md describes
 * the tokens, and why the caches of both sides stay equal.
 */
#pragma once

#include "link_frame.h"

/* offset of a request's head, which follows Ice's header and the request id */
#define LINK_HEAD_AT 18U
#define LINK_HEADS 16U /* request heads cached for each direction */
/* size of the largest cached head, bytes: 62, and 2 for the version of the encoding */
#define LINK_HEAD_BYTES 64U
#define LINK_HEAD_ROOM 96U /* bytes that decompression may add before a message */
#define LINK_ESCAPE 1U     /* first byte of a message that does not have Ice's format */

/* Heads of the requests that have passed in one direction. A head consists of identity, facet,
 * operation, mode and context. */
typedef struct Link_HeaderCache {
    U32 lastRequest[LINK_CHANNELS], lastReply[LINK_CHANNELS]; /* newest ids */
    U8 next;                              /* index that the next new head takes */
    U8 size[LINK_HEADS];                  /* size of each head, bytes; 0 means empty */
    U8 head[LINK_HEADS][LINK_HEAD_BYTES]; /* the head, followed by the version of the encoding */
} Link_HeaderCache;

/* A compressed message. It consists of bytes[0..prefix), then `middle` bytes of the original head,
 * then the rest of the original message, starting at `tailAt`. */
typedef struct Link_Compressed {
    U8 bytes[8];
    U32 prefix, middle, tailAt;
    U32 head; /* the head that both sides cache next (link_cacheHeader); 0 for none */
} Link_Compressed;

/* Compresses a message. Sets `to` to zero first; if it stays zero, the message is sent
 * unchanged. */
void link_compress(const Link_HeaderCache* cache, int channel, const U8* m, U32 size,
                   Link_Compressed* to);

/* Caches the head of a message that has passed. Both sides do this for the same messages. */
void link_cacheHeader(Link_HeaderCache* cache, int channel, const U8* m, U32 head);

/* Restores the message of `size` bytes at `start`; there must be LINK_HEAD_ROOM bytes of room
 * before it. Returns the new start of the message; its end does not move. Returns 0 if the message
 * is malformed. */
U8* link_decompress(Link_HeaderCache* cache, int channel, U8* start, U32 size);
