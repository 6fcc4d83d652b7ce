/* SPDX-License-Identifier: MIT
 *
 * link_liveness: records signs of life of the peer, and asks for them with PING.
 */
#include "link_liveness.h"

#include <stddef.h>
#include <string.h>

#define LATER(a, b) (LINK_BEFORE(a, b) ? (b) : (a))

void link_resetLiveness(Link_Liveness* liveness) {
    memset(&liveness->pingsSent, 0,
           offsetof(Link_Liveness, heardAt) - offsetof(Link_Liveness, pingsSent));
    liveness->heardAt = liveness->provenAt = liveness->pingAt = liveness->pacing->env.now;
}

void link_noteFrame(Link_Liveness* liveness) {
    U32 now = liveness->pacing->env.now;
    if (!liveness->pacing->env.codec->isAuthenticated)
        liveness->heardAt = liveness->provenAt = now;
    if (!LINK_BEFORE(now, liveness->pingAt))
        /* keeps pingAt recent: if it were older than half the range of the clock, it would look
         * like a future time */
        liveness->pingAt = now;
}

void link_onPing(Link_Liveness* liveness, const U8* frame) {
    U8 answer[LINK_MAX_OVERHEAD];
    U32 number;
    if (frame[2] & LINK_PING_ANSWER) {
        number = link_extend(liveness->pingsSent, frame[1]);
        if (LINK_BEFORE(liveness->pingsAnswered, number) &&
            !LINK_BEFORE(liveness->pingsSent, number)) {
            liveness->pingsAnswered = liveness->pingsSent;
            /* uses the time of the PING, not the current time, because the answer may have been
             * delayed */
            liveness->provenAt = liveness->askedAt;
            LINK_NOTE_ALIVE(liveness);
        }
        return;
    }
    number = link_extend(liveness->pingsSeen, frame[1]);
    if (!LINK_BEFORE(liveness->pingsSeen, number))
        return; /* heard before */
    liveness->pingsSeen = number;
    LINK_NOTE_ALIVE(liveness);
    (void)link_sendControl(liveness->pacing, answer,
                           LINK_KIND_BITS(LINK_KIND_PING) | LINK_PING_ANSWER, number, 0);
}

int link_pollLiveness(Link_Liveness* liveness) {
    const Link_Env* env = &liveness->pacing->env;
    U32 silence = env->now - liveness->heardAt;
    U32 proof = env->now - liveness->provenAt;
    U8 frame[LINK_MAX_OVERHEAD];
    if (silence >= LINK_DEAD_AFTER || proof >= LINK_PROOF_LAST)
        return 0;
    if ((silence >= LINK_PING_AFTER || proof >= LINK_PROOF_AFTER) &&
        !LINK_BEFORE(env->now, liveness->pingAt)) {
        if (liveness->pingsAnswered == liveness->pingsSent)
            liveness->askedAt = env->now;
        liveness->pingsSent += env->codec->isAuthenticated;
        (void)link_sendControl(liveness->pacing, frame, LINK_KIND_BITS(LINK_KIND_PING),
                               liveness->pingsSent, 0);
        liveness->pingAt = env->now + liveness->pacing->backoff.rest / 16U +
                           (silence >= LINK_PING_AFTER ? LINK_PING_EVERY : LINK_PROOF_EVERY);
    }
    return 1;
}

U32 link_livenessDeadline(const Link_Liveness* liveness) {
    U32 ask = liveness->heardAt + LINK_PING_AFTER;
    U32 prove = liveness->provenAt + LINK_PROOF_AFTER;
    if (LINK_BEFORE(prove, ask))
        ask = prove;
    return LATER(ask, liveness->pingAt);
}
