/* SPDX-License-Identifier: MIT
 *
 * link: the layer's entrance: life cycle, channels and messages, bytes that come in, time.
 */
#include "link.h"

#include <string.h>

void Link_init(Link* link, const Link_Port* port, void* context, U32 byteTimeUs16) {
    Link_initSmall(link, port, context, byteTimeUs16, LINK_SEND_BYTES, LINK_MAX_MESSAGE,
                   LINK_WINDOW);
}

void Link_initSmall(Link* link, const Link_Port* port, void* context, U32 byteTimeUs16,
                    U32 sendBytes, U32 maxMessage, U32 window) {
    Link_Output* output = &link->output;
    Link_Sender* sender = &link->sender;
    Link_Receiver* receiver = &link->receiver;
    memset(link, 0, LINK_FIXED);
    output->port = port;
    output->context = context;
    output->byteTimeUs16 = byteTimeUs16;
    output->longest = LINK_MAX_PAYLOAD;
    output->pacer = &output->own;
    output->codec = &link_clear;
    receiver->output = sender->output = output;
    link->session.output = link->input.output = output;
    link->session.receiver = sender->receiver = receiver;
    link->session.sender = sender;
    link->input.session = &link->session;
    sender->queue.mask = sendBytes - 1U;
    sender->window = (Link_Fragment*)(void*)(sender->queue.bytes + sendBytes);
    receiver->slots = (Link_Slot*)(sender->window + window);
    receiver->message = (U8*)(receiver->slots + window);
    receiver->longest = LINK_ARRIVING(maxMessage);
    sender->mask = receiver->mask = (U8)(window - 1U);
    link_endSession(&link->session, LINK_STATE_IDLE);
}

void Link_limitFrame(Link* link, U32 bytes) {
    link->output.longest = (U8)(bytes - link->output.codec->overhead);
}

void Link_setKey(Link* link, int slot, const U8* key, U32 side) {
    Link_Output* output = &link->output;
    Link_Session* session = &link->session;
    if (output->codec != &link_keyed) {
        output->longest = (U8)(output->longest + LINK_OVERHEAD - LINK_SECURE_OVERHEAD);
        output->codec = &link_keyed;
        session->slot = 1;       /* the first HELLO uses slot 0 */
        link_drawNonce(session); /* a longer nonce */
    }
    if (Link_keyInUse(link) == slot)
        link_lose(session);
    session->keys = (U8)(session->keys & ~(1U << slot));
    memset(&session->secrets[slot], 0, sizeof session->secrets[slot]);
    if (!key)
        return;
    output->isGround = (side & LINK_GROUND) != 0;
    link_makeSecret(&session->secrets[slot], key, side & ~LINK_GROUND);
    session->keys = (U8)(session->keys | 1U << slot);
}

int Link_keyInUse(const Link* link) {
    return link->output.codec == &link_keyed && link->session.state == LINK_STATE_UP
               ? link->output.present.slot
               : -1;
}

void Link_start(Link* link, U32 nowUs) {
    link->output.now = nowUs;
    if (link->session.wanted)
        return;
    link->session.wanted = 1;
    link->output.paceUntil = nowUs;
    if (link->session.state == LINK_STATE_IDLE) {
        link_endSession(&link->session, LINK_STATE_CONNECTING);
        link->output.port->state(link->output.context, LINK_STATE_CONNECTING);
    }
}

void Link_stop(Link* link, U32 nowUs) {
    Link_Session* session = &link->session;
    link->output.now = nowUs;
    session->wanted = session->hasCandidate = 0;
    link_abort(session);
    session->pingAt = nowUs; /* what the peer sent before it heard the BYE asks for no answer */
}

Link_State Link_state(const Link* link) {
    return (Link_State)link->session.state;
}

/* Returns whether the channel can be used, or, without `mustBeOpen`, can be opened. */
static Link_Status check(const Link* link, int channel, int mustBeOpen) {
    if (channel < 0 || channel >= LINK_CHANNELS)
        return LINK_CLOSED;
    if (link->session.state != LINK_STATE_UP)
        return LINK_DOWN;
    return mustBeOpen && !(link->output.open >> channel & 1) ? LINK_CLOSED : LINK_OK;
}

Link_Status Link_openChannel(Link* link, int channel) {
    Link_Output* output = &link->output;
    Link_Status status = check(link, channel, 0);
    if (status != LINK_OK)
        return status;
    if (((output->closing | output->closeDue) >> channel & 1) ||
        !link_offer(link->session.sender, LINK_FIRST | (U32)channel, 0))
        return LINK_FULL;
    output->open = (U8)(output->open | 1U << channel);
    return LINK_OK;
}

Link_Status Link_closeChannel(Link* link, int channel) {
    Link_Output* output = &link->output;
    Link_Status status = check(link, channel, 1);
    if (status != LINK_OK)
        return status;
    if (!link_offer(link->session.sender, (U32)channel, 0))
        output->closeDue = (U8)(output->closeDue | 1U << channel);
    output->open = (U8)(output->open ^ 1U << channel);
    output->closing = (U8)(output->closing | 1U << channel);
    return LINK_OK;
}

Link_Status Link_send(Link* link, int channel, const U8* data, U32 size, U32 tag) {
    Link_Output* output = &link->output;
    Link_Sender* sender = link->session.sender;
    Link_Queue* queue = &sender->queue;
    Link_Status status = check(link, channel, 1);
    Link_Packed packed;
    Link_Entry* entry;
    U8 trailer[LINK_CHECK];
    U32 total, checkSize;
    if (size == 0 || size > LINK_MAX_MESSAGE)
        return LINK_TOO_LONG;
    if (status != LINK_OK)
        return status;
    packed.prefix = packed.middle = packed.tailAt = packed.head = 0;
    if (output->present.features & LINK_FEATURE_COMPRESSION)
        link_compress(&sender->heads, channel, data, size, &packed);
    total = packed.prefix + packed.middle + size - packed.tailAt;
    checkSize = total > LINK_UNCHECKED ? output->codec->check : 0U;
    entry = link_offer(sender, LINK_FIRST | (U32)channel, total + checkSize);
    if (!entry)
        return total + checkSize + LINK_RESERVE > queue->mask + 1U ? LINK_TOO_LONG : LINK_FULL;
    entry->tag = tag;
    if (packed.middle)
        entry->flags |= LINK_ENTRY_LEARNS;
    queue->sums = 0;
    queue->isSummed = checkSize != 0;
    link_put(queue, packed.bytes, packed.prefix);
    link_put(queue, data + LINK_HEAD_AT, packed.middle);
    link_put(queue, data + packed.tailAt, size - packed.tailAt);
    if (packed.head)
        link_note(&sender->heads, channel, data, packed.head);
    output->statistics.headBytesSaved += size - total;
    trailer[0] = (U8)queue->sums;
    trailer[1] = (U8)(queue->sums >> 8);
    link_put(queue, trailer, checkSize);
    return LINK_OK;
}

void Link_receive(Link* link, const U8* bytes, U32 size, U32 nowUs) {
    link->output.now = nowUs;
    link_takeBytes(&link->input, bytes, size);
}

void Link_shareRadio(Link* link, Link* with) {
    link->output.pacer = with->output.pacer;
}

void Link_expectAnswers(Link* link, U32 packets) {
    Link_Output* output = &link->output;
    output->mostWaiting = (U8)packets;
    output->pacer->waiting = (U8)(output->pacer->waiting - output->waiting);
    output->waiting = 0;
}

/* Counts losses that took the radio no longer than other packets: then no tries failed, as they do
 * when two begin together. A side that sends little rests after a loss, at random: twice as long
 * after the next one, a quarter after a packet that arrives; longest where the peer is silent. */
static void note(Link_Output* output, int isDelivered) {
    Link_Contention* c = &output->contention;
    U32 now = output->now, took = now - c->answeredAt;
    U32 last = LINK_REST_LAST + 4U * (now - output->heardAt);
    c->quick -= c->quick / 128U;
    c->answeredAt = output->paceUntil = now;
    if (isDelivered) {
        c->rest /= 4U;
        if (c->isBusy)
            c->usualUs += took / 16U - c->usualUs / 16U;
        return;
    }
    if (took < c->usualUs + c->usualUs / 4U)
        c->quick += 65536U / 128U;
    c->rest = 2U * c->rest + LINK_REST_FIRST;
    if (c->rest > last)
        c->rest = last;
    if (!c->own.isMuch && !c->peers.isMuch) {
        output->paceUntil += output->port->random(output->context) % c->rest;
        output->early = 0xFFFFFFFFU; /* a frame of the peer ends the rest */
    }
    c->hasLost = 1;
    c->lostAt = now;
}

void Link_answer(Link* link, int isDelivered, U32 nowUs) {
    Link_Pacer* pacer = link->output.pacer;
    Link_Output* output = pacer->owners[pacer->first];
    if (!pacer->waiting)
        return;
    --pacer->waiting;
    pacer->first = (U8)((pacer->first + 1U) % LINK_MOST_WAITING);
    link = (Link*)(void*)output; /* whose first part it is */
    output->now = nowUs;
    note(output, isDelivered);
    link_onAnswer(&link->sender, (U8)(output->handed - output->waiting--), isDelivered);
    output->contention.isBusy = output->waiting != 0;
}

/* Judges whether a side sends much, by the bytes of so many whole spans, or of a part of one. */
static void judge(Link_Talk* talk, U32 bytes, U32 spans) {
    U32 more = bytes - talk->before;
    if (more >= LINK_SPAN_MANY * (spans ? spans : 1U))
        talk->isMuch = 1;
    else if (more < LINK_SPAN_FEW * spans)
        talk->isMuch = 0;
    if (spans)
        talk->before = bytes;
}

U32 Link_randomWait(Link* link) {
    Link_Output* output = &link->output;
    Link_Contention* c = &output->contention;
    U32 messages = output->statistics.messagesReceived;
    U32 spans = (output->now - c->since) / LINK_SPAN;
    U32 isSlow = output->longest + output->codec->overhead <= LINK_MAX_ENCRYPTED;
    judge(&c->own, output->statistics.bytesSent, spans);
    judge(&c->peers, output->statistics.bytesReceived, spans);
    if (spans && !c->peers.isMuch)
        c->isCalled = 0;
    if (c->own.isMuch && messages != c->messages)
        c->isCalled = 1;
    if (spans) {
        c->since = output->now;
        c->messages = messages;
    }
    if (output->now - c->lostAt >= LINK_LOSS_COUNTS)
        c->hasLost = 0;
    if (c->own.isMuch && c->peers.isMuch)
        return c->quick <= LINK_QUICK_MANY ? LINK_WAIT_BOTH : isSlow ? LINK_WAIT_SHARED : 0U;
    if (c->peers.isMuch || c->isCalled || (c->hasLost && !c->own.isMuch))
        return LINK_WAIT_SHARED;
    return isSlow;
}

void Link_poll(Link* link, U32 nowUs) {
    Link_Sender* sender = link->session.sender;
    link->output.now = nowUs;
    link_pollInput(&link->input);
    if (link_pollSession(&link->session)) {
        if (!link_pollReceiver(&link->receiver) || !link_pollSender(sender))
            link_abort(&link->session);
        else if (!sender->hasWork) /* else the next fragment takes it along */
            link_pollAck(&link->receiver);
    }
    if (link->output.packed) /* a frame of the handshake, too, for which there was no room */
        (void)link_flush(&link->output);
}

/* Returns the earlier of two times, if the first is due at all. */
static U32 sooner(int isDue, U32 at, U32 first) {
    return isDue && LINK_BEFORE(at, first) ? at : first;
}

#define LATER(a, b) (LINK_BEFORE(a, b) ? (b) : (a))
#define FAR 0x7FFFFFFFU

U32 Link_deadline(const Link* link, U32 nowUs) {
    const Link_Sender* sender = link->session.sender;
    const Link_Receiver* receiver = &link->receiver;
    const Link_Session* session = &link->session;
    const Link_Input* input = &link->input;
    const Link_Output* output = &link->output;
    U32 soon = nowUs + LINK_POLL_EVERY;
    U32 open = output->paceUntil - output->slack;
    U32 ask = output->heardAt + LINK_PING_AFTER;
    U32 first = sooner(input->count, input->at + LINK_FRAME_GAP, nowUs + FAR);
    first = sooner(session->state == LINK_STATE_CONNECTING || session->isUnconfirmed,
                   session->helloAt, first);
    ask = sooner(1, session->watch.provenAt + LINK_PROOF_AFTER, ask);
    first = sooner(session->isAnswered, session->firstAnswer + LINK_NONCE_LIFE, first);
    if (session->state == LINK_STATE_UP) {
        first = sooner(1, LATER(ask, session->pingAt), first);
        if (!output->waiting) /* else the radio's next answer decides what goes again */
            first = sooner(sender->base != sender->next, sender->timerAt, first);
        if (!output->mostWaiting || output->pacer->waiting < output->mostWaiting) {
            first = sooner(output->packed, soon, first);
            first = sooner(sender->hasWork, LATER(open, soon), first);
            first = sooner(receiver->ackDue, receiver->ackNow ? soon : receiver->ackAt, first);
        }
        first = sooner(receiver->isHeld, nowUs + LINK_OFFER_EVERY, first);
    }
    if (first == nowUs + FAR)
        return 0xFFFFFFFFU;
    return LINK_BEFORE(first, nowUs) ? 0 : first - nowUs;
}

const Link_Statistics* Link_statistics(const Link* link) {
    return &link->output.statistics;
}
