/* SPDX-License-Identifier: MIT
 *
 * ice_proxy: reads and writes proxies, and makes changed copies of proxies.
 *
 * Identity, facet and endpoints are stored in their encoded form, because sending is the most
 * frequent use of a proxy.
 */
#include "ice_message.h"

#include <string.h>

void icec_initProxy(Ice_ObjectPrxPtr prx, Ice_CommunicatorPtr ic) {
    memset(prx, 0, sizeof *prx);
    prx->communicator = ic;
    prx->timeoutMs = ICE_TIMEOUT_MS;
    prx->minor = 1;
    prx->endpointsSize = 2; /* no endpoints and no adapter id */
    if (ICEC_FULL) {
        prx->call = prx->connection = -1;
        memset(prx->versions, 1, sizeof prx->versions);
        prx->versions[1] = 0; /* default versions: protocol 1.0, encoding 1.1 */
    }
}

Ice_Status icec_setIdentity(Ice_ObjectPrxPtr prx, const Ice_String* name,
                            const Ice_String* category, const Ice_String* facet) {
    Ice_OutputStream os;
    Ice_OutputStream_init(&os, prx->identity, ICE_IDENTITY_MAX);
    Ice_OutputStream_writeString(&os, *name);
    if (category)
        Ice_OutputStream_writeString(&os, *category);
    else
        Ice_OutputStream_writeByte(&os, 0);
    if (facet)
        icec_writeFacet(&os, facet);
    else
        Ice_OutputStream_writeByte(&os, 0);
    prx->identitySize = (Ice_Byte)os.size;
    return os.failed ? ICE_LIMIT : ICE_OK;
}

int Ice_ObjectPrx_isNull(const Ice_ObjectPrx* prx) {
    return prx->identity[0] == 0;
}

Ice_Identity Ice_ObjectPrx_getIdentity(const Ice_ObjectPrx* prx) {
    Ice_Identity id;
    Ice_InputStream is;
    Ice_InputStream_init(&is, prx->identity, prx->identitySize);
    id.name = Ice_InputStream_readString(&is);
    id.category = Ice_InputStream_readString(&is);
    return id;
}

Ice_String Ice_ObjectPrx_getFacet(const Ice_ObjectPrx* prx) {
    Ice_String facet;
    Ice_InputStream is;
    Ice_InputStream_init(&is, prx->identity, prx->identitySize);
    icec_skipStrings(&is, 2);
    icec_readFacet(&is, &facet);
    return facet;
}

/* In endpoints with a transport that this program supports, replaces the encoding by the encoding
 * of the message, as Ice does. Other endpoints remain unchanged. */
static void adoptEncoding(Ice_CommunicatorPtr ic, Ice_Byte* endpoints, Ice_Byte minor) {
    Ice_Byte* at = endpoints + 1;
    int n;
    for (n = endpoints[0]; n > 0; --n) {
        /* size of an endpoint, which consists of its type and its encapsulation; at most
         * ICE_ENDPOINT_MAX */
        Ice_Int size = 2 + at[2];
        Ice_OutputStream nothing;
        Ice_OutputStream_init(&nothing, 0, 0);
        if (at[7] != minor && icec_printEndpoint(ic, at, size, &nothing))
            at[7] = minor;
        at += size;
    }
}

void Ice_OutputStream_writePrx(Ice_OutputStreamPtr os, const Ice_ObjectPrx* prx) {
    if (!prx || Ice_ObjectPrx_isNull(prx)) {
        Ice_OutputStream_writeShort(os, 0); /* two empty strings */
        return;
    }
    if (ICEC_FULL && prx->generation)
        /* a fixed proxy cannot be sent, because its connection exists only in this process */
        os->failed = ICE_FAILED_MALFORMED;
    Ice_OutputStream_writeBlob(os, prx->identity, prx->identitySize);
    Ice_OutputStream_writeShort(os, (Ice_Short)(prx->mode | prx->secure << 8));
    if (ICEC_FULL && os->minor != 0)
        Ice_OutputStream_writeBlob(os, prx->versions, 4);
    else if (os->minor != 0) /* protocol 1.0, then the encoding */
        Ice_OutputStream_writeInt(os, 0x00010001 | prx->minor << 24);
    Ice_OutputStream_writeBlob(os, prx->endpoints, prx->endpointsSize);
    if (ICEC_FULL && !os->failed && prx->communicator)
        adoptEncoding(prx->communicator, os->data + os->size - prx->endpointsSize, os->minor);
}

/* Appends bytes of the message to the endpoints of the proxy. Returns 0 if they do not fit. */
static int keep(Ice_InputStreamPtr is, Ice_Int begin, Ice_ObjectPrxPtr prx) {
    Ice_Int size = is->position - begin;
    if (is->failed || size > ICE_ENDPOINT_MAX - prx->endpointsSize)
        return 0;
    memcpy(prx->endpoints + prx->endpointsSize, is->data + begin, (size_t)size);
    prx->endpointsSize = (Ice_Byte)(prx->endpointsSize + size);
    return 1;
}

void Ice_InputStream_readPrx(Ice_InputStreamPtr is, Ice_CommunicatorPtr ic, Ice_ObjectPrxPtr prx) {
    Ice_String name, category, facet;
    Ice_Int n, begin;
    icec_initProxy(prx, ic ? ic : is->communicator);
    Ice_InputStream_takeString(is, &name);
    Ice_InputStream_takeString(is, &category);
    if (name.size == 0)
        return;
    icec_readFacet(is, &facet);
    if (!is->failed && icec_setIdentity(prx, &name, &category, &facet) != ICE_OK)
        is->failed = ICE_FAILED_IDENTITY;
    prx->mode = Ice_InputStream_readByte(is);
    prx->secure = Ice_InputStream_readBool(is);
    /* In encoding 1.0, a proxy has no version; the version of the stream is used. */
    prx->minor = is->minor;
    if (ICEC_FULL)
        prx->versions[3] = is->minor;
    if (is->minor != 0) {
        const Ice_Byte* versions = Ice_InputStream_readBlob(is, 4);
        /* a peer that supports a later encoding also supports 1.1 */
        prx->minor = versions && versions[3] != 0;
        if (ICEC_FULL && versions)
            memcpy(prx->versions, versions, 4);
    }
    prx->endpointsSize = 1;
    n = Ice_InputStream_readSequence(is, 8);
    begin = is->position;
    if (n == 0) {
        icec_skipStrings(is, 1);
        if (!is->failed && !keep(is, begin, prx))
            is->failed = ICE_FAILED_ENDPOINT;
    }
    /* Endpoints that do not fit are omitted, provided that at least one fits. */
    for (; n > 0 && !is->failed; --n) {
        Ice_Int size;
        begin = is->position;
        (void)Ice_InputStream_readShort(is);
        size = Ice_InputStream_readInt(is);
        (void)Ice_InputStream_readBlob(is, size < 6 ? -1 : size - 4);
        prx->endpoints[0] = (Ice_Byte)(prx->endpoints[0] + keep(is, begin, prx));
        if (n == 1 && prx->endpoints[0] == 0 && !is->failed)
            is->failed = ICE_FAILED_ENDPOINT;
    }
    if (prx->mode > ICE_BATCH_DATAGRAM && !is->failed)
        is->failed = ICE_FAILED_MALFORMED;
}

Ice_Identity icec_parseIdentity(const char* text) {
    Ice_Identity id;
    const char* slash = strchr(text, '/');
    id.category.data = text;
    id.category.size = slash ? (Ice_Int)(slash - text) : 0;
    id.name = Ice_String_from(slash ? slash + 1 : text);
    return id;
}

int Ice_ObjectPrx_equals(const Ice_ObjectPrx* a, const Ice_ObjectPrx* b) {
    return a->mode == b->mode && a->secure == b->secure && a->minor == b->minor &&
           (!ICEC_FULL || memcmp(a->versions, b->versions, sizeof a->versions) == 0) &&
           a->generation == b->generation && a->identitySize == b->identitySize &&
           a->endpointsSize == b->endpointsSize &&
           memcmp(a->identity, b->identity, a->identitySize) == 0 &&
           memcmp(a->endpoints, b->endpoints, a->endpointsSize) == 0;
}

Ice_Status Ice_ObjectPrx_ice_identity(Ice_ObjectPrxPtr prx, const char* identity) {
    Ice_Identity id = icec_parseIdentity(identity);
    return id.name.size ? icec_setIdentity(prx, &id.name, &id.category, 0) : ICE_PARSE;
}

Ice_Status Ice_ObjectPrx_ice_facet(Ice_ObjectPrxPtr prx, const char* facet) {
    Ice_String text = Ice_String_from(facet);
    Ice_InputStream is;
    Ice_OutputStream os;
    Ice_InputStream_init(&is, prx->identity, prx->identitySize);
    icec_skipStrings(&is, 2);
    Ice_OutputStream_init(&os, prx->identity, ICE_IDENTITY_MAX);
    os.size = is.position; /* the facet follows name and category */
    icec_writeFacet(&os, &text);
    prx->identitySize = (Ice_Byte)os.size;
    return os.failed ? ICE_LIMIT : ICE_OK;
}

void Ice_ObjectPrx_ice_twoway(Ice_ObjectPrxPtr prx) {
    prx->mode = ICE_TWOWAY;
    prx->batch = 0;
}

void Ice_ObjectPrx_ice_oneway(Ice_ObjectPrxPtr prx) {
    prx->mode = ICE_ONEWAY;
    prx->batch = 0;
}

void Ice_ObjectPrx_ice_context(Ice_ObjectPrxPtr prx, const Ice_ContextEntry* context) {
    prx->context = context;
}

void Ice_ObjectPrx_ice_invocationTimeout(Ice_ObjectPrxPtr prx, Ice_Int ms) {
    prx->timeoutMs = ms;
}

void Ice_ObjectPrx_ice_encodingVersion(Ice_ObjectPrxPtr prx, Ice_Byte minor) {
    prx->minor = minor != 0;
    if (ICEC_FULL) {
        prx->versions[2] = 1;
        prx->versions[3] = prx->minor;
    }
}

void Ice_ObjectPrx_setReplyBuffer(Ice_ObjectPrxPtr prx, U32* buffer, Ice_Int bytes) {
    prx->reply = buffer;
    prx->replySize = bytes & ~7;
}
