/* SPDX-License-Identifier: MIT
 *
 * link_liveness: detects whether the peer is still there. It records signs of life, sends PING to a
 * silent peer, and decides when the peer counts as lost. With a key, PINGs are numbered, because an
 * attacker may have recorded any other frame.
 */
#pragma once

#include "link_pacing.h"

typedef struct Link_Liveness {
    Link_Pacing* pacing;
    /* The following fields are set when a session begins. */
    U32 pingsSent; /* number of the newest PING of this side */
    /* number of the newest PING of this side that was answered; all older PINGs also count as
     * answered */
    U32 pingsAnswered;
    U32 askedAt;   /* time of the first PING that has no answer yet, us */
    U32 pingsSeen; /* number of the peer's newest PING */
    U32 heardAt;   /* time of the last sign of life, us */
    /* latest time at which the peer was certainly there, us; with a key, the time of a PING that
     * was answered */
    U32 provenAt;
    U32 pingAt; /* earliest time of the next PING, us */
} Link_Liveness;

/* Starts the detection with a peer that has just been heard. */
void link_resetLiveness(Link_Liveness* liveness);

/* Records a sign of life. */
#define LINK_NOTE_ALIVE(liveness) ((liveness)->heardAt = (liveness)->pacing->env.now)

/* Records that a frame of the session has arrived. Without a key, each frame proves that the peer
 * is there. */
void link_noteFrame(Link_Liveness* liveness);

/* Processes a PING with a key, or the answer to a PING. Answers a PING. */
void link_onPing(Link_Liveness* liveness, const U8* frame);

/* Sends PING to a silent peer. Returns 0 if the peer has been silent too long. */
int link_pollLiveness(Link_Liveness* liveness);

/* Returns the time at which link_pollLiveness must be called next, us. */
U32 link_livenessDeadline(const Link_Liveness* liveness);
