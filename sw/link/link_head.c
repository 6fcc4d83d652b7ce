/* SPDX-License-Identifier: MIT
 *
 * link_head: the heads of IceP messages are sent once, and named by a byte afterwards.
 *
 * The only file of this layer that knows what an Ice message looks like ("The Ice Protocol" in the
 * manual of ZeroC Ice 3.7). Both sides keep, for each direction, the last LINK_HEAD_SLOTS heads of
 * requests (identity, facet, operation, mode, context, encoding) and each channel's last request
 * ids. A session delivers everything once and in order, so both tables are equal without a word
 * about them. What is not recognised goes as it is. Tokens: docs/link.md.
 */
#include "link.h"

#include <string.h>

#define HEADER 14U       /* magic, versions, type, compression, size */
#define BEFORE_HEAD 18U  /* and the request id */
#define ENCAPSULATION 6U /* its size and encoding version */
#define MOST_HEAD (LINK_HEAD_BYTES - 2U)

#define TOKEN_REQUEST 0x80U /* bit 4: the channel's next id, else oneway; bits 3..0: slot */
#define TOKEN_LITERAL                                                                           \
    0xA0U                 /* bits 1..0: 0 oneway, 1 next id, 2 id follows; then length and head \
                           */
#define TOKEN_REPLY 0xB0U /* bit 1: id follows, else next; bit 0: status and body as they are */
#define TOKEN_VALIDATE 0xC0U
#define TOKEN_CLOSE 0xC1U /* or one more: with the compression byte set */
#define TOKEN_AS_IT_IS 0xFFU

enum { REQUEST = 0, REPLY = 2, VALIDATE = 3, CLOSE = 4 };

static const U8 magic[8] = {'I', 'c', 'e', 'P', 1, 0, 1, 0};

void Link_resetHeads(Link* link) {
    memset(&link->headsOut, 0, sizeof link->headsOut);
    memset(&link->headsIn, 0, sizeof link->headsIn);
}

/* 1: a whole message of this type. */
static int isMessage(const U8* m, U32 size, U32 type, U32 least) {
    return size >= least && memcmp(m, magic, sizeof magic) == 0 && m[8] == type &&
           Link_get32(m + 10) == size;
}

/* Length of a request's head, from its identity to its context; 0: none that can be learned. */
static U32 headOf(const U8* m, U32 size) {
    U32 at = BEFORE_HEAD;
    int strings;
    if (!isMessage(m, size, REQUEST, BEFORE_HEAD) || m[9] != 0)
        return 0;
    for (strings = 0; strings < 4; ++strings) { /* name, category, facet, operation */
        if (at >= size || m[at] == 255)
            return 0;
        if (strings == 2 && m[at] > 1)
            return 0;
        if (strings == 2 && m[at++] == 0)
            continue;
        if (at >= size || m[at] == 255)
            return 0;
        at += 1U + m[at];
    }
    ++at; /* mode */
    if (at >= size || m[at++] != 0)
        return 0; /* a context is seldom the same twice */
    if (at + ENCAPSULATION > size || Link_get32(m + at) != size - at)
        return 0;
    return at - BEFORE_HEAD <= MOST_HEAD ? at - BEFORE_HEAD : 0;
}

/* The slot that holds this head and encoding; LINK_HEAD_SLOTS: none. */
static U32 find(const Link_Heads* heads, const U8* head, U32 size, const U8* version) {
    U32 slot;
    for (slot = 0; slot < LINK_HEAD_SLOTS; ++slot)
        if (heads->size[slot] == size + 2U && memcmp(heads->head[slot], head, size) == 0 &&
            memcmp(heads->head[slot] + size, version, 2) == 0)
            break;
    return slot;
}

/* What both sides remember of a message that has passed. */
static void note(Link_Heads* heads, int channel, const U8* m, U32 size) {
    U32 head = headOf(m, size);
    const U8* version = m + BEFORE_HEAD + head + 4;
    if (head) {
        if (Link_get32(m + HEADER))
            heads->lastRequest[channel] = Link_get32(m + HEADER);
        if (find(heads, m + BEFORE_HEAD, head, version) == LINK_HEAD_SLOTS) {
            U8* entry = heads->head[heads->next];
            heads->size[heads->next] = (U8)(head + 2U);
            memcpy(entry, m + BEFORE_HEAD, head);
            memcpy(entry + head, version, 2);
            heads->next = (U8)((heads->next + 1U) % LINK_HEAD_SLOTS);
        }
    } else if (isMessage(m, size, REPLY, BEFORE_HEAD + 1U)) {
        heads->lastReply[channel] = Link_get32(m + HEADER);
    }
}

static void packRequest(const Link_Heads* heads, int channel, const U8* m, U32 size, U32 head,
                        Link_Packed* packed) {
    U32 id = Link_get32(m + HEADER);
    U32 mode = id == 0 ? 0U : id == heads->lastRequest[channel] + 1U ? 1U : 2U;
    U32 slot = find(heads, m + BEFORE_HEAD, head, m + BEFORE_HEAD + head + 4);
    packed->tailAt = BEFORE_HEAD + head + ENCAPSULATION;
    packed->prefix = 1;
    if (slot < LINK_HEAD_SLOTS && mode < 2U) {
        packed->bytes[0] = (U8)(TOKEN_REQUEST | mode << 4 | slot);
    } else {
        packed->bytes[0] = (U8)(TOKEN_LITERAL | mode);
        if (mode == 2U) {
            Link_put32(packed->bytes + 1, id);
            packed->prefix = 5;
        }
        packed->bytes[packed->prefix++] = (U8)head;
        packed->middle = head;
        packed->tailAt -= 2U; /* the encoding's version */
    }
    packed->tail = size - packed->tailAt;
}

static void packReply(const Link_Heads* heads, int channel, const U8* m, U32 size,
                      Link_Packed* packed) {
    static const U8 version[2] = {1, 1};
    U32 id = Link_get32(m + HEADER);
    int isPlain = size >= BEFORE_HEAD + 1U + ENCAPSULATION && m[BEFORE_HEAD] == 0 &&
                  Link_get32(m + BEFORE_HEAD + 1U) == size - BEFORE_HEAD - 1U &&
                  memcmp(m + BEFORE_HEAD + 5U, version, 2) == 0;
    U32 hasId = id != heads->lastReply[channel] + 1U;
    packed->bytes[0] = (U8)(TOKEN_REPLY | hasId << 1 | (U32)!isPlain);
    packed->prefix = 1;
    if (hasId) {
        Link_put32(packed->bytes + 1, id);
        packed->prefix = 5;
    }
    packed->tailAt = BEFORE_HEAD + (isPlain ? 1U + ENCAPSULATION : 0U);
    packed->tail = size - packed->tailAt;
}

void Link_packHead(const Link* link, int channel, const U8* m, U32 size, Link_Packed* packed) {
    U32 head = headOf(m, size);
    packed->prefix = packed->middle = packed->tailAt = 0;
    packed->tail = size;
    if (head) {
        packRequest(&link->headsOut, channel, m, size, head, packed);
    } else if (isMessage(m, size, REPLY, BEFORE_HEAD + 1U) && m[9] == 0) {
        packReply(&link->headsOut, channel, m, size, packed);
    } else if (size == HEADER && m[9] < 2 &&
               (isMessage(m, size, CLOSE, HEADER) ||
                (m[9] == 0 && isMessage(m, size, VALIDATE, HEADER)))) {
        packed->bytes[0] = (U8)(m[8] == VALIDATE ? TOKEN_VALIDATE : TOKEN_CLOSE + m[9]);
        packed->prefix = 1;
        packed->tail = 0;
    } else if (m[0] >= TOKEN_REQUEST) {
        packed->bytes[0] = TOKEN_AS_IT_IS;
        packed->prefix = 1;
    }
}

void Link_putPacked(Link* link, int channel, const U8* m, U32 size, const Link_Packed* packed) {
    Link_put(link, packed->bytes, packed->prefix);
    Link_put(link, m + BEFORE_HEAD, packed->middle);
    Link_put(link, m + packed->tailAt, packed->tail);
    note(&link->headsOut, channel, m, size);
    if (LINK_STATISTICS)
        link->statistics.headBytesSaved += size - packed->prefix - packed->middle - packed->tail;
}

/* Writes the header, and what stands between it and `body`, in front of `body`. Returns the start.
 */
static U8* putHeader(U8* start, U32 type, U32 compression, U32 size) {
    memcpy(start, magic, sizeof magic);
    start[8] = (U8)type;
    start[9] = (U8)compression;
    Link_put32(start + 10, size);
    return start;
}

static U8* unpackRequest(const Link* link, U8* p, const U8* end) {
    const Link_Heads* heads = &link->headsIn;
    U8 entry[LINK_HEAD_BYTES]; /* a copy: what is written may lie over it */
    U32 token = *p++;
    U32 mode = token < TOKEN_LITERAL ? token >> 4 & 1U : token & 3U;
    U32 id = mode == 1U ? heads->lastRequest[link->messageChannel] + 1U : 0;
    U32 n;
    if (token < TOKEN_LITERAL) {
        n = heads->size[token & 15U];
        memcpy(entry, heads->head[token & 15U], sizeof entry);
    } else {
        if (token > TOKEN_LITERAL + 2U || end - p < (mode == 2U ? 5 : 1))
            return 0;
        if (mode == 2U) {
            id = Link_get32(p);
            p += 4;
        }
        n = *p++ + 2U;
        if (n > LINK_HEAD_BYTES || end - p < (int)n)
            return 0;
        memcpy(entry, p, n);
        p += n;
    }
    if (n < 2U)
        return 0; /* an empty slot */
    p -= 2;
    memcpy(p, entry + n - 2U, 2);
    p -= 4;
    Link_put32(p, (U32)(end - p));
    p -= n - 2U;
    memcpy(p, entry, n - 2U);
    p -= 4;
    Link_put32(p, id);
    p -= HEADER;
    return putHeader(p, REQUEST, 0, (U32)(end - p));
}

static U8* unpackReply(const Link* link, U8* p, const U8* end) {
    U32 token = *p++;
    U32 id = link->headsIn.lastReply[link->messageChannel] + 1U;
    if (token > TOKEN_REPLY + 3U)
        return 0;
    if (token & 2U) {
        if (end - p < 4)
            return 0;
        id = Link_get32(p);
        p += 4;
    }
    if (!(token & 1U)) {
        p -= 7;
        p[0] = 0;
        Link_put32(p + 1, (U32)(end - p) - 1U);
        p[5] = p[6] = 1;
    }
    p -= 4;
    Link_put32(p, id);
    p -= HEADER;
    return putHeader(p, REPLY, 0, (U32)(end - p));
}

int Link_unpackHead(Link* link) {
    U8* p = link->messageStart;
    U8* end = p + link->messageSize;
    U32 token = *p;
    if (token == TOKEN_AS_IT_IS)
        ++p;
    else if (token >= TOKEN_VALIDATE) {
        U32 compression = token == TOKEN_CLOSE + 1U;
        if (token > TOKEN_CLOSE + 1U || link->messageSize != 1)
            return 0;
        p = putHeader(end - HEADER, token == TOKEN_VALIDATE ? VALIDATE : CLOSE, compression,
                      HEADER);
    } else if (token >= TOKEN_REPLY)
        p = unpackReply(link, p, end);
    else if (token >= TOKEN_REQUEST)
        p = unpackRequest(link, p, end);
    if (!p || p == end || (U32)(end - p) > LINK_MAX_MESSAGE)
        return 0;
    link->messageStart = p;
    link->messageSize = (U16)(end - p);
    note(&link->headsIn, link->messageChannel, p, link->messageSize);
    return 1;
}
