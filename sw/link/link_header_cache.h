/* SPDX-License-Identifier: MIT
 *
 * link_header_cache: compresses the heads of IceP messages. Each head is sent once, and named by
 * one byte afterwards.
 *
 * This is the only part of the layer that knows Ice's messages ("The Ice Protocol" in the manual of
 * ZeroC Ice 3.7). It does not change a message that it does not recognise. Tokens, and why both
 * sides' caches stay equal: docs/link.md.
 */
#pragma once

#include "link_frame.h"

#define LINK_HEAD_AT 18U    /* offset of the head in a request: after Ice's header and request id */
#define LINK_HEADS 16U      /* request heads cached for each direction */
#define LINK_HEAD_BYTES 64U /* largest cached head, bytes: 62 and the encoding's version */
#define LINK_HEAD_ROOM 96U  /* bytes that decompression may add before a message */
#define LINK_ESCAPE 1U      /* marks messages that are not Ice's */

/* Request heads that have passed in one direction: identity, facet, operation, mode and context. */
typedef struct Link_HeaderCache {
    U32 lastRequest[LINK_CHANNELS], lastReply[LINK_CHANNELS]; /* newest ids */
    U8 next;                              /* index that the next new head takes */
    U8 size[LINK_HEADS];                  /* bytes; 0: empty */
    U8 head[LINK_HEADS][LINK_HEAD_BYTES]; /* head, then the encoding's version */
} Link_HeaderCache;

/* A compressed message: bytes[0..prefix), then `middle` bytes of the original's head, then the
 * original's bytes from `tailAt`. */
typedef struct Link_Compressed {
    U8 bytes[8];
    U32 prefix, middle, tailAt;
    U32 head; /* header that both sides cache (link_cacheHeader), or 0 */
} Link_Compressed;

/* Compresses a message. `to` is zeroed on entry, which represents the unchanged message. */
void link_compress(const Link_HeaderCache* cache, int channel, const U8* m, U32 size,
                   Link_Compressed* to);

/* Caches the head of a message that has passed, on both sides alike. */
void link_cacheHeader(Link_HeaderCache* cache, int channel, const U8* m, U32 head);

/* Restores the message of `size` bytes at `start`, with LINK_HEAD_ROOM bytes of room before it.
 * Returns its new start; its end is unchanged. Returns 0 if the message is malformed. */
U8* link_decompress(Link_HeaderCache* cache, int channel, U8* start, U32 size);
