/* SPDX-License-Identifier: MIT
 *
 * link_compression: compresses the heads of IceP messages: each is sent once, and named by a byte
 * afterwards.
 *
 * It is the only part of this layer that knows what an Ice message looks like ("The Ice Protocol"
 * in the manual of ZeroC Ice 3.7). It does not change one that it does not recognise. Tokens, and
 * why both sides' tables stay equal: docs/link.md.
 */
#pragma once

#include "link_wire.h"

#define LINK_HEAD_AT 18U    /* start of the head in a request: behind header and request id */
#define LINK_HEADS 16U      /* request heads that each direction keeps */
#define LINK_HEAD_BYTES 64U /* of one: up to 62, and the encoding's version */
#define LINK_HEAD_ROOM 96U  /* bytes that decompression may add in front of a message */
#define LINK_ESCAPE 1U      /* a byte that marks messages other than Ice's */

/* Request heads that have passed in one direction. */
typedef struct Link_Heads {
    U32 lastRequest[LINK_CHANNELS], lastReply[LINK_CHANNELS];
    U8 next; /* slot that the next new one takes */
    U8 size[LINK_HEADS];
    U8 head[LINK_HEADS][LINK_HEAD_BYTES];
} Link_Heads;

/* A compressed message: bytes[0..prefix), `middle` bytes of its head, the rest from tailAt. `head`
 * is the size of its head; 0: nothing to remember. */
typedef struct Link_Packed {
    U8 bytes[8];
    U32 prefix, middle, tailAt, head;
} Link_Packed;

/* Compresses the message: changes `packed`, which stands for the unchanged one on entry. */
void link_compress(const Link_Heads* heads, int channel, const U8* m, U32 size,
                   Link_Packed* packed);
/* Remembers the head of a message that has passed, on both sides alike. */
void link_note(Link_Heads* heads, int channel, const U8* m, U32 size, U32 head);
/* Restores the message of `size` bytes at `start`, with LINK_HEAD_ROOM bytes in front of it.
 * Returns where it begins now; it ends where it did. 0: it is malformed. */
U8* link_decompress(Link_Heads* heads, int channel, U8* start, U32 size);
