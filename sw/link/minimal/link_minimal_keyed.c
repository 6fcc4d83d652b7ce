/* SPDX-License-Identifier: MIT
 *
 * link_minimal_keyed: adds the parts for a key to the minimal layer: the answering side of
 * link_keyed.c's handshake, tags, and PING.
 *
 * HELLO is sent once where frames of an unknown session come, in place of RST.
 */
#include "link.h"

#if LINK_SECURE

#include "ascon.h"

#include <string.h>

static void draw(Link* link) {
    link_put32(link->keyed.nonce, link->port->random(link->context));
    link_put32(link->keyed.nonce + 4, link->port->random(link->context));
    link->keyed.isAnswered = link->keyed.isCalled = 0;
}

static void transmit(Link* link, U32 header, const U8* key, U32 number) {
    header |= LINK_KEY_EPOCH(link->key) << 18;
    (void)link->port->transmit(link->context, link->frame,
                               link_protect(link->frame, header, key, number, 0));
}

void link_forgetKeys(Link* link) {
    Ascon_wipe(&link->keyed.keys, sizeof link->keyed.keys);
    Ascon_wipe(&link->keyed.shake, sizeof link->keyed.shake);
}

void link_transmitKeyed(Link* link, U32 header, U32 number) {
    transmit(link, header, link->keyed.keys.send, number);
}

/* Sends a frame of the handshake that carries the own nonce; if there is one of the peer's, that
 * and the half of the own pair, too. */
static void sendHandshake(Link* link, Link_Kind kind, const U8* peerNonce, const U8* key,
                          U32 version) {
    U8* payload = link->frame + LINK_HEADER;
    U32 size = LINK_NONCE_BYTES;
    memcpy(payload, link->keyed.nonce, LINK_NONCE_BYTES);
    if (peerNonce) {
        memcpy(payload + LINK_NONCE_BYTES, peerNonce, LINK_NONCE_BYTES);
        memcpy(link->frame + LINK_OPEN_AT, link->keyed.pair.open, LINK_OPEN_BYTES);
        size = LINK_ANSWER_BYTES;
    }
    transmit(link, LINK_CONTROL_HEADER(kind, version, size), key, 0);
}

/* Begins the session whose handshake's keys those are. */
static void begin(Link* link, const U8* nonces, const Link_Keys* keys, int slot) {
    Link_Keyed* keyed = &link->keyed;
    link_lose(link);
    keyed->keys = keyed->shake = *keys;
    link_makePair(&keyed->pair, link->port, link->context);
    link_mixKeys(&keyed->keys, &keyed->pair, link->input + LINK_OPEN_AT, keyed->secrets.isGround);
    keyed->slot = (U8)slot;
    keyed->pingsSeen = keyed->failures = 0;
    memcpy(keyed->nonces, nonces, sizeof keyed->nonces);
    link->key = link_sessionKey(link_get32(nonces), link_get32(nonces + LINK_NONCE_BYTES));
    link->heardAt = keyed->lastCall = link->inputAt;
    link->state = LINK_STATE_UP;
    link->port->state(link->context, LINK_STATE_UP);
}

/* Takes a frame of the handshake if it is good under the key of a slot. Returns 1: it is. */
static int takeUnder(Link* link, int slot, Link_Kind kind) {
    Link_Keyed* keyed = &link->keyed;
    const U8* nonces = link->input + LINK_HEADER;
    Link_Keys keys;
    int isGood;
    if (!(keyed->secrets.set >> slot & 1))
        return 0;
    link_deriveKeys(&keyed->secrets, slot, keyed->nonce, nonces, &keys);
    isGood = link_unprotect(
        link->input, kind == LINK_KIND_HELLO ? keyed->secrets.hello[slot] : keys.receive, 0, 0);
    if (isGood && kind == LINK_KIND_HELLO) {
        keyed->lastAnswer = link->inputAt;
        if (link->state == LINK_STATE_UP && !keyed->isUnconfirmed) {
            keyed->isCalled = 1;
            sendHandshake(link, LINK_KIND_HELLO, 0, keyed->secrets.hello[slot],
                          LINK_VERSION | LINK_VERSION_UP);
        } else {
            link_makePair(&keyed->pair, link->port, link->context);
            sendHandshake(link, LINK_KIND_HELLO_ACK, nonces, keys.send, LINK_VERSION);
        }
        if (!keyed->isAnswered)
            keyed->firstAnswer = link->inputAt;
        keyed->isAnswered = 1;
    } else if (isGood) {
        begin(link, nonces, &keys, slot);
        keyed->isUnconfirmed = kind == LINK_KIND_HELLO_ACK;
        if (keyed->isUnconfirmed)
            sendHandshake(link, LINK_KIND_CONFIRM, nonces, keys.send, LINK_VERSION);
        draw(link);
        link->ackDue = 1; /* so that the peer hears a frame */
    }
    Ascon_wipe(&keys, sizeof keys);
    return isGood;
}

/* Takes HELLO, HELLO-ACK or CONFIRM, if it is of use here. */
static void takeHandshake(Link* link, Link_Kind kind) {
    Link_Keyed* keyed = &link->keyed;
    const U8* nonces = link->input + LINK_HEADER;
    int isUp = link->state == LINK_STATE_UP;
    U8 copy[LINK_MAX_OVERHEAD + LINK_ANSWER_BYTES];
    if (keyed->isAnswered && link->inputAt - keyed->firstAnswer >= LINK_NONCE_LIFE)
        draw(link);
    if (kind == LINK_KIND_HELLO) {
        if (LINK_LENGTH(link->input) != LINK_NONCE_BYTES + LINK_TAG_MORE ||
            (isUp && (link->inputAt - keyed->lastAnswer < LINK_ANSWER_EVERY ||
                      link->input[1] != LINK_VERSION ||
                      memcmp(nonces, keyed->nonces, LINK_NONCE_BYTES) == 0)))
            return;
    } else if (link->input[1] != LINK_VERSION ||
               LINK_LENGTH(link->input) != LINK_ANSWER_BYTES + LINK_TAG_MORE) {
        return;
    } else if (isUp && kind == LINK_KIND_CONFIRM &&
               memcmp(nonces, keyed->nonces, sizeof keyed->nonces) == 0) {
        link->ackDue |= link_unprotect(link->input, keyed->shake.receive, 0, 0) != 0;
        return;
    } else if (memcmp(nonces + LINK_NONCE_BYTES, keyed->nonce, LINK_NONCE_BYTES) != 0 ||
               !(kind == LINK_KIND_CONFIRM ? keyed->isAnswered : keyed->isCalled)) {
        return;
    }
    if (memcmp(nonces, keyed->nonce, LINK_NONCE_BYTES) == 0)
        return;
    memcpy(copy, link->input, sizeof copy);
    if (!takeUnder(link, 0, kind)) {
        memcpy(link->input, copy, sizeof copy); /* the other key has spoilt it */
        (void)takeUnder(link, 1, kind);
    }
}

int link_takeKeyed(Link* link) {
    Link_Keyed* keyed = &link->keyed;
    U8* frame = link->input;
    U32 kind = (U32)frame[2] >> 5;
    U32 number = link->receiveNext; /* whose lowest byte is near byte 1 */
    int isControl = frame[0] >> 7;
    if (LINK_LENGTH(frame) < LINK_TAG_MORE)
        return 0;
    if (isControl && LINK_IS_HANDSHAKE(kind)) {
        if ((frame[1] & ~LINK_VERSION_UP) == LINK_VERSION)
            takeHandshake(link, (Link_Kind)kind);
        return 0;
    }
    if (link->state != LINK_STATE_UP) { /* the peer is in an earlier session */
        if (keyed->secrets.set && link->inputAt - keyed->lastCall >= LINK_HELLO_FIRST) {
            keyed->isCalled = 1;
            keyed->lastCall = link->inputAt;
            sendHandshake(link, LINK_KIND_HELLO, 0, keyed->secrets.hello[!(keyed->secrets.set & 1)],
                          LINK_VERSION);
        }
        return 0;
    }
    if (LINK_EPOCH(frame) != LINK_KEY_EPOCH(link->key) ||
        (isControl && kind >= LINK_KIND_PIGGYBACK))
        return 0;
    if (isControl)
        number = kind == LINK_KIND_ACK    ? link->sendNext + 1U
                 : kind == LINK_KIND_PING ? keyed->pingsSeen
                                          : 0;
    number = link_extend(number, frame[1]);
    if (!link_unprotect(frame, keyed->keys.receive, number, 0)) {
        if (++keyed->failures >= LINK_MOST_FAILURES)
            link_lose(link);
        return 0;
    }
    keyed->isUnconfirmed = 0;
    if (!isControl || kind != LINK_KIND_PING)
        return 1;
    if (LINK_BEFORE(keyed->pingsSeen, number)) {
        keyed->pingsSeen = number;
        link->heardAt = link->inputAt;
        link_transmitKeyed(link,
                           LINK_CONTROL_HEADER(LINK_KIND_PING, (U8)number, 0U) |
                               LINK_HEADER_OF(0U, 0U, LINK_PING_ANSWER),
                           number);
    }
    return 0;
}

void Link_setKey(Link* link, int slot, const U8* key, U32 side) {
    if (!LINK_IS_SECURE(link)) {
        link->overhead = LINK_SECURE_OVERHEAD;
        draw(link);
    }
    if (Link_keyInUse(link) == slot)
        link_lose(link);
    link_setSecret(&link->keyed.secrets, slot, key, side);
}

int Link_keyInUse(const Link* link) {
    return LINK_IS_SECURE(link) && link->state == LINK_STATE_UP ? link->keyed.slot : -1;
}

#endif
