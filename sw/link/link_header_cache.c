/* SPDX-License-Identifier: MIT
 *
 * link_header_cache: recognises Ice's messages, and converts their headers to tokens and back.
 */
#include "link_header_cache.h"

#include <string.h>

/* size of an Ice message's header, bytes: magic, versions, type, compression, size */
#define HEADER 14U
/* bytes before the parameters: size and encoding of the encapsulation */
#define ENCAPSULATION 6U
#define MOST_HEAD (LINK_HEAD_BYTES - 2U)

/* request with a cached header. Bit 4: 1 if the request id is the next one of the channel, 0 if the
 * request is oneway. Bits 3..0: index of the header in the cache. */
#define TOKEN_REQUEST 0x80U
/* request with a new header. Bits 1..0: 0 if the request is oneway, 1 if the request id is the next
 * one, 2 if the id follows. After that: length of the header, and the header. */
#define TOKEN_LITERAL 0xA0U
/* reply. Bit 1: 1 if the request id follows, 0 if it is the next one. Bit 0: 1 if status and body
 * follow unchanged. */
#define TOKEN_REPLY 0xB0U
#define TOKEN_VALIDATE 0xC0U
/* message that closes the connection; 0xC2 if its compression byte is set */
#define TOKEN_CLOSE 0xC1U
#define TOKEN_AS_IT_IS 0xFFU

#define MAGIC 0x50656349U    /* "IceP" */
#define VERSIONS 0x00010001U /* version of the protocol and version of the encoding, both 1.0 */

enum { REQUEST = 0, REPLY = 2, VALIDATE = 3, CLOSE = 4 };

#define IS_REPLY 1U /* value that stands for a reply; every header is larger */

/* Returns the type of a complete message; -1 if it is not an Ice message. */
static int typeOf(const U8* m, U32 size) {
    return size >= HEADER && link_get32(m) == MAGIC && link_get32(m + 4) == VERSIONS &&
                   link_get32(m + 10) == size
               ? m[8]
               : -1;
}

/* Returns the size of the header (identity to context) that the peer's cache learns from a request.
 * Returns IS_REPLY for a reply, from which only the request id is learned. Returns 0 for any other
 * message. */
static U32 headOf(const U8* m, U32 size, int type) {
    U32 at = LINK_HEAD_AT;
    int strings;
    if (type == REPLY)
        return size > LINK_HEAD_AT ? IS_REPLY : 0;
    if (type != REQUEST || size < LINK_HEAD_AT || m[9] != 0)
        return 0;
    /* the four strings are name, category, facet and operation */
    for (strings = 0; strings < 4; ++strings) {
        if (strings == 2) {
            if (at >= size || m[at] > 1)
                return 0;
            if (m[at++] == 0)
                continue;
        }
        if (at >= size || m[at] == 255)
            return 0;
        at += 1U + m[at];
    }
    ++at; /* mode */
    if (at >= size || m[at++] != 0)
        return 0; /* a request with a context is not cached, because contexts seldom repeat */
    if (at + ENCAPSULATION > size || link_get32(m + at) != size - at)
        return 0;
    return at - LINK_HEAD_AT <= MOST_HEAD ? at - LINK_HEAD_AT : 0;
}

/* Returns the index of this header and encoding in the cache; LINK_HEADS if the cache does not
 * contain them. */
static U32 find(const Link_HeaderCache* cache, const U8* head, U32 size, const U8* version) {
    U32 slot;
    for (slot = 0; slot < LINK_HEADS; ++slot)
        if (cache->size[slot] == size + 2U && memcmp(cache->head[slot], head, size) == 0 &&
            memcmp(cache->head[slot] + size, version, 2) == 0)
            break;
    return slot;
}

void link_cacheHeader(Link_HeaderCache* cache, int channel, const U8* m, U32 head) {
    const U8* version = m + LINK_HEAD_AT + head + 4;
    U32 id = link_get32(m + HEADER);
    if (head == IS_REPLY) {
        cache->lastReply[channel] = id;
        return;
    }
    if (id)
        cache->lastRequest[channel] = id;
    if (find(cache, m + LINK_HEAD_AT, head, version) == LINK_HEADS) {
        U8* entry = cache->head[cache->next];
        cache->size[cache->next] = (U8)(head + 2U);
        memcpy(entry, m + LINK_HEAD_AT, head);
        memcpy(entry + head, version, 2);
        cache->next = (U8)((cache->next + 1U) % LINK_HEADS);
    }
}

/* Begins a compressed message with a token; if `hasId`, appends the id. */
static void setToken(Link_Compressed* to, U32 token, int hasId, U32 id) {
    to->bytes[0] = (U8)token;
    to->prefix = hasId ? 5U : 1U;
    link_put32(to->bytes + 1, id);
}

static void packRequest(const Link_HeaderCache* cache, int channel, const U8* m, U32 head,
                        Link_Compressed* to) {
    U32 id = link_get32(m + HEADER);
    U32 mode = id == 0 ? 0U : id == cache->lastRequest[channel] + 1U ? 1U : 2U;
    U32 slot = find(cache, m + LINK_HEAD_AT, head, m + LINK_HEAD_AT + head + 4);
    to->tailAt = LINK_HEAD_AT + head + ENCAPSULATION;
    if (slot < LINK_HEADS && mode < 2U) {
        setToken(to, TOKEN_REQUEST | mode << 4 | slot, 0, 0);
        return;
    }
    setToken(to, TOKEN_LITERAL | mode, mode == 2U, id);
    to->bytes[to->prefix++] = (U8)head;
    to->middle = head;
    to->tailAt -= 2U; /* the rest of the message begins with the version of the encoding */
}

static void packReply(const Link_HeaderCache* cache, int channel, const U8* m, U32 size,
                      Link_Compressed* to) {
    const U8* body = m + LINK_HEAD_AT + 1;
    U32 id = link_get32(m + HEADER);
    int isPlain = size >= LINK_HEAD_AT + 1U + ENCAPSULATION && m[LINK_HEAD_AT] == 0 &&
                  link_get32(body) == size - LINK_HEAD_AT - 1U && body[4] == 1 && body[5] == 1;
    U32 hasId = id != cache->lastReply[channel] + 1U;
    to->tailAt = LINK_HEAD_AT + (isPlain ? 1U + ENCAPSULATION : 0U);
    setToken(to, TOKEN_REPLY | hasId << 1 | (U32)!isPlain, hasId != 0, id);
}

void link_compress(const Link_HeaderCache* cache, int channel, const U8* m, U32 size,
                   Link_Compressed* to) {
    int type = typeOf(m, size);
    to->head = headOf(m, size, type);
    if (to->head > IS_REPLY) {
        packRequest(cache, channel, m, to->head, to);
    } else if (to->head && m[9] == 0) {
        packReply(cache, channel, m, size, to);
    } else if (size == HEADER && ((type == CLOSE && m[9] < 2) || (type == VALIDATE && m[9] == 0))) {
        to->tailAt = size;
        setToken(to, type == VALIDATE ? TOKEN_VALIDATE : TOKEN_CLOSE + m[9], 0, 0);
    } else if (m[0] >= TOKEN_REQUEST) {
        setToken(to, TOKEN_AS_IT_IS, 0, 0);
    }
}

/* Replaces a request's token at `p`, and the bytes that belong to it, by the fields before the
 * body. Returns the start of these fields; 0 if the request is malformed. */
static U8* unpackRequest(Link_HeaderCache* cache, U32 channel, U8* p, const U8* end) {
    U8 head[LINK_HEAD_BYTES]; /* copied, because the output may overwrite it */
    U32 token = *p++;
    U32 mode = token < TOKEN_LITERAL ? token >> 4 & 1U : token & 3U;
    U32 id = mode == 1U ? ++cache->lastRequest[channel] : 0;
    U32 n;
    if (token < TOKEN_LITERAL) {
        n = cache->size[token & 15U];
        memcpy(head, cache->head[token & 15U], sizeof head);
    } else {
        if (token > TOKEN_LITERAL + 2U || end - p < (mode == 2U ? 5 : 1))
            return 0;
        if (mode == 2U) {
            id = link_get32(p);
            p += 4;
        }
        n = *p++ + 2U;
        if (n > LINK_HEAD_BYTES || end - p < (int)n)
            return 0;
        memcpy(head, p, n);
        p += n;
    }
    if (n < 2U)
        return 0; /* the cache has no header at this index */
    p -= 2;
    memcpy(p, head + n - 2U, 2);
    p -= 4;
    link_put32(p, (U32)(end - p));
    p -= n - 2U;
    memcpy(p, head, n - 2U);
    p -= 4;
    link_put32(p, id);
    return p;
}

/* Replaces a reply's token at `p`, and the bytes that belong to it, as unpackRequest does. */
static U8* unpackReply(const Link_HeaderCache* cache, U32 channel, U8* p, const U8* end) {
    U32 token = *p++;
    U32 id = cache->lastReply[channel] + 1U;
    if (token > TOKEN_REPLY + 3U)
        return 0;
    if (token & 2U) {
        if (end - p < 4)
            return 0;
        id = link_get32(p);
        p += 4;
    }
    if (!(token & 1U)) {
        p -= 7;
        p[0] = 0;
        link_put32(p + 1, (U32)(end - p) - 1U);
        p[5] = p[6] = 1;
    }
    p -= 4;
    link_put32(p, id);
    return p;
}

/* Restores the compressed message at `p`. Returns the start of the message; 0 if it is
 * malformed. */
static U8* unpack(Link_HeaderCache* cache, U32 channel, U8* p, U8* end) {
    U32 token = *p;
    U32 type = REQUEST;
    U32 compression = 0;
    if (token < TOKEN_REQUEST)
        return p;
    if (token == TOKEN_AS_IT_IS)
        return p + 1;
    if (token >= TOKEN_VALIDATE) {
        if (token > TOKEN_CLOSE + 1U || end - p != 1)
            return 0;
        type = token == TOKEN_VALIDATE ? VALIDATE : CLOSE;
        compression = token == TOKEN_CLOSE + 1U;
        p = end;
    } else if (token >= TOKEN_REPLY) {
        type = REPLY;
        p = unpackReply(cache, channel, p, end);
    } else {
        p = unpackRequest(cache, channel, p, end);
    }
    if (!p)
        return 0;
    p -= HEADER;
    link_put32(p, MAGIC);
    link_put32(p + 4, VERSIONS);
    p[8] = (U8)type;
    p[9] = (U8)compression;
    link_put32(p + 10, (U32)(end - p));
    return p;
}

U8* link_decompress(Link_HeaderCache* cache, int channel, U8* start, U32 size) {
    U8* end = start + size;
    int hasKnownHead = *start >= TOKEN_REQUEST && *start < TOKEN_LITERAL;
    U8* p = unpack(cache, (U32)channel, start, end);
    U32 head;
    if (!p || p == end || (U32)(end - p) > LINK_MAX_MESSAGE)
        return 0;
    size = (U32)(end - p);
    head = hasKnownHead ? 0 : headOf(p, size, typeOf(p, size));
    if (head)
        link_cacheHeader(cache, channel, p, head);
    return p;
}
