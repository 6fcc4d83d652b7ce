/* SPDX-License-Identifier: MIT
 *
 * link_liveness: whether the peer still lives. It notes signs of life, asks a silent peer by PING,
 * and decides when the peer has vanished.
 *
 * Under a key, PINGs are numbered: a frame that was heard before may be a recording.
 */
#pragma once

#include "link_pacing.h"

typedef struct Link_Liveness {
    Link_Pacing* pacing;
    /* The following fields are set when a session begins. */
    U32 pingsSent;     /* number of the newest PING of this side */
    U32 pingsAnswered; /* newest own PING that is answered, or older than an answered one */
    U32 askedAt;       /* time of the first PING after that one, us */
    U32 pingsSeen;     /* number of the peer's newest PING */
    U32 heardAt;       /* time when the peer was last heard to live, us */
    U32 provenAt;      /* time at or after which the peer lived for certain, us */
    U32 pingAt;        /* earliest time of the next PING, us */
} Link_Liveness;

/* Begins with a peer that has just been heard. */
void link_resetLiveness(Link_Liveness* liveness);

/* Notes a sign of life. */
#define LINK_NOTE_ALIVE(liveness) ((liveness)->heardAt = (liveness)->pacing->env.now)

/* Notes a frame of the session. Without a key each one proves that the peer lives. */
void link_noteFrame(Link_Liveness* liveness);

/* Takes a PING under a key, or the answer to one; answers the first. */
void link_onPing(Link_Liveness* liveness, const U8* frame);

/* Sends PING to a silent peer. Returns 0 if the peer has been silent too long. */
int link_pollLiveness(Link_Liveness* liveness);

/* Returns the time of the next link_pollLiveness with an effect, us. */
U32 link_livenessDeadline(const Link_Liveness* liveness);
