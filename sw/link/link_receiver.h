/* SPDX-License-Identifier: MIT
 *
 * link_receiver: puts fragments in order, assembles messages, and acknowledges them.
 */
#pragma once

#include "link_channels.h"
#include "link_header_cache.h"
#include "link_pacing.h"

/* Reorder slot: a fragment that arrived before its turn. */
typedef struct Link_ReorderSlot {
    U8 flags; /* flags, as in the frame, with LINK_ACK_NOW; 0: the slot is free */
    U8 size;  /* bytes; LINK_TAKEN: the program has already taken it */
    U8 bytes[LINK_MAX_PAYLOAD];
} Link_ReorderSlot;
#define LINK_TAKEN 0xFFU

/* Size of the buffer for a message of up to `maxMessage` bytes as it arrives, with room before it
 * for its head. */
#define LINK_ROOM(maxMessage) (LINK_HEAD_ROOM + LINK_ARRIVING(maxMessage))
#define LINK_ARRIVING(maxMessage) ((maxMessage) + LINK_ESCAPE + LINK_CHECK)

typedef struct Link_Receiver {
    Link_Pacing* pacing;
    Link_ReorderSlot* slots; /* the caller's */
    U8* message;             /* the caller's, for long messages: LINK_ROOM bytes */
    Link_Channels channels;
    U8 mask;     /* slots less one */
    U16 longest; /* largest long message as it arrives, bytes */
    /* The following fields are 0 when a session begins. */
    U8 isAssembling;        /* 1: between the first and last fragment of a long message */
    U8 isHeld;              /* 1: a message is complete, but the program has not taken it */
    U8 channel;             /* channel of the complete message */
    U8 longChannel;         /* channel of the long message that is being assembled */
    U8 ackDue;              /* 1: an acknowledgement goes out at `ackAt` */
    U8 ackNow;              /* 1: it is sent at once */
    U8 waiting;             /* slots in use */
    U8 packet;              /* packet of the last acknowledgement, as Link_Pacing.handed counts */
    U16 size;               /* bytes of the complete message */
    U16 longSize;           /* bytes of the long message so far */
    U32 expected;           /* number of the next fragment of the peer, sent in acknowledgements */
    U32 ackAt;              /* time at which the acknowledgement is due, us */
    U8* start;              /* start of the complete message */
    Link_HeaderCache heads; /* heads of received messages */
    U8 brief[LINK_HEAD_ROOM + LINK_MAX_PAYLOAD]; /* message of one fragment */
} Link_Receiver;

/* Resets to the state without a session. Wipes received bytes if `isWiped`. */
void link_resetReceiver(Link_Receiver* receiver, int isWiped);

/* Takes a fragment. Returns 0 if the peer broke the rules, as does link_pollReceiver: then none of
 * its data can be trusted, and the session must end. */
int link_onData(Link_Receiver* receiver, U32 seq, U32 flags, const U8* data, U32 size);

/* Offers a held message again. */
int link_pollReceiver(Link_Receiver* receiver);

/* Schedules an acknowledgement to go out soon. */
void link_scheduleAck(Link_Receiver* receiver);

/* Returns whether an acknowledgement is due and fits on a PIGGYBACK, which has no room for gaps. */
int link_canPiggyback(const Link_Receiver* receiver);

/* Notes that an acknowledgement was sent. */
void link_noteAckSent(Link_Receiver* receiver);

/* Sends an acknowledgement if one is due. */
void link_pollAck(Link_Receiver* receiver);
