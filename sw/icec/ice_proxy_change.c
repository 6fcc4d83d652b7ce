/* SPDX-License-Identifier: MIT
 *
 * ice_proxy_change: proxies that differ in one thing from another.
 */
#include "ice_private.h"

#include <string.h>

int Ice_ObjectPrx_equals(const Ice_ObjectPrx *a, const Ice_ObjectPrx *b) {
    Ice_Identity x = Ice_ObjectPrx_getIdentity(a), y = Ice_ObjectPrx_getIdentity(b);
    return Ice_String_same(x.name, y.name) && Ice_String_same(x.category, y.category) &&
           Ice_String_same(Ice_ObjectPrx_getFacet(a), Ice_ObjectPrx_getFacet(b)) &&
           a->mode == b->mode && a->secure == b->secure && a->minor == b->minor &&
           a->endpointCount == b->endpointCount && a->generation == b->generation &&
           a->encodedSize == b->encodedSize && memcmp(a->encoded, b->encoded, a->encodedSize) == 0;
}

Ice_Status Ice_ObjectPrx_ice_identity(Ice_ObjectPrxPtr prx, const char *identity) {
    Ice_Identity id = Ice_parseIdentity(identity);
    return id.name.size ? Ice_ObjectPrx_setIdentity(prx, id.name, id.category, Ice_String_from(""))
                        : ICE_PARSE;
}

Ice_Status Ice_ObjectPrx_ice_facet(Ice_ObjectPrxPtr prx, const char *facet) {
    Ice_ObjectPrx old = *prx;
    Ice_Identity id = Ice_ObjectPrx_getIdentity(&old);
    return Ice_ObjectPrx_setIdentity(prx, id.name, id.category, Ice_String_from(facet));
}

void Ice_ObjectPrx_ice_twoway(Ice_ObjectPrxPtr prx) {
    prx->mode = ICE_TWOWAY;
    prx->batch = 0;
}

void Ice_ObjectPrx_ice_oneway(Ice_ObjectPrxPtr prx) {
    prx->mode = ICE_ONEWAY;
    prx->batch = 0;
}

void Ice_ObjectPrx_ice_context(Ice_ObjectPrxPtr prx, const Ice_ContextEntry *context) {
    prx->context = context;
}

void Ice_ObjectPrx_ice_invocationTimeout(Ice_ObjectPrxPtr prx, Ice_Int ms) {
    prx->timeoutMs = ms;
}

void Ice_ObjectPrx_ice_encodingVersion(Ice_ObjectPrxPtr prx, Ice_Byte minor) {
    prx->minor = minor != 0;
}

void Ice_ObjectPrx_setReplyBuffer(Ice_ObjectPrxPtr prx, U32 *buffer, Ice_Int bytes) {
    prx->reply = buffer;
    prx->replySize = bytes & ~7;
}
