/* SPDX-License-Identifier: MIT
 *
 * link_receiver: puts fragments into order, assembles messages, and acknowledges fragments.
 */
#pragma once

#include "link_channels.h"
#include "link_header_cache.h"
#include "link_pacing.h"

/* Reorder slot, which holds a fragment that arrived before an earlier one. */
typedef struct Link_ReorderSlot {
    U8 flags; /* flags of the frame, and LINK_ACK_NOW; 0 if the slot is free */
    /* size of the fragment, bytes; LINK_TAKEN if the program has already accepted its message */
    U8 size;
    U8 bytes[LINK_MAX_PAYLOAD];
} Link_ReorderSlot;
#define LINK_TAKEN 0xFFU

/* Size of the buffer for an arriving message of up to `maxMessage` bytes, including room for its
 * header. */
#define LINK_ROOM(maxMessage) (LINK_HEAD_ROOM + LINK_ARRIVING(maxMessage))
#define LINK_ARRIVING(maxMessage) ((maxMessage) + LINK_ESCAPE + LINK_CHECK)

typedef struct Link_Receiver {
    Link_Pacing* pacing;
    Link_ReorderSlot* slots; /* reorder slots, owned by the caller */
    U8* message;             /* buffer for long messages, LINK_ROOM bytes, owned by the caller */
    Link_Channels channels;
    U8 mask;     /* number of slots minus 1 */
    U16 longest; /* size of the largest message of several fragments that may arrive, bytes */
    /* The following fields are 0 when a session begins. */
    U8 isAssembling; /* 1: the first fragment of a long message has arrived, the last one has not */
    U8 isHeld;       /* 1: a message is complete, but the program has not accepted it */
    U8 channel;      /* channel of the complete message */
    U8 longChannel;  /* channel of the long message that is being assembled */
    U8 ackDue;       /* 1: an acknowledgement is sent at `ackAt` */
    U8 ackNow;       /* 1: an acknowledgement is sent at once */
    U8 waiting;      /* number of slots in use */
    /* number of the packet that contained the last acknowledgement, as counted by
     * Link_Pacing.handed */
    U8 packet;
    U16 size;     /* size of the complete message, bytes */
    U16 longSize; /* number of bytes of the long message that have arrived */
    /* number of the next fragment that is expected from the peer; sent in acknowledgements */
    U32 expected;
    U32 ackAt;              /* time at which the acknowledgement is due, us */
    U8* start;              /* first byte of the complete message */
    Link_HeaderCache heads; /* headers of received messages, for decompression */
    U8 brief[LINK_HEAD_ROOM + LINK_MAX_PAYLOAD]; /* buffer for a message of one fragment */
} Link_Receiver;

/* Resets the receiver to its state without a session. Wipes received bytes if `isWiped` is not
 * 0. */
void link_resetReceiver(Link_Receiver* receiver, int isWiped);

/* Processes a fragment. Returns 0 if the peer violated the protocol; its data can then not be
 * trusted, and the session must end. link_pollReceiver returns 0 in the same case. */
int link_onData(Link_Receiver* receiver, U32 seq, U32 flags, const U8* data, U32 size);

/* If the program has not accepted a complete message yet, offers the message again. */
int link_pollReceiver(Link_Receiver* receiver);

/* Schedules an acknowledgement after a short time. */
void link_scheduleAck(Link_Receiver* receiver);

/* Returns whether an acknowledgement is due and can be sent in a PIGGYBACK, which has no room for a
 * bitmap. */
int link_canPiggyback(const Link_Receiver* receiver);

/* Records that an acknowledgement was sent. */
void link_noteAckSent(Link_Receiver* receiver);

/* Sends an acknowledgement if one is due. */
void link_pollAck(Link_Receiver* receiver);
