/* SPDX-License-Identifier: MIT
 *
 * link_session: starts and ends sessions, and dispatches their frames.
 */
#include "link_session.h"

/* Cost of opening a frame of the session, in rounds of Ascon. */
#define ROUNDS_OF(payload) (24U + (payload) / 2U)

void link_endSession(Link_Session* session, Link_State next) {
    const Link_Env* env = &session->handshake.pacing->env;
    Link_Channels* channels = &session->receiver.channels;
    int wasUp = session->handshake.state == LINK_STATE_UP;
    U32 open = channels->open;
    int channel;
    link_leave(&session->handshake, next);
    link_resetReceiver(&session->receiver, wasUp);
    LINK_RESET_CHANNELS(channels);
    link_resetSender(&session->sender, wasUp);
    for (channel = 0; channel < LINK_CHANNELS; ++channel)
        if (open >> channel & 1U)
            env->port->channel(env->context, channel, 0);
    if (wasUp)
        env->port->state(env->context, next);
}

void link_lose(Link_Session* session) {
    link_endSession(session, session->wanted ? LINK_STATE_CONNECTING : LINK_STATE_IDLE);
}

void link_abort(Link_Session* session) {
    U8 frame[LINK_MAX_OVERHEAD];
    if (session->handshake.state == LINK_STATE_UP)
        (void)link_sendControl(session->handshake.pacing, frame, LINK_KIND_BITS(LINK_KIND_BYE), 0,
                               0);
    link_lose(session);
}

/* Starts the session of the candidate. */
static void begin(Link_Session* session, int isUnconfirmed) {
    Link_Env* env = &session->handshake.pacing->env;
    if (session->handshake.state == LINK_STATE_UP)
        link_endSession(session, LINK_STATE_CONNECTING);
    link_adoptCandidate(&session->handshake, isUnconfirmed);
    link_resetLiveness(&session->liveness);
    LINK_END_PAUSE(session->handshake.pacing);
    session->failures = 0;
    ++env->statistics.sessions;
    env->port->state(env->context, LINK_STATE_UP);
}

int link_pollSession(Link_Session* session) {
    const Link_Handshake* handshake = &session->handshake;
    link_pollHandshake(&session->handshake);
    if (handshake->state != LINK_STATE_UP)
        return 0;
    if (session->failures >= LINK_MOST_FAILURES || session->sender.next >= LINK_LAST_NUMBER)
        link_abort(session);
    else if (!link_pollLiveness(&session->liveness))
        link_lose(session);
    return handshake->state == LINK_STATE_UP;
}

U32 link_costOf(const Link_Session* session, const U8* frame) {
    const Link_Handshake* handshake = &session->handshake;
    if (LINK_IS_HANDSHAKE(LINK_KIND_OF(frame)))
        return handshake->rules->cost(handshake, frame);
    if (handshake->hasCandidate ||
        (handshake->state == LINK_STATE_UP && link_isOfEpoch(frame, handshake->present.key)))
        return ROUNDS_OF(LINK_LENGTH(frame) - LINK_TAG_MORE);
    return 0;
}

int link_expect(Link_Session* session, const U8* frame, U32 attempt, Link_Seal* seal) {
    Link_Handshake* handshake = &session->handshake;
    const Link_Identity* present = &handshake->present;
    Link_Kind kind = LINK_KIND_OF(frame);
    /* number that an ACK is expected to have; ACKs are numbered like the sender's fragments */
    U32 expected = session->sender.base;
    if (attempt || LINK_IS_HANDSHAKE(kind))
        return handshake->rules->expect(handshake, frame, attempt, seal);
    if (handshake->state != LINK_STATE_UP || !link_isOfEpoch(frame, present->key))
        return 0;
    seal->key = LINK_PEERS_KEY(present, keys);
    seal->session = present->key;
    seal->acked = LINK_IS_PIGGYBACK(kind) ? link_extend(expected, frame[LINK_HEADER]) : 0U;
    if (kind >= LINK_KIND_PIGGYBACK) /* a PIGGYBACK or data */
        expected = session->receiver.expected;
    if (kind == LINK_KIND_PING)
        expected =
            frame[2] & LINK_PING_ANSWER ? session->liveness.pingsSent : session->liveness.pingsSeen;
    if (kind == LINK_KIND_BYE)
        expected = frame[1];
    seal->number = link_extend(expected, frame[1]);
    return 1;
}

void link_onForgery(Link_Session* session, const U8* frame) {
    if (LINK_IS_HANDSHAKE(LINK_KIND_OF(frame)))
        link_wipeCandidate(&session->handshake);
    else
        ++session->failures;
}

static void onHandshake(Link_Session* session, const U8* frame, U32 attempt) {
    U32 verdict = session->handshake.rules->onFrame(&session->handshake, frame, attempt);
    if (verdict & LINK_VERDICT_LOST)
        link_lose(session);
    if (verdict & LINK_VERDICT_BEGIN)
        begin(session, (verdict & LINK_VERDICT_UNCONFIRMED) != 0);
    if (verdict & LINK_VERDICT_ACK)
        link_scheduleAck(&session->receiver);
}

static int onPiggyback(Link_Session* session, const U8* frame, U32 early) {
    Link_Sender* sender = &session->sender;
    const U8* payload = frame + LINK_HEADER;
    U32 flags = early | LINK_FIRST | LINK_LAST | LINK_CHANNEL(frame[2]);
    if (LINK_KIND_OF(frame) == LINK_KIND_PIGGYBACK_ASK)
        flags |= LINK_ACK_NOW;
    /* A peer sends no PIGGYBACK while it still stores received messages or fragments. The sender
     * of a PIGGYBACK can therefore store the fragments of a whole window. */
    if (link_onAck(sender, payload[0], sender->fullCredit, 0, 0))
        LINK_NOTE_ALIVE(&session->liveness);
    return link_onData(&session->receiver, frame[1], flags, payload + 1, LINK_LENGTH(frame) - 1U);
}

void link_onFrame(Link_Session* session, const U8* frame, U32 attempt) {
    Link_Env* env = &session->handshake.pacing->env;
    const U8* payload = frame + LINK_HEADER;
    U32 size = LINK_LENGTH(frame);
    U32 duplicates = env->statistics.duplicates;
    Link_Kind kind = LINK_KIND_OF(frame);
    U32 early;
    int isFair = 1;
    if (LINK_IS_HANDSHAKE(kind)) {
        onHandshake(session, frame, attempt);
        return;
    }
    if (attempt) /* this is the first frame of the candidate's session */
        begin(session, 0);
    early = link_epochBits(frame, session->handshake.present.key) << 4;
    LINK_NOTE_CONFIRMED(&session->handshake);
    link_noteFrame(&session->liveness);
    if (kind == LINK_KIND_DATA)
        isFair = link_onData(&session->receiver, frame[1], early | frame[2], payload, size);
    else if (kind == LINK_KIND_ACK)
        link_onAck(&session->sender, frame[1], payload[0], payload + 1, size - 1U);
    else if (kind == LINK_KIND_BYE)
        link_lose(session);
    else if (kind != LINK_KIND_PING)
        isFair = onPiggyback(session, frame, early);
    else if (env->codec->isAuthenticated)
        link_onPing(&session->liveness, frame);
    else
        link_scheduleAck(&session->receiver);
    /* A duplicate frame is not a sign of life, because an attacker may have recorded it. link_onAck
     * and link_onPing check this themselves. */
    if (kind >= LINK_KIND_PIGGYBACK && duplicates == env->statistics.duplicates)
        LINK_NOTE_ALIVE(&session->liveness);
    if (!isFair)
        link_abort(session);
}
