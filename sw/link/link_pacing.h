/* SPDX-License-Identifier: MIT
 *
 * link_pacing: puts frames into packets, and hands each packet to the radio at the right time. With
 * a radio that answers, this is when only few packets wait for an answer; without answers, when the
 * modem has sent the previous packets.
 */
#pragma once

#include "link_backoff.h"
#include "link_env.h"

struct Link;

#define LINK_STREAM 3U /* number of fragments in flight that make a stream */

/* Packets that wait for the answers of a radio. All links of one radio share this list. */
typedef struct Link_Unanswered {
    U8 first, waiting;                      /* index of the oldest packet; number of packets */
    struct Link* owners[LINK_MOST_WAITING]; /* link of each packet, by its index */
} Link_Unanswered;

/* In each part, small fields that are often used come first, because short instructions can only
 * reach low offsets. */
typedef struct Link_Pacing {
    U8 longest;  /* largest payload of a frame that is sent, bytes */
    U8 packed;   /* bytes in the packet */
    U8 heard;    /* bytes of a frame received since the last packet was sent, or 0 */
    U8 isStream; /* 1: several fragments are in flight, packets follow each other */
    /* number of further packets that are sent as if the modem was slow, because it may hold packets
     * back */
    U8 slow;
    U8 mostWaiting;     /* packets that may wait for a result; 0: the radio reports none */
    U8 handed, waiting; /* packets handed over, modulo 256; packets without a result */
    U8 isHeld;          /* 1: until paceUntil only a message that overtakes is sent */
    Link_Env env;
    const Link_Identity* session; /* identity (session) with which frames are sealed */
    Link_Unanswered* radio;
    struct Link* owner;
    U32 byteTimeUs16; /* time of one byte on the slowest line, 1/16 us */
    U32 fastest;      /* shortest round trip of the session, us */
    U32 slack;        /* time before paceUntil at which the next packet may be sent, us */
    U32 paceUntil;    /* time at which the modem will have sent all packets handed over, us */
    U32 early;        /* largest reduction of the wait after a received frame, us */
    U32 quietUntil;   /* end of the silence after a short packet, us */
    U8 packet[LINK_MAX_FRAME]; /* packet being filled with frames */
    /* this link's list of unanswered packets, used unless the list of another link is shared */
    Link_Unanswered own;
    Link_Backoff backoff;
} Link_Pacing;

/* Initialises a zeroed struct with a codec. There is no session yet, and the radio gives no
 * answers. */
void link_initPacing(Link_Pacing* pacing, const Link_Identity* session, struct Link* owner,
                     U32 byteTimeUs16);

/* Makes the link share the radio of another link. */
#define LINK_SHARE_ANSWERS(pacing, with) ((pacing)->radio = (with)->radio)

/* Sets how many packets may wait for a result; 0 if the radio reports no results. */
void link_limitUnanswered(Link_Pacing* pacing, U32 packets);

/* Sets the size of the largest frame, in bytes, including the codec's overhead. */
void link_limitPacket(Link_Pacing* pacing, U32 bytes);

/* Allows the next packet to be sent now. An old paceUntil must not stay, because it could be
 * read as a future time. */
#define LINK_END_PAUSE(pacing) ((pacing)->paceUntil = (pacing)->env.now)

/* Returns whether only a message that overtakes may be sent now. */
#define LINK_IS_HELD(pacing)                                \
    ((pacing)->isHeld && !(pacing)->packed &&               \
     LINK_BEFORE((pacing)->env.now, (pacing)->paceUntil) && \
     (pacing)->radio->waiting < (pacing)->mostWaiting)

/* Records a measured round trip. */
void link_noteRoundTrip(Link_Pacing* pacing, U32 us);

/* Forgets the round trips of the previous session. */
#define LINK_FORGET_ROUND_TRIPS(pacing) ((pacing)->fastest = LINK_RTO_FIRST)

/* Records the number of fragments in flight. */
#define LINK_NOTE_IN_FLIGHT(pacing, fragments) ((pacing)->isStream = (fragments) >= LINK_STREAM)

/* Records that a frame of `size` bytes was received. */
void link_hear(Link_Pacing* pacing, U32 size);

/* Removes the oldest packet that waits for the radio's result. Returns its link; 0 if none
 * waits. */
struct Link* link_takeAnswered(Link_Pacing* pacing);

/* Processes the radio's answer for the oldest packet of this link. `silence` is the time since the
 * peer was heard, us. Returns the packet's number as counted by `handed`. */
U32 link_paceByAnswer(Link_Pacing* pacing, int isDelivered, U32 silence);

/* Returns whether a fragment may be sent now: either the current packet has room, or the modem
 * has room for a new packet. */
int link_isOpen(Link_Pacing* pacing);

/* Returns the largest payload of a frame that fits into the packet, bytes; valid if link_isOpen. */
U32 link_room(const Link_Pacing* pacing);

/* Hands the packet, which contains at least one frame, to the radio. Returns 0 if the radio has
 * no room; the packet is then kept. */
int link_flush(Link_Pacing* pacing);

/* Seals a frame with its payload in place, adds it to the packet, and hands the packet to the radio
 * at once if the radio has room. Returns 1 if the frame is in the packet. */
int link_sendNow(Link_Pacing* pacing, U8* frame, U32 header, const Link_Seal* seal);

/* Seals a frame with its payload in place with the session's key, and adds the frame to the packet,
 * which may wait for more frames. `number` has byte 1 of the header as its lowest byte; `acked` is
 * the number that a PIGGYBACK acknowledges, otherwise 0. Returns 1 if the frame is in the
 * packet. */
int link_sendFrame(Link_Pacing* pacing, U8* frame, U32 header, U32 number, U32 acked);

/* Sends a control frame of the session at once, with a payload of `size` bytes in place; byte 1 is
 * the lowest byte of `number`. Returns 1 if the frame is in the packet. */
int link_sendControl(Link_Pacing* pacing, U8* frame, U32 byte2, U32 number, U32 size);
