/* SPDX-License-Identifier: MIT
 *
 * ice_proxy: what a proxy is made of, and how it travels.
 */
#include "ice_private.h"

#include <string.h>

#define DEFAULT_TIMEOUT_MS 10000

void Ice_ObjectPrx_init(Ice_ObjectPrxPtr prx, Ice_CommunicatorPtr ic) {
    memset(prx, 0, sizeof *prx);
    prx->communicator = ic;
    prx->timeoutMs = DEFAULT_TIMEOUT_MS;
    prx->minor = 1;
    prx->call = prx->connection = -1;
}

Ice_Status Ice_ObjectPrx_setIdentity(Ice_ObjectPrxPtr prx, Ice_String name, Ice_String category,
                                     Ice_String facet) {
    Ice_Int whole = name.size;
    if (ICEC_CATEGORIES && category.size <= ICE_IDENTITY_MAX && facet.size <= ICE_IDENTITY_MAX)
        whole += category.size + facet.size;
    else if (category.size || facet.size)
        return ICE_LIMIT;
    if (name.size > ICE_IDENTITY_MAX || whole > ICE_IDENTITY_MAX)
        return ICE_LIMIT;
    memmove(prx->identity, name.data, (size_t)name.size);
    prx->nameSize = (Ice_Byte)name.size;
    if (ICEC_CATEGORIES) {
        prx->categorySize = (Ice_Byte)category.size;
        prx->facetSize = (Ice_Byte)facet.size;
        memcpy(prx->identity + name.size, category.data, (size_t)category.size);
        memcpy(prx->identity + name.size + category.size, facet.data, (size_t)facet.size);
    }
    return ICE_OK;
}

Ice_Status Ice_ObjectPrx_addEndpoint(Ice_ObjectPrxPtr prx, const char *options) {
    Ice_CommunicatorPtr ic = prx->communicator;
    Ice_OutputStream os;
    Ice_OutputStream_init(&os, prx->encoded, ICE_ENDPOINT_MAX);
    os.size = prx->encodedSize;
    ic->endpoint->encode(ic->endpointContext, options, &os);
    if (os.failed)
        return ICE_LIMIT;
    prx->encodedSize = (Ice_Byte)os.size;
    ++prx->endpointCount;
    return ICE_OK;
}

int Ice_ObjectPrx_isNull(const Ice_ObjectPrx *prx) {
    return prx->nameSize == 0;
}

Ice_Identity Ice_ObjectPrx_getIdentity(const Ice_ObjectPrx *prx) {
    Ice_Identity id;
    id.name.data = prx->identity;
    id.name.size = prx->nameSize;
    id.category.data = prx->identity + prx->nameSize;
    id.category.size = ICEC_CATEGORIES ? prx->categorySize : 0;
    return id;
}

Ice_String Ice_ObjectPrx_getFacet(const Ice_ObjectPrx *prx) {
    Ice_String facet;
    facet.data = prx->identity + prx->nameSize + prx->categorySize;
    facet.size = ICEC_CATEGORIES ? prx->facetSize : 0;
    return facet;
}

void Ice_OutputStream_writePrx(Ice_OutputStreamPtr os, const Ice_ObjectPrx *prx) {
    Ice_Identity id;
    if (!prx || Ice_ObjectPrx_isNull(prx)) {
        Ice_OutputStream_writeShort(os, 0); /* two empty strings */
        return;
    }
    if (ICEC_ASYNC && prx->generation)
        os->failed = 1; /* nobody else has this connection */
    id = Ice_ObjectPrx_getIdentity(prx);
    Ice_OutputStream_writeString(os, id.name);
    Ice_OutputStream_writeString(os, id.category);
    Ice_writeFacet(os, Ice_ObjectPrx_getFacet(prx));
    Ice_OutputStream_writeByte(os, prx->mode);
    Ice_OutputStream_writeByte(os, prx->secure);
    if (os->minor != 0) {
        Ice_OutputStream_writeShort(os, 1); /* protocol 1.0 */
        Ice_OutputStream_writeShort(os, (Ice_Short)(1 | prx->minor << 8));
    }
    Ice_OutputStream_writeSize(os, prx->endpointCount);
    if (prx->endpointCount)
        Ice_OutputStream_writeBlob(os, prx->encoded, prx->encodedSize);
    else /* an adapter's id, in a proxy without endpoints */
        Ice_OutputStream_writeSize(os, prx->encodedSize),
            Ice_OutputStream_writeBlob(os, prx->encoded, prx->encodedSize);
}

/* Keeps bytes of the message behind those kept so far. 0: no room. */
static int keep(Ice_InputStreamPtr is, Ice_Int begin, Ice_ObjectPrxPtr prx) {
    Ice_Int size = is->position - begin;
    if (is->failed || size > ICE_ENDPOINT_MAX - prx->encodedSize)
        return 0;
    memcpy(prx->encoded + prx->encodedSize, is->data + begin, (size_t)size);
    prx->encodedSize = (Ice_Byte)(prx->encodedSize + size);
    return 1;
}

void Ice_InputStream_readPrx(Ice_InputStreamPtr is, Ice_CommunicatorPtr ic, Ice_ObjectPrxPtr prx) {
    Ice_String name = Ice_InputStream_readString(is);
    Ice_String category = Ice_InputStream_readString(is);
    Ice_String facet;
    Ice_Int n, begin;
    Ice_ObjectPrx_init(prx, ic ? ic : is->communicator);
    if (name.size == 0)
        return;
    facet = Ice_readFacet(is);
    if (Ice_ObjectPrx_setIdentity(prx, name, category, facet) != ICE_OK)
        is->failed = 1;
    prx->mode = Ice_InputStream_readByte(is);
    prx->secure = Ice_InputStream_readByte(is);
    if (is->minor != 0) {
        const Ice_Byte *versions = Ice_InputStream_readBlob(is, 4);
        prx->minor = versions && versions[3] != 0; /* of a later encoding 1.1 is understood there */
    }
    n = Ice_InputStream_readSequence(is, 8);
    if (n == 0) {
        Ice_String adapter = Ice_InputStream_readString(is);
        if (!keep(is, is->position - adapter.size, prx))
            is->failed = 1;
        return;
    }
    for (; n > 0; --n) {
        Ice_Int size;
        begin = is->position;
        (void)Ice_InputStream_readShort(is);
        size = Ice_InputStream_readInt(is);
        (void)Ice_InputStream_readBlob(is, size < 6 ? -1 : size - 4);
        prx->endpointCount = (Ice_Byte)(prx->endpointCount + keep(is, begin, prx));
    }
    if (prx->endpointCount == 0 || prx->mode > ICE_BATCH_DATAGRAM)
        is->failed = 1;
}
