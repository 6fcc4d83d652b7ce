/* SPDX-License-Identifier: MIT
 *
 * link_backoff: back-off on a shared channel (congestion control). It measures how much both sides
 * send and which packets the radio loses. From this it decides how long a modem waits before it
 * tries to send (RN), and how long a side pauses after a loss.
 */
#pragma once

#include "base.h"
#include "link_port.h"

/* Traffic in one direction, sent by this side (`own`) or by the peer (`peers`). */
typedef struct Link_Traffic {
    U32 before;  /* total of bytes at the start of the current span of time */
    U8 isStream; /* 1: the sender of this traffic sends a stream */
} Link_Traffic;

typedef struct Link_Backoff {
    Link_Traffic own, peers;
    /* start of the current span of time, us; number of messages received before it */
    U32 since, messages;
    U32 lostAt;  /* time of the last loss, us */
    U8 hasLost;  /* 1: `lostAt` is recent */
    U8 isCalled; /* 1: the peer calls while this side sends a stream */
    /* 1: the radio has had packets to send, without a pause, since its last result */
    U8 isBusy;
    U32 readyAt; /* time at which the radio has received the newest packet, us */
    /* time at which the radio could begin with the packet that it sends now, us */
    U32 begunAt;
    U32 rest;    /* longest pause after the next loss, us */
    U32 usualUs; /* mean time per delivered packet while the radio is busy, us */
    /* share of recent packets that were lost quickly, that is without retries by the modem; 65,536
     * means all packets */
    U32 quick;
} Link_Backoff;

/* Returns whether the peer makes calls while this side sends a stream and the peer sends no
 * stream. */
#define LINK_IS_CALLED(c) ((c)->isCalled && !(c)->peers.isStream)

/* Records that a packet is passed to the radio. */
#define LINK_NOTE_PACKET(c, now) ((c)->readyAt = (now) + LINK_HAND_OVER_US)

/* Records the radio's result for a packet at time `now`. `silence` is the time since the peer was
 * heard, us. `isBusy` is 1 if the radio has further packets to send. Returns the longest pause
 * before the next packet, us; 0 means no pause. */
U32 link_noteAnswer(Link_Backoff* c, U32 now, int isDelivered, U32 silence, int isBusy);

/* Returns the RN for Link_randomWait. `isSlow` is 1 if the modem encrypts, which makes it slow. */
U32 link_chooseWait(Link_Backoff* c, U32 now, const Link_Statistics* counts, U32 isSlow);
