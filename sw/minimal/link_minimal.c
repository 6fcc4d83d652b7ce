/* SPDX-License-Identifier: MIT
 *
 * link_minimal: the minimal link layer: it sends one fragment at a time and waits for its
 * acknowledgement (stop and wait).
 */
#include "link_minimal.h"

#include <stddef.h>
#include <string.h>

/* Bits of a channel's state. LINK_FIRST or LINK_LAST is also set while a fragment that opens or
 * closes the channel must be sent. */
#define OPEN 1U
#define CLOSING 2U /* this side has closed the channel; the peer's closing has not arrived yet */
#define DUE (LINK_FIRST | LINK_LAST)

/* Sends link->frame with its payload already in place (link_seal). If the radio has no room, the
 * frame is lost; the link handles this like a loss on the air. */
static void transmit(Link* link, U32 header) {
    (void)link->port->transmit(link->context, link->frame,
                               link_seal(link->frame, header, link->key));
}

static void report(Link* link, Link_Outcome outcome) {
    if (!LINK_OUTCOMES || link->outSize == 0)
        return;
    if (link->port->outcome)
        link->port->outcome(link->context, link->channel, link->tag, outcome);
    if (link->port->writable)
        link->port->writable(link->context);
}

/* Ends the session, if there is one: clears its fields and reports its end. */
static void lose(Link* link) {
    int channel;
    if (link->state != LINK_STATE_UP)
        return;
    link->state = LINK_STATE_IDLE;
    report(link, LINK_UNKNOWN);
    for (channel = 0; channel < LINK_CHANNELS; ++channel)
        if (link->channels[channel] & OPEN)
            link->port->channel(link->context, channel, 0);
    memset(link->channels, 0, offsetof(Link, nonce) - offsetof(Link, channels));
    link->port->state(link->context, LINK_STATE_IDLE);
}

/* ---- receiving ---- */

static void onHello(Link* link, const U8* frame) {
    U32 peerNonce = link_get32(frame + LINK_HEADER);
    /* the nonces are equal if the peer repeats its HELLO because the answer was lost */
    if (peerNonce != link->peerNonce) {
        lose(link);
        link->peerNonce = peerNonce;
        link->nonce = link->port->random(link->context);
        link->heardAt = link->inputAt;
        link->state = LINK_STATE_UP;
        link->port->state(link->context, LINK_STATE_UP);
    }
    link->key = LINK_NO_SEED;
    link_put32(link->frame + LINK_HEADER, link->nonce);
    link_put32(link->frame + LINK_HEADER + 4, peerNonce);
    transmit(link, LINK_CONTROL_HEADER(LINK_KIND_HELLO_ACK, LINK_VERSION, 8));
    link->key = link_sessionKey(link->nonce, peerNonce);
}

static void onChannel(Link* link, U32 channel, U32 isOpen) {
    U8* c = link->channels + channel;
    if (*c & CLOSING) {
        if (!isOpen)
            *c ^= CLOSING; /* the peer has closed the channel as well */
    } else if (isOpen != (*c & OPEN)) {
        *c = isOpen ? OPEN : LINK_LAST;
        link->port->channel(link->context, (int)channel, (int)isOpen);
    }
}

/* Processes the expected fragment. Drops a message on a channel that this side has closed. */
static void onData(Link* link, const U8* frame, U32 size) {
    U32 flags = frame[2];
    U32 channel = LINK_CHANNEL(flags);
    U32 have = link->messageSize + size;
    if (size == 0) {
        onChannel(link, channel, flags >> 7);
    } else {
        if (have > sizeof link->message) {
            lose(link);
            return;
        }
        memcpy(link->message + link->messageSize, frame + LINK_HEADER, size);
        if (flags & LINK_LAST) {
            if (have > LINK_UNCHECKED) {
                have -= LINK_CHECK;
                if (link_sum(0, link->message, have) != LINK_CHECK_AT(link->message + have)) {
                    lose(link);
                    return;
                }
            }
            if ((link->channels[channel] & OPEN) &&
                link->port->message(link->context, (int)channel, link->message, have) != 0)
                return;
            have = 0;
        }
        link->messageSize = have;
    }
    ++link->receiveNext;
}

static void onAck(Link* link, U32 cumulative) {
    if (!link->flags || (U8)(link->sendNext + 1U) != cumulative)
        return;
    ++link->sendNext;
    link->flags = 0;
    link->outAt += link->size;
    if (link->outAt == link->outSize) {
        report(link, LINK_DELIVERED);
        link->outSize = link->outAt = 0;
    }
}

static void takeFrame(Link* link, const U8* frame, U32 size) {
    int isControl = frame[0] >> 7;
    U32 kind = frame[2] >> 5;
    U32 epoch = LINK_EPOCH(frame);
    if (isControl && LINK_IS_HANDSHAKE(kind)) {
        if (link_crc(LINK_NO_SEED, frame, size) != 0)
            return;
        if (kind == LINK_KIND_HELLO && frame[1] == LINK_VERSION)
            onHello(link, frame);
        else if (kind == LINK_KIND_RST && epoch == LINK_KEY_EPOCH(link->key))
            lose(link);
        return;
    } else if (link->state != LINK_STATE_UP) {
        /* the frame belongs to an earlier session, which the peer has not ended yet */
        link->key = LINK_EPOCH_KEY(epoch) | LINK_NO_SEED;
        transmit(link, LINK_CONTROL_HEADER(LINK_KIND_RST, 0, 0U));
        return;
    } else if (epoch != LINK_KEY_EPOCH(link->key) || link_crc(link->key, frame, size) != 0) {
        return;
    }
    if (isControl && kind == LINK_KIND_ACK) {
        onAck(link, frame[1]);
    } else if (isControl && kind == LINK_KIND_BYE) {
        lose(link);
    } else {
        link->ackDue = 1;
        if (!isControl && frame[1] == (U8)link->receiveNext)
            onData(link, frame, size - LINK_OVERHEAD);
    }
    link->heardAt = link->inputAt;
}

void Link_receive(Link* link, const U8* bytes, U32 size, U32 nowUs) {
    /* A frame begins at the first byte after a silence. It also begins at the first byte of a
     * portion if the length in the header there matches the size of the portion. */
    if (nowUs - link->inputAt > LINK_FRAME_GAP || LINK_LENGTH(bytes) + LINK_OVERHEAD == size)
        link->inputCount = 0;
    link->inputAt = nowUs;
    while (size--) {
        U32 whole = LINK_LENGTH(link->input) + LINK_OVERHEAD;
        link->input[link->inputCount++] = *bytes++;
        if (link->inputCount == whole) {
            takeFrame(link, link->input, whole);
            link->inputCount = 0;
        }
    }
}

/* ---- sending ---- */

/* Returns the flags of the next fragment; 0 if there is nothing to send. Openings are sent before
 * the queued message, closings after it. */
static U32 cut(Link* link) {
    U32 size, channel, flags;
    link->size = 0;
    for (channel = 0; channel < LINK_CHANNELS; ++channel) {
        U8* c = link->channels + channel;
        flags = *c & DUE;
        if (flags && (flags > LINK_FIRST || !link->outSize)) {
            *c = *c & (U8)~DUE;
            return flags | channel;
        }
    }
    size = link->outSize - link->outAt;
    if (!size)
        return 0;
    flags = link->channel;
    if (!link->outAt)
        flags |= LINK_FIRST;
    if (size > LINK_LONGEST)
        size = LINK_LONGEST;
    else
        flags |= LINK_LAST;
    link->size = size;
    return flags | LINK_ACK_NOW;
}

void Link_poll(Link* link, U32 nowUs) {
    if (link->state != LINK_STATE_UP)
        return;
    if (nowUs - link->heardAt >= LINK_DEAD_AFTER) {
        lose(link);
        return;
    }
    if (link->ackDue) {
        link->ackDue = 0;
        link->frame[LINK_HEADER] = 1; /* credit */
        transmit(link, LINK_CONTROL_HEADER(LINK_KIND_ACK, (U8)link->receiveNext, 1U));
    }
    if (!link->flags) {
        link->flags = (U8)cut(link);
        link->timerAt = nowUs;
    }
    if (link->flags && !LINK_BEFORE(nowUs, link->timerAt)) {
        link->timerAt = nowUs + link->retryUs;
        memcpy(link->frame + LINK_HEADER, link->out + link->outAt, link->size);
        transmit(link, LINK_HEADER_OF(link->size, (U8)link->sendNext, link->flags));
    }
}

U32 Link_deadline(const Link* link, U32 nowUs) {
    U32 at = link->heardAt + LINK_DEAD_AFTER;
    int c, due = link->ackDue;
    if (link->state != LINK_STATE_UP)
        return 0xFFFFFFFFU;
    for (c = 0; c < LINK_CHANNELS && !link->flags; ++c)
        due |= link->outSize || (link->channels[c] & DUE);
    if (due)
        return LINK_POLL_EVERY;
    if (link->flags && LINK_BEFORE(link->timerAt, at))
        at = link->timerAt;
    return LINK_BEFORE(at, nowUs) ? 0 : at - nowUs;
}

/* ---- functions for the program ---- */

void Link_init(Link* link, const Link_Config* config) {
    memset(link, 0, sizeof *link);
    link->port = config->port;
    link->context = config->context;
    link->retryUs =
        config->byteTimeUs16 * LINK_MAX_FRAME; /* time of 16 frames of maximum size, us */
}

void Link_start(Link* link, U32 nowUs) {
    (void)link;
    (void)nowUs;
}

void Link_stop(Link* link, U32 nowUs) {
    (void)nowUs;
    if (link->state == LINK_STATE_UP)
        transmit(link, LINK_CONTROL_HEADER(LINK_KIND_BYE, 0, 0U));
    lose(link);
}

Link_State Link_state(const Link* link) {
    return (Link_State)link->state;
}

const Link_Statistics* Link_statistics(const Link* link) {
    static const Link_Statistics none;
    (void)link;
    return &none;
}

/* Returns the state of the channel; 0 if the session or the channel does not exist. */
static U8* channelOf(Link* link, int channel) {
    return link->state == LINK_STATE_UP && (U32)channel < LINK_CHANNELS ? link->channels + channel
                                                                        : 0;
}

Link_Status Link_openChannel(Link* link, int channel) {
    U8* c = channelOf(link, channel);
    if (!c)
        return LINK_DOWN;
    if (*c & (LINK_LAST | CLOSING))
        return LINK_FULL;
    *c = OPEN | DUE;
    return LINK_OK;
}

Link_Status Link_closeChannel(Link* link, int channel) {
    U8* c = channelOf(link, channel);
    if (!c || !(*c & OPEN))
        return LINK_CLOSED;
    if (*c & LINK_FIRST)
        return LINK_FULL; /* the opening was not sent yet */
    *c = CLOSING | LINK_LAST;
    return LINK_OK;
}

Link_Status Link_send(Link* link, int channel, const U8* data, U32 size, U32 tag) {
    const U8* c = channelOf(link, channel);
    if (!c || !(*c & OPEN))
        return LINK_CLOSED;
    if (size - 1U >= LINK_MAX_MESSAGE)
        return LINK_TOO_LONG;
    if (link->outSize)
        return LINK_FULL;
    memcpy(link->out, data, size);
    if (size > LINK_UNCHECKED) {
        U32 sums = link_sum(0, data, size);
        link->out[size++] = (U8)sums;
        link->out[size++] = (U8)(sums >> 8);
    }
    link->outSize = size;
    link->channel = (U8)channel;
    if (LINK_OUTCOMES)
        link->tag = tag;
    return LINK_OK;
}
