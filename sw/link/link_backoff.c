/* SPDX-License-Identifier: MIT
 *
 * link_backoff: measures traffic and losses, and decides from them how long this side waits before
 * it sends.
 */
#include "link_backoff.h"

#include "link_config.h"
#include "link_frame.h"

/* A loss is called quick if the radio reported it about as fast as it reports a delivered packet.
 * The modem has then made no retries, so the loss was not a collision: after a collision, the modem
 * retries. If neither side sends a stream, this side must pause after a loss. The pause doubles
 * after each further loss, and shrinks to a quarter after each delivered packet. The limit of the
 * pause grows with the peer's silence. */
U32 link_noteAnswer(Link_Backoff* c, U32 now, int isDelivered, U32 silence, int isBusy) {
    U32 took = now - c->begunAt;
    U32 last = LINK_REST_LAST + 4U * silence;
    int wasBusy = c->isBusy;
    c->quick -= c->quick / 128U;
    c->begunAt = LINK_BEFORE(now, c->readyAt) ? c->readyAt : now;
    c->isBusy = (U8)isBusy;
    if (isDelivered) {
        c->rest /= 4U;
        if (wasBusy)
            c->usualUs += took / 16U - c->usualUs / 16U;
        return 0;
    }
    if (took < c->usualUs + c->usualUs / 4U)
        c->quick += 65536U / 128U;
    c->rest = 2U * c->rest + LINK_REST_FIRST;
    if (c->rest > last)
        c->rest = last;
    c->hasLost = 1;
    c->lostAt = now;
    return c->own.isStream || c->peers.isStream ? 0U : c->rest;
}

/* Decides whether a side sends a stream. `bytes` is the total of the bytes that the side has sent.
 * `spans` is the number of spans of time that have ended since the last update; 0 means that the
 * current span has not ended yet. */
static void judge(Link_Traffic* traffic, U32 bytes, U32 spans) {
    U32 more = bytes - traffic->before;
    if (more >= LINK_SPAN_MANY * (spans ? spans : 1U))
        traffic->isStream = 1;
    else if (more < LINK_SPAN_FEW * spans)
        traffic->isStream = 0;
    if (spans)
        traffic->before = bytes;
}

U32 link_chooseWait(Link_Backoff* c, U32 now, const Link_Statistics* counts, U32 isSlow) {
    U32 spans = (now - c->since) / LINK_SPAN;
    judge(&c->own, counts->bytesSent, spans);
    judge(&c->peers, counts->bytesReceived, spans);
    if (spans && !c->peers.isStream)
        c->isCalled = 0;
    if (c->own.isStream && counts->messagesReceived != c->messages)
        c->isCalled = 1;
    if (spans) {
        c->since = now;
        c->messages = counts->messagesReceived;
    }
    if (now - c->lostAt >= LINK_LOSS_COUNTS)
        c->hasLost = 0;
    if (c->own.isStream && c->peers.isStream)
        return c->quick > LINK_QUICK_MANY && !isSlow ? 0U : LINK_WAIT_SHARED;
    if (c->peers.isStream || c->isCalled || (c->hasLost && !c->own.isStream))
        return LINK_WAIT_SHARED;
    return 0;
}
