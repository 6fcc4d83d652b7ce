/* SPDX-License-Identifier: MIT
 *
 * link: the functions that programs call. They connect the parts of the layer and pass each call on
 * to a part.
 */
#include "link.h"

#include "link_codec_clear.h"
#include "link_codec_keyed.h"
#include "link_handshake_clear.h"
#include "link_handshake_keyed.h"

#include <string.h>

void Link_init(Link* link, const Link_Config* config) {
    Link_Pacing* pacing = &link->pacing;
    Link_Session* session = &link->session;
    Link_Receiver* receiver = &session->receiver;
    Link_Sender* sender = &session->sender;
    memset(link, 0, sizeof *link);
    pacing->env.port = config->port;
    pacing->env.context = config->context;
    pacing->env.codec = &link_codecClear;
    link_initPacing(pacing, &session->handshake.present, link, config->byteTimeUs16);
    session->liveness.pacing = session->handshake.pacing = pacing;
    receiver->pacing = sender->pacing = pacing;
    receiver->slots = config->slots;
    receiver->message = config->message;
    receiver->longest = (U16)LINK_ARRIVING(config->maxMessage);
    sender->receiver = receiver;
    sender->window = config->fragments;
    sender->mask = receiver->mask = (U8)(config->window - 1U);
    LINK_INIT_QUEUE(&sender->queue, config->send, config->sendBytes);
    link->search.session = session;
    link_useRules(&session->handshake, &link_clearHandshake);
    link_endSession(session, LINK_STATE_IDLE);
}

void Link_limitFrame(Link* link, U32 bytes) {
    link_limitPacket(&link->pacing, bytes);
}

void Link_setKey(Link* link, int slot, const U8* key, U32 side) {
    Link_Env* env = &link->pacing.env;
    if (env->codec != &link_codecKeyed) {
        U32 bytes = (U32)link->pacing.longest + env->codec->overhead;
        env->codec = &link_codecKeyed;
        link_limitPacket(&link->pacing, bytes);
        link_useRules(&link->session.handshake, &link_keyedHandshake);
        /* draws a new nonce, because a link with a key needs a longer one */
        link_drawNonce(&link->session.handshake);
    }
    if (Link_keyInUse(link) == slot)
        link_lose(&link->session);
    link_setSecret(&link->session.handshake, slot, key, side);
}

int Link_keyInUse(const Link* link) {
    return link->pacing.env.codec == &link_codecKeyed &&
                   link->session.handshake.state == LINK_STATE_UP
               ? link->session.handshake.present.slot
               : -1;
}

void Link_start(Link* link, U32 nowUs) {
    Link_Env* env = &link->pacing.env;
    env->now = nowUs;
    if (link->session.wanted)
        return;
    LINK_WANT(&link->session, 1);
    LINK_END_PAUSE(&link->pacing);
    if (link->session.handshake.state == LINK_STATE_IDLE) {
        link_endSession(&link->session, LINK_STATE_CONNECTING);
        env->port->state(env->context, LINK_STATE_CONNECTING);
    }
}

void Link_stop(Link* link, U32 nowUs) {
    link->pacing.env.now = nowUs;
    LINK_WANT(&link->session, 0);
    link_abort(&link->session);
    link_forgetPeer(&link->session.handshake);
}

Link_State Link_state(const Link* link) {
    return (Link_State)link->session.handshake.state;
}

/* Checks the number of a channel, and whether there is a session. With `mustBeOpen`, also checks
 * whether the channel is open. */
static Link_Status check(const Link* link, int channel, int mustBeOpen) {
    if (channel < 0 || channel >= LINK_CHANNELS)
        return LINK_CLOSED;
    if (link->session.handshake.state != LINK_STATE_UP)
        return LINK_DOWN;
    return mustBeOpen && !LINK_IS_OPEN(&link->session.receiver.channels, channel) ? LINK_CLOSED
                                                                                  : LINK_OK;
}

Link_Status Link_openChannel(Link* link, int channel) {
    Link_Status status = check(link, channel, 0);
    if (status != LINK_OK)
        return status;
    if (!LINK_MAY_OPEN(&link->session.receiver.channels, (U32)channel) ||
        !link_queueChannel(&link->session.sender, LINK_FIRST | (U32)channel))
        return LINK_FULL;
    LINK_OPEN(&link->session.receiver.channels, (U32)channel);
    return LINK_OK;
}

Link_Status Link_closeChannel(Link* link, int channel) {
    Link_Status status = check(link, channel, 1);
    if (status == LINK_OK)
        link_closeChannel(&link->session.receiver.channels, (U32)channel,
                          link_queueChannel(&link->session.sender, (U32)channel));
    return status;
}

Link_Status Link_send(Link* link, int channel, const U8* data, U32 size, U32 tag) {
    Link_Status status = check(link, channel, 1);
    if (size == 0 || size > LINK_MAX_MESSAGE)
        return LINK_TOO_LONG;
    return status == LINK_OK ? link_queueMessage(&link->session.sender, channel, data, size, tag)
                             : status;
}

void Link_receive(Link* link, const U8* bytes, U32 size, U32 nowUs) {
    link->pacing.env.now = nowUs;
    link_takeBytes(&link->search, bytes, size);
}

void Link_shareRadio(Link* link, Link* with) {
    LINK_SHARE_ANSWERS(&link->pacing, &with->pacing);
}

void Link_expectAnswers(Link* link, U32 packets) {
    link_limitUnanswered(&link->pacing, packets);
}

void Link_answer(Link* link, int isDelivered, U32 nowUs) {
    Link* owner = link_takeAnswered(&link->pacing);
    if (!owner)
        return;
    owner->pacing.env.now = nowUs;
    link_onAnswer(
        &owner->session.sender,
        link_paceByAnswer(&owner->pacing, isDelivered, nowUs - owner->session.liveness.heardAt),
        isDelivered);
}

U32 Link_randomWait(Link* link) {
    return link_chooseWait(
        &link->pacing.backoff, link->pacing.env.now, &link->pacing.env.statistics,
        link->pacing.longest + link->pacing.env.codec->overhead <= LINK_MAX_ENCRYPTED);
}

void Link_poll(Link* link, U32 nowUs) {
    Link_Session* session = &link->session;
    link->pacing.env.now = nowUs;
    link_pollSearch(&link->search);
    if (link_pollSession(session)) {
        if (!link_pollReceiver(&link->session.receiver) || !link_pollSender(&link->session.sender))
            link_abort(session);
        /* if the sender has work, its next fragment carries the acknowledgement */
        else if (!link->session.sender.hasWork)
            link_pollAck(&link->session.receiver);
    }
    /* also sends a frame of the handshake for which the radio had no room before */
    if (link->pacing.packed)
        (void)link_flush(&link->pacing);
}

/* Returns the earlier of two times. If `isDue` is 0, `at` is ignored. */
static U32 sooner(int isDue, U32 at, U32 first) {
    return isDue && LINK_BEFORE(at, first) ? at : first;
}

#define FAR 0x7FFFFFFFU

U32 Link_deadline(const Link* link, U32 nowUs) {
    const Link_Sender* sender = &link->session.sender;
    const Link_Receiver* receiver = &link->session.receiver;
    const Link_Handshake* handshake = &link->session.handshake;
    const Link_Pacing* pacing = &link->pacing;
    U32 soon = nowUs + LINK_POLL_EVERY;
    U32 open = pacing->paceUntil - pacing->slack;
    U32 first = nowUs + FAR;
    if (LINK_BEFORE(open, soon))
        open = soon;
    first = sooner(link->search.count, link->search.at + LINK_FRAME_GAP, first);
    first = sooner(handshake->state == LINK_STATE_CONNECTING || handshake->isUnconfirmed,
                   handshake->helloAt, first);
    first = sooner(handshake->isAnswered, handshake->firstAnswer + LINK_NONCE_LIFE, first);
    if (handshake->state == LINK_STATE_UP) {
        first = sooner(1, link_livenessDeadline(&link->session.liveness), first);
        /* while packets wait for the radio's results, these results trigger retransmissions, and
         * the timer is not used */
        if (!pacing->waiting)
            first = sooner(sender->base != sender->next, sender->timerAt, first);
        if (!pacing->mostWaiting || pacing->radio->waiting < pacing->mostWaiting) {
            first = sooner(pacing->packed, soon, first);
            first = sooner(sender->hasWork, open, first);
            first = sooner(receiver->ackDue, receiver->ackNow ? soon : receiver->ackAt, first);
        }
        first = sooner(receiver->isHeld, nowUs + LINK_OFFER_EVERY, first);
    }
    if (first == nowUs + FAR)
        return 0xFFFFFFFFU;
    return LINK_BEFORE(first, nowUs) ? 0 : first - nowUs;
}

const Link_Statistics* Link_statistics(const Link* link) {
    return &link->pacing.env.statistics;
}
