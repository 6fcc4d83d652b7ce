/* SPDX-License-Identifier: MIT
 *
 * link: the layer's entrance: life cycle, channels and messages, bytes that come in, time.
 */
#include "link.h"

#include <string.h>

void Link_init(Link* link, const Link_Port* port, void* context, U32 byteTimeUs16) {
    memset(link, 0, sizeof *link);
    link->port = port;
    link->context = context;
    link->byteTimeUs16 = byteTimeUs16;
    if (LINK_SECURE)
        link->codec = &link_clear;
    link->longest = LINK_MAX_PAYLOAD;
    link_endSession(link, LINK_STATE_IDLE);
}

void Link_limitFrame(Link* link, U32 bytes) {
    link->longest = (U8)(bytes - LINK_CODEC(link)->overhead);
}

#if LINK_SECURE

void Link_setKey(Link* link, int slot, const U8* key, U32 side) {
    if (link->codec != &link_keyed) {
        link->longest = (U8)(link->longest + LINK_OVERHEAD - LINK_SECURE_OVERHEAD);
        link->codec = &link_keyed;
        link->handshake.slot = 1; /* the first HELLO uses slot 0 */
        link_drawNonce(link);     /* a longer nonce */
    }
    if (Link_keyInUse(link) == slot)
        link_lose(link);
    link_setSecret(&link->secrets, slot, key, side);
}

int Link_keyInUse(const Link* link) {
    return link->codec == &link_keyed && link->state == LINK_STATE_UP ? link->session.slot : -1;
}

#endif

void Link_start(Link* link, U32 nowUs) {
    link->now = nowUs;
    if (link->wanted)
        return;
    link->wanted = 1;
    link->paceUntil = nowUs;
    if (link->state == LINK_STATE_IDLE) {
        link_endSession(link, LINK_STATE_CONNECTING);
        link->port->state(link->context, LINK_STATE_CONNECTING);
    }
}

void Link_stop(Link* link, U32 nowUs) {
    U8 frame[LINK_MAX_OVERHEAD];
    link->now = nowUs;
    link->wanted = 0;
    link->handshake.hasCandidate = 0;
    if (link->state == LINK_STATE_UP)
        (void)link_sendControl(link, frame, LINK_KIND_BYE, 0, 0, 0);
    link_endSession(link, LINK_STATE_IDLE);
    link->pingAt = nowUs; /* what the peer sent before it heard the BYE asks for no answer */
}

Link_State Link_state(const Link* link) {
    return (Link_State)link->state;
}

/* Returns whether the channel can be used, or, without `mustBeOpen`, can be opened. */
static Link_Status check(const Link* link, int channel, int mustBeOpen) {
    if (channel < 0 || channel >= LINK_CHANNELS)
        return LINK_CLOSED;
    if (link->state != LINK_STATE_UP)
        return LINK_DOWN;
    return mustBeOpen && !(link->open >> channel & 1) ? LINK_CLOSED : LINK_OK;
}

Link_Status Link_openChannel(Link* link, int channel) {
    Link_Status status = check(link, channel, 0);
    if (status != LINK_OK)
        return status;
    if (((link->closing | link->closeDue) >> channel & 1) ||
        !link_offer(link, LINK_FIRST | (U32)channel, 0))
        return LINK_FULL;
    link->open = (U8)(link->open | 1U << channel);
    return LINK_OK;
}

Link_Status Link_closeChannel(Link* link, int channel) {
    Link_Status status = check(link, channel, 1);
    if (status != LINK_OK)
        return status;
    if (!link_offer(link, (U32)channel, 0))
        link->closeDue = (U8)(link->closeDue | 1U << channel);
    link->open = (U8)(link->open ^ 1U << channel);
    link->closing = (U8)(link->closing | 1U << channel);
    return LINK_OK;
}

Link_Status Link_send(Link* link, int channel, const U8* data, U32 size, U32 tag) {
    Link_Queue* queue = &link->queue;
    Link_Status status = check(link, channel, 1);
    int isCompressed = link->session.features & LINK_FEATURE_COMPRESSION;
    Link_Packed packed;
    Link_Entry* entry;
    U8 trailer[LINK_CHECK];
    U32 total, checkSize;
    if (size == 0 || size > LINK_MAX_MESSAGE)
        return LINK_TOO_LONG;
    if (status != LINK_OK)
        return status;
    packed.prefix = packed.middle = packed.tailAt = 0;
    packed.tail = size;
    if (isCompressed)
        link_compress(&link->heads[1], channel, data, size, &packed);
    total = packed.prefix + packed.middle + packed.tail;
    checkSize = total > LINK_UNCHECKED ? LINK_CODEC(link)->check : 0U;
    entry = link_offer(link, LINK_FIRST | (U32)channel, total + checkSize);
    if (!entry)
        return LINK_FULL;
    entry->tag = tag;
    if (packed.middle)
        entry->flags |= LINK_ENTRY_LEARNS;
    queue->sums = 0;
    link_put(queue, packed.bytes, packed.prefix);
    link_put(queue, data + LINK_HEAD_AT, packed.middle);
    link_put(queue, data + packed.tailAt, packed.tail);
    if (isCompressed) {
        link_note(&link->heads[1], channel, data, size, packed.head);
        link->statistics.headBytesSaved += size - total;
    }
    trailer[0] = (U8)queue->sums;
    trailer[1] = (U8)(queue->sums >> 8);
    link_put(queue, trailer, checkSize);
    return LINK_OK;
}

/* Parses the kept bytes, `count` now, and keeps an incomplete frame. */
static void parseKept(Link* link, U32 count, int isEnd) {
    Link_Parser* parser = &link->parser;
    U32 used = LINK_CODEC(link)->parse(link, link->input, count, isEnd);
    parser->count = (U8)(count - used);
    memmove(link->input, link->input + used, parser->count);
}

/* Drops half a frame behind which silence has come. */
static void pollInput(Link* link) {
    Link_Parser* parser = &link->parser;
    if (LINK_BEFORE(link->now, parser->at + LINK_FRAME_GAP))
        return;
    if (parser->count)
        parseKept(link, parser->count, 1);
    if (LINK_CODEC(link)->isSure)
        parser->outOfStep = 0;
}

void Link_receive(Link* link, const U8* bytes, U32 size, U32 nowUs) {
    Link_Parser* parser = &link->parser;
    link->now = nowUs;
    pollInput(link);
    if (size == 0)
        return; /* or no silence would ever be seen; bytes may be null */
    parser->at = nowUs;
    if (parser->count == 0) {
        /* The usual case: a whole frame is read in place. The rest fits. */
        U32 used = LINK_CODEC(link)->parse(link, bytes, size, 0);
        parser->count = (U8)(size - used);
        memcpy(link->input, bytes + used, parser->count);
        return;
    }
    while (size) {
        U32 had = parser->count;
        U32 part = sizeof link->input - had;
        if (part > size)
            part = size;
        memcpy(link->input + had, bytes, part);
        bytes += part;
        size -= part;
        parseKept(link, had + part, 0);
    }
}

void Link_poll(Link* link, U32 nowUs) {
    link->now = nowUs;
    pollInput(link);
    link_pollSession(link);
    /* What the peer has not acknowledged for so long it shall not carry out later. */
    if (link->state == LINK_STATE_UP &&
        (!link_pollReceiver(link) || link_age(link) >= LINK_AGE_LAST))
        link_abort(link);
    if (link->state != LINK_STATE_UP)
        return;
    link_pollSender(link);
    if (!link->sender.hasWork) /* else the next fragment takes it along */
        link_pollAck(link);
    (void)link_flush(link);
}

/* Returns the earlier of two times, if the first is due at all. */
static U32 sooner(int isDue, U32 at, U32 first) {
    return isDue && LINK_BEFORE(at, first) ? at : first;
}

#define LATER(a, b) (LINK_BEFORE(a, b) ? (b) : (a))
#define FAR 0x7FFFFFFFU

U32 Link_deadline(const Link* link, U32 nowUs) {
    const Link_Sender* sender = &link->sender;
    const Link_Receiver* receiver = &link->receiver;
    const Link_Handshake* handshake = &link->handshake;
    U32 soon = nowUs + LINK_POLL_EVERY;
    U32 open = link->paceUntil - link->slack;
    U32 ask = sooner(1, link->watch.provenAt + LINK_PROOF_AFTER, link->heardAt + LINK_PING_AFTER);
    U32 first = sooner(link->parser.count, link->parser.at + LINK_FRAME_GAP, nowUs + FAR);
    first = sooner(link->state == LINK_STATE_CONNECTING || handshake->isUnconfirmed,
                   handshake->helloAt, first);
    first = sooner(handshake->isAnswered, handshake->firstAnswer + LINK_NONCE_LIFE, first);
    if (link->state == LINK_STATE_UP) {
        first = sooner(1, LATER(ask, link->pingAt), first);
        first = sooner(link->packed, soon, first);
        first = sooner(sender->base != sender->next, sender->timerAt, first);
        first = sooner(sender->hasWork, LATER(open, soon), first);
        first = sooner(receiver->ackDue, receiver->ackNow ? soon : receiver->ackAt, first);
        first = sooner(receiver->isHeld, nowUs + LINK_OFFER_EVERY, first);
    }
    if (first == nowUs + FAR)
        return 0xFFFFFFFFU;
    return LINK_BEFORE(first, nowUs) ? 0 : first - nowUs;
}

const Link_Statistics* Link_statistics(const Link* link) {
    return &link->statistics;
}
