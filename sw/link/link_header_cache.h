/* SPDX-License-Identifier: MIT
 *
 * link_header_cache: compresses the headers of IceP requests. The first message with a header
 * carries the whole header; later messages with the same header carry one byte, its index in a
 * cache.
 *
 * Only this part of the layer depends on Ice's messages ("The Ice Protocol" in the manual of ZeroC
 * Ice 3.7). Messages that it does not recognise remain unchanged. docs/link.md describes the
 * tokens, and why the caches of both sides always have the same contents.
 */
#pragma once

#include "link_frame.h"

/* offset of the header that is cached in a request, after Ice's message header and request id */
#define LINK_HEAD_AT 18U
#define LINK_HEADS 16U /* number of request headers that are cached for each direction */
/* size of the largest cached header, bytes: 62, and 2 for the version of the encoding */
#define LINK_HEAD_BYTES 64U
#define LINK_HEAD_ROOM 96U /* bytes that decompression may add before a message */
#define LINK_ESCAPE 1U     /* byte before a message that does not have Ice's format */

/* Headers of the requests sent in one direction. A header consists of identity, facet, operation,
 * mode and context. */
typedef struct Link_HeaderCache {
    U32 lastRequest[LINK_CHANNELS], lastReply[LINK_CHANNELS]; /* newest ids */
    U8 next;                              /* index at which the next new header is stored */
    U8 size[LINK_HEADS];                  /* size of each header, bytes; 0 means an empty entry */
    U8 head[LINK_HEADS][LINK_HEAD_BYTES]; /* each header, followed by the version of the encoding */
} Link_HeaderCache;

/* A compressed message. It consists of bytes[0..prefix), then `middle` bytes of the original
 * header, then the rest of the original message from offset `tailAt`. */
typedef struct Link_Compressed {
    U8 bytes[8];
    U32 prefix, middle, tailAt;
    U32 head; /* size of the header that both sides cache next (link_cacheHeader); 0 for none */
} Link_Compressed;

/* Compresses a message. Sets `to` to zero first; if `to` remains zero, the message must be sent
 * unchanged. */
void link_compress(const Link_HeaderCache* cache, int channel, const U8* m, U32 size,
                   Link_Compressed* to);

/* Caches the header of a message that was sent or received. Both sides do this for the same
 * messages in the same order. */
void link_cacheHeader(Link_HeaderCache* cache, int channel, const U8* m, U32 head);

/* Restores the message of `size` bytes at `start`. There must be LINK_HEAD_ROOM free bytes before
 * it. Returns the new start of the message; its end does not move. Returns 0 if the message is
 * malformed. */
U8* link_decompress(Link_HeaderCache* cache, int channel, U8* start, U32 size);
