/* SPDX-License-Identifier: MIT
 *
 * link_pacing: puts frames into packets, and passes each packet to the radio at the right time. If
 * the radio reports results, the right time is when only few packets wait for a result; otherwise,
 * it is when the modem has sent the previous packets.
 */
#pragma once

#include "link_backoff.h"
#include "link_env.h"

struct Link;

#define LINK_STREAM 3U /* least number of fragments in flight that counts as a stream */

/* Packets for which the radio has not reported a result yet. All links of one radio share this
 * list. */
typedef struct Link_Unanswered {
    U8 first, waiting;                      /* index of the oldest packet; number of packets */
    struct Link* owners[LINK_MOST_WAITING]; /* link that sent each packet, by the packet's index */
} Link_Unanswered;

/* In each part of the link, small fields that are often used come first, because short instructions
 * can only reach low offsets. */
typedef struct Link_Pacing {
    U8 longest; /* largest payload of a frame that is sent, bytes */
    U8 packed;  /* number of bytes in the packet */
    /* size of a frame that was received since the last packet was sent, bytes; 0 without
     * such a frame */
    U8 heard;
    U8 isStream; /* 1: several fragments are in flight, so packets follow each other closely */
    /* number of further packets for which the modem is assumed to be slow, because it may hold
     * packets back */
    U8 slow;
    /* number of packets that may wait for a result; 0 means that the radio reports no results */
    U8 mostWaiting;
    /* handed: packets passed to the radio, modulo 256. waiting: packets without a result. */
    U8 handed, waiting;
    U8 isHeld; /* 1: until paceUntil, only messages that overtake others may be sent */
    Link_Env env;
    const Link_Identity* session; /* identity of the current session; its key seals the frames */
    Link_Unanswered* radio;
    struct Link* owner;
    U32 byteTimeUs16; /* time of one byte on the slowest line, in units of 1/16 us */
    U32 fastest;      /* shortest round trip of the session, us */
    U32 slack;        /* the next packet may be sent this long before paceUntil, us */
    /* time at which the modem will have sent all packets that were passed to it, us */
    U32 paceUntil;
    /* a received frame ends the wait if less than this time is left, us */
    U32 early;
    U32 quietUntil;            /* end of the silence that must follow a short packet, us */
    U8 packet[LINK_MAX_FRAME]; /* packet being filled with frames */
    /* list of packets without a result; not used if this link shares the list of another link */
    Link_Unanswered own;
    Link_Backoff backoff;
} Link_Pacing;

/* Initialises a zeroed struct with its codec set. No session exists yet, and the radio reports no
 * results. */
void link_initPacing(Link_Pacing* pacing, const Link_Identity* session, struct Link* owner,
                     U32 byteTimeUs16);

/* Makes the link share the radio of another link. */
#define LINK_SHARE_ANSWERS(pacing, with) ((pacing)->radio = (with)->radio)

/* Sets how many packets may wait for a result; 0 if the radio reports no results. */
void link_limitUnanswered(Link_Pacing* pacing, U32 packets);

/* Sets the size of the largest frame, in bytes, including the codec's overhead. */
void link_limitPacket(Link_Pacing* pacing, U32 bytes);

/* Ends the pause, so that the next packet may be sent now. An old paceUntil is not kept, because it
 * would look like a future time after the clock has wrapped around. */
#define LINK_END_PAUSE(pacing) ((pacing)->paceUntil = (pacing)->env.now)

/* Returns whether only a message that overtakes others may be sent now. */
#define LINK_IS_HELD(pacing)                                \
    ((pacing)->isHeld && !(pacing)->packed &&               \
     LINK_BEFORE((pacing)->env.now, (pacing)->paceUntil) && \
     (pacing)->radio->waiting < (pacing)->mostWaiting)

/* Records a measured round trip. */
void link_noteRoundTrip(Link_Pacing* pacing, U32 us);

/* Forgets the round trips of the previous session. */
#define LINK_FORGET_ROUND_TRIPS(pacing) ((pacing)->fastest = LINK_RTO_FIRST)

/* Records how many fragments are in flight. */
#define LINK_NOTE_IN_FLIGHT(pacing, fragments) ((pacing)->isStream = (fragments) >= LINK_STREAM)

/* Records that a frame of `size` bytes was received. */
void link_hear(Link_Pacing* pacing, U32 size);

/* Removes the oldest packet that waits for the radio's result. Returns its link; 0 if none
 * waits. */
struct Link* link_takeAnswered(Link_Pacing* pacing);

/* Processes the radio's result for the oldest packet of this link. `silence` is the time since the
 * peer was heard, us. Returns the packet's number, as counted by `handed`. */
U32 link_paceByAnswer(Link_Pacing* pacing, int isDelivered, U32 silence);

/* Returns whether a fragment may be sent now: either the current packet has room, or the modem
 * has room for a new packet. */
int link_isOpen(Link_Pacing* pacing);

/* Returns the largest payload of a frame that fits into the packet, bytes; only valid if
 * link_isOpen has returned 1. */
U32 link_room(const Link_Pacing* pacing);

/* Passes the packet, which contains at least one frame, to the radio. Returns 0 if the radio has no
 * room; the packet is then kept. */
int link_flush(Link_Pacing* pacing);

/* Seals a frame with its payload in place, adds the frame to the packet, and passes the packet to
 * the radio at once if the radio has room. Returns 1 if the frame is in the packet. */
int link_sendNow(Link_Pacing* pacing, U8* frame, U32 header, const Link_Seal* seal);

/* Uses the session's key to seal a frame with its payload in place, and adds the frame to the
 * packet. The packet may then wait for more frames. The lowest byte of `number` is byte 1 of the
 * header. `acked` is the number that a PIGGYBACK acknowledges; otherwise 0. Returns 1 if the
 * frame is in the packet. */
int link_sendFrame(Link_Pacing* pacing, U8* frame, U32 header, U32 number, U32 acked);

/* Sends a control frame of the session at once; its payload of `size` bytes is in place, and byte 1
 * of its header is the lowest byte of `number`. Returns 1 if the frame is in the packet. */
int link_sendControl(Link_Pacing* pacing, U8* frame, U32 byte2, U32 number, U32 size);
