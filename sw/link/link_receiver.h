/* SPDX-License-Identifier: MIT
 *
 * link_receiver: puts fragments in order, assembles messages, and acknowledges. A function with an
 * int returns 0 if the peer broke the rules: then nothing it sent can be trusted, and the session
 * must end.
 *
 * link_header_cache: compresses the heads of IceP messages: each is sent once, and named by a byte
 * afterwards.
 *
 * It is the only part of this layer that knows what an Ice message looks like ("The Ice Protocol"
 * in the manual of ZeroC Ice 3.7). It does not change one that it does not recognise. Tokens, and
 * why both sides' tables stay equal: docs/link.md.
 */
#pragma once

#include "link_pacing.h"

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
 * is what both sides are to remember of it; 0: nothing. */
typedef struct Link_Packed {
    U8 bytes[8];
    U32 prefix, middle, tailAt, head;
} Link_Packed;

/* Compresses the message: changes `packed`, which stands for the unchanged one on entry. */
void link_compress(const Link_Heads* heads, int channel, const U8* m, U32 size,
                   Link_Packed* packed);
/* Remembers the head of a message that has passed, on both sides alike. */
void link_note(Link_Heads* heads, int channel, const U8* m, U32 head);
/* Restores the message of `size` bytes at `start`, with LINK_HEAD_ROOM bytes in front of it.
 * Returns where it begins now; it ends where it did. 0: it is malformed. */
U8* link_decompress(Link_Heads* heads, int channel, U8* start, U32 size);

/* A fragment that arrived before its turn. */
typedef struct Link_Slot {
    U8 flags; /* as in the frame, with LINK_ACK_NOW; 0: the slot is free */
    U8 size;  /* LINK_TAKEN: the program has taken it before its turn */
    U8 bytes[LINK_MAX_PAYLOAD];
} Link_Slot;
#define LINK_TAKEN 0xFFU

/* Bytes for a message as it comes, and before it for its head. */
#define LINK_ROOM(maxMessage) (LINK_HEAD_ROOM + LINK_ARRIVING(maxMessage))
#define LINK_ARRIVING(maxMessage) ((maxMessage) + LINK_ESCAPE + LINK_CHECK)

typedef struct Link_Receiver {
    Link_Output* output;
    Link_Slot* slots;
    U8 mask; /* slots less one */
    /* The fields from here on are 0 when a session begins. */
    U8 isAssembling; /* between F and L */
    U8 isHeld;       /* the message is whole, but the program has not taken it */
    U8 channel;      /* of the message that is whole, ... */
    U8 longChannel;  /* and of the long one that is being put together */
    U8 ackDue, ackNow;
    U8 waiting; /* slots in use */
    U8 packet;  /* that took the last acknowledgement along, as Link_Output.handed counts */
    U16 size;   /* of the two, as channel */
    U16 longSize;
    U32 ackAt;
    U8* start;        /* of the whole message */
    Link_Heads heads; /* of messages that came */
    /* End of the fields that begin at 0. */
    U8* message; /* LINK_ROOM of the link's longest message, at its end */
    U32 longest; /* bytes of a long message as it comes */
    U8 brief[LINK_HEAD_ROOM + LINK_MAX_PAYLOAD]; /* a message of one fragment */
} Link_Receiver;

void link_resetReceiver(Link_Receiver* receiver);
int link_onData(Link_Receiver* receiver, U32 seq, U32 flags, const U8* data, U32 size);
/* Offers a held message again. */
int link_pollReceiver(Link_Receiver* receiver);
/* Has an acknowledgement go out soon. */
void link_oweAck(Link_Receiver* receiver);
/* True if an acknowledgement is due, and a piggybacked one says all of it. */
int link_ackMayRide(const Link_Receiver* receiver);
void link_ackIsSent(Link_Receiver* receiver);
void link_pollAck(Link_Receiver* receiver);
