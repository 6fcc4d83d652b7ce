/* SPDX-License-Identifier: MIT
 *
 * link_session: makes and ends sessions: handshake, reboots, a peer that has vanished; and gives
 * each frame that comes to its part of the layer.
 */
#include "link_session.h"

#include <string.h>

void link_makeCandidate(Link_Session* session, const U8* peerNonce, U32 features) {
    Link_Identity* candidate = &session->candidate;
    memcpy(candidate->nonce, session->nonce, LINK_NONCE_BYTES);
    memset(candidate->peerNonce, 0, LINK_NONCE_BYTES);
    memcpy(candidate->peerNonce, peerNonce, session->output->codec->nonceBytes);
    candidate->key = link_sessionKey(link_get32(candidate->nonce), link_get32(peerNonce));
    candidate->features = (U8)(features & LINK_FEATURES);
}

void link_drawNonce(Link_Session* session) {
    const Link_Output* output = session->output;
    U32 i;
    for (i = 0; i < output->codec->nonceBytes; i += 4U)
        link_put32(session->nonce + i, output->port->random(output->context));
    session->isAnswered = 0;
}

void link_sendHandshake(Link_Session* session, const Link_Identity* of, Link_Kind kind,
                        U32 version) {
    Link_Output* output = session->output;
    U8 frame[LINK_MAX_OVERHEAD + LINK_ANSWER_BYTES];
    U32 bytes = output->codec->nonceBytes;
    memcpy(frame + LINK_HEADER, of ? of->nonce : session->nonce, bytes);
    output->call = session->secrets[session->slot].hello;
    if (of) {
        memcpy(frame + LINK_HEADER + bytes, of->peerNonce, bytes);
        memcpy(frame + LINK_OPEN_AT, of->open, LINK_OPEN_BYTES);
        output->call = LINK_OWN_KEY(output, of->shake);
        bytes = output->codec->sizes[LINK_KIND_HELLO_ACK];
    }
    (void)link_sendControl(output, frame, LINK_KIND_BITS(kind) | LINK_FEATURES, version, bytes);
}

void link_endSession(Link_Session* session, Link_State next) {
    Link_Output* output = session->output;
    int wasUp = session->state == LINK_STATE_UP;
    U32 open = output->open;
    int channel;
    session->state = (U8)next;
    link_drawNonce(session);
    session->isUnconfirmed = 0;
    session->helloAt = output->now;
    session->pingAt = output->now - LINK_HELLO_FIRST;
    session->helloEvery = LINK_HELLO_FIRST;
    link_resetReceiver(session->receiver);
    link_resetSender(session->sender);
    memset(&output->present.keys, 0, sizeof output->present.keys);
    for (channel = 0; channel < LINK_CHANNELS; ++channel)
        if (open >> channel & 1U)
            output->port->channel(output->context, channel, 0);
    if (wasUp)
        output->port->state(output->context, next);
}

void link_lose(Link_Session* session) {
    link_endSession(session, session->wanted ? LINK_STATE_CONNECTING : LINK_STATE_IDLE);
}

void link_abort(Link_Session* session) {
    U8 frame[LINK_MAX_OVERHEAD];
    if (session->state == LINK_STATE_UP)
        (void)link_sendControl(session->output, frame, LINK_KIND_BITS(LINK_KIND_BYE), 0, 0);
    link_lose(session);
}

void link_confirmCandidate(Link_Session* session) {
    Link_Output* output = session->output;
    if (session->state == LINK_STATE_UP)
        link_endSession(session, LINK_STATE_CONNECTING);
    output->present = session->candidate;
    session->hasCandidate = 0;
    memset(&session->watch, 0, sizeof session->watch);
    session->watch.provenAt = output->heardAt = session->pingAt = output->now;
    output->paceUntil =
        output->now; /* after a long silence an old value would read as a future time */
    session->state = LINK_STATE_UP;
    ++output->statistics.sessions;
    output->port->state(output->context, LINK_STATE_UP);
}

int link_pollSession(Link_Session* session) {
    Link_Output* output = session->output;
    U8 frame[LINK_MAX_OVERHEAD];
    Link_Watch* watch = &session->watch;
    U32 now = output->now;
    U32 silence = now - output->heardAt;
    U32 proof = now - watch->provenAt;
    if (session->isAnswered && now - session->firstAnswer >= LINK_NONCE_LIFE)
        link_drawNonce(session);
    if ((session->state == LINK_STATE_CONNECTING || session->isUnconfirmed) &&
        !LINK_BEFORE(now, session->helloAt)) {
        if (session->isUnconfirmed)
            link_sendHandshake(session, &output->present, LINK_KIND_CONFIRM, LINK_VERSION);
        else
            output->codec->call(session, 0);
        session->helloAt = now + session->helloEvery;
        if (session->helloEvery < LINK_HELLO_LAST)
            session->helloEvery *= 2U;
    }
    if (session->state != LINK_STATE_UP)
        return 0;
    if (watch->failures >= LINK_MOST_FAILURES || session->sender->next >= LINK_LAST_NUMBER) {
        link_abort(session);
    } else if (silence >= LINK_DEAD_AFTER || proof >= LINK_PROOF_LAST) {
        link_lose(session);
    } else if ((silence >= LINK_PING_AFTER || proof >= LINK_PROOF_AFTER) &&
               !LINK_BEFORE(now, session->pingAt)) {
        if (watch->pingsAnswered == watch->pingsSent)
            watch->askedAt = now;
        watch->pingsSent += output->codec->isSure;
        (void)link_sendControl(output, frame, LINK_KIND_BITS(LINK_KIND_PING), watch->pingsSent, 0);
        session->pingAt = now + output->contention.rest / 16U +
                          (silence >= LINK_PING_AFTER ? LINK_PING_EVERY : LINK_PROOF_EVERY);
    }
    return session->state == LINK_STATE_UP;
}

/* Parses the kept bytes, `count` now, and keeps an incomplete frame. */
static void parseKept(Link_Input* input, U32 count, int isEnd) {
    U32 used = input->output->codec->parse(input, input->bytes, count, isEnd);
    input->count = (U8)(count - used);
    memmove(input->bytes, input->bytes + used, input->count);
}

void link_pollInput(Link_Input* input) {
    if (LINK_BEFORE(input->output->now, input->at + LINK_FRAME_GAP))
        return;
    if (input->count)
        parseKept(input, input->count, 1);
    if (input->output->codec->isSure)
        input->outOfStep = 0;
}

void link_takeBytes(Link_Input* input, const U8* bytes, U32 size) {
    link_pollInput(input);
    if (size == 0)
        return; /* or no silence would ever be seen; bytes may be null */
    input->at = input->output->now;
    if (input->count == 0) { /* the usual case: a whole frame is read in place; the rest fits */
        U32 used = input->output->codec->parse(input, bytes, size, 0);
        input->count = (U8)(size - used);
        memcpy(input->bytes, bytes + used, input->count);
        return;
    }
    while (size) {
        U32 had = input->count;
        U32 part = sizeof input->bytes - had;
        if (part > size)
            part = size;
        memcpy(input->bytes + had, bytes, part);
        bytes += part;
        size -= part;
        parseKept(input, had + part, 0);
    }
}

/* Tells in which bits of EPOCH a frame differs from a session's key. */
static U32 differs(const U8* frame, U32 key) {
    return (frame[2] ^ LINK_KEY_EPOCH(key) << 2) & 0x1CU;
}

int link_isOfEpoch(const U8* frame, U32 key) {
    U32 bits = differs(frame, key);
    U32 whole = LINK_FIRST | LINK_LAST; /* the bits of a kind that rides, too */
    return bits == 0 || (bits == LINK_READY && (frame[2] & whole) == whole);
}

int link_isPlausible(const Link_Output* output, const U8* frame) {
    const Link_Codec* codec = output->codec;
    U32 payload = LINK_LENGTH(frame) + LINK_OVERHEAD - codec->overhead;
    Link_Kind kind = LINK_KIND_OF(frame);
    if (kind == LINK_KIND_DATA)
        return payload != 0 || (frame[2] & LINK_LAST);
    if (kind > LINK_KIND_PING)
        return payload >= 2U;
    if (kind == LINK_KIND_ACK)
        return payload - 1U <= LINK_BITMAP;
    return payload == codec->sizes[kind];
}

static int onPiggyback(const Link_Session* session, const U8* frame, U32 early) {
    Link_Sender* sender = session->sender;
    const U8* payload = frame + LINK_HEADER;
    U32 flags = early | LINK_FIRST | LINK_LAST | LINK_CHANNEL(frame[2]);
    if (LINK_KIND_OF(frame) == LINK_KIND_PIGGYBACK_ASK)
        flags |= LINK_ACK_NOW;
    /* A peer sends no such frame while a message is held: the whole window is open. */
    link_onAck(sender, payload[0], sender->fullCredit, 0, 0);
    return link_onData(session->receiver, frame[1], flags, payload + 1, LINK_LENGTH(frame) - 1U);
}

void link_accept(Link_Input* input, const U8* frame, U32 size) {
    Link_Output* output = input->output;
    Link_Session* session = input->session;
    const U8* payload = frame + LINK_HEADER;
    U32 duplicates = output->statistics.duplicates;
    U32 early = differs(frame, output->present.key) << 4;
    Link_Kind kind = LINK_KIND_OF(frame);
    int isFair = 1;
    input->outOfStep = 0;
    link_hear(output, size);
    ++output->statistics.framesReceived;
    output->statistics.bytesReceived += size;
    if (LINK_IS_HANDSHAKE(kind)) {
        output->codec->onHandshake(session, frame, kind);
        return;
    }
    session->isUnconfirmed = 0;
    if (!LINK_BEFORE(output->now, session->pingAt))
        session->pingAt = output->now; /* or it would in time read as a future time */
    if (kind == LINK_KIND_DATA) {
        isFair =
            link_onData(session->receiver, frame[1], early | frame[2], payload, LINK_LENGTH(frame));
    } else if (kind == LINK_KIND_ACK) {
        link_onAck(session->sender, frame[1], payload[0], payload + 1, LINK_LENGTH(frame) - 1U);
    } else if (kind == LINK_KIND_BYE) {
        link_lose(session);
    } else if (kind == LINK_KIND_PING && output->codec->onPing) {
        output->codec->onPing(session, frame);
    } else if (kind == LINK_KIND_PING) {
        link_oweAck(session->receiver);
    } else {
        isFair = onPiggyback(session, frame, early);
    }
    /* A frame that was heard before may be an attacker's recording, and is no sign of life:
     * link_onAck and the codec look themselves. */
    if (kind >= LINK_KIND_PIGGYBACK && duplicates == output->statistics.duplicates)
        output->heardAt = output->now;
    if (!isFair)
        link_abort(session);
}

/* The first byte behind a frame may be of an unknown session, whose peer gets an answer, but not
 * too often. With a length that no frame has it is none, as a call to all vehicles. */
void link_skip(Link_Input* input, const U8* frame, U32 left) {
    Link_Output* output = input->output;
    Link_Session* session = input->session;
    if (!input->outOfStep && LINK_LENGTH(frame) <= LINK_MAX_PAYLOAD &&
        left >= output->codec->overhead && session->state == LINK_STATE_IDLE &&
        output->now - session->pingAt >= LINK_HELLO_FIRST) {
        session->pingAt = output->now;
        output->codec->call(session, frame);
    }
    input->outOfStep = 1;
    ++output->statistics.bytesSkipped;
}
