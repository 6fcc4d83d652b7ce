/* SPDX-License-Identifier: MIT
 *
 * ice_proxy_change: changes one property of a proxy's copy.
 */
#include "ice_message.h"

#include <string.h>

int Ice_ObjectPrx_equals(const Ice_ObjectPrx* a, const Ice_ObjectPrx* b) {
    return a->mode == b->mode && a->secure == b->secure && a->minor == b->minor &&
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
    Ice_ObjectPrx old = *prx;
    Ice_Identity id = Ice_ObjectPrx_getIdentity(&old);
    Ice_String text = Ice_String_from(facet);
    return icec_setIdentity(prx, &id.name, &id.category, &text);
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
}

void Ice_ObjectPrx_setReplyBuffer(Ice_ObjectPrxPtr prx, U32* buffer, Ice_Int bytes) {
    prx->reply = buffer;
    prx->replySize = bytes & ~7;
}
