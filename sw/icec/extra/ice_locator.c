/* SPDX-License-Identifier: MIT
 *
 * ice_locator: resolves an indirect proxy by asking a locator, such as IceGrid's.
 */
#include "ice_message.h"

#include <string.h>

#define MODE (2 | ICE_RESULTS) /* idempotent */

/* Asks the locator for the adapter that the proxy names; if the proxy names no adapter, asks for
 * the object. */
static Ice_Status find(const Ice_ObjectPrx* prx, Ice_ObjectPrxPtr locator, Ice_ObjectPrxPtr found) {
    int byAdapter = prx->endpoints[1] != 0; /* length of the adapter's id */
    Ice_OutputStreamPtr os =
        Ice_ObjectPrx_begin(locator, byAdapter ? "findAdapterById" : "findObjectById", MODE);
    Ice_InputStreamPtr is;
    Ice_Status status;
    if (!os)
        return (Ice_Status)locator->status;
    if (byAdapter) {
        Ice_OutputStream_writeBlob(os, prx->endpoints + 1, prx->endpointsSize - 1);
    } else {
        Ice_Identity id = Ice_ObjectPrx_getIdentity(prx);
        Ice_OutputStream_writeString(os, id.name);
        Ice_OutputStream_writeString(os, id.category);
    }
    status = Ice_ObjectPrx_invoke(locator, &is);
    if (status == ICE_OK) {
        Ice_InputStream_readPrx(is, prx->communicator, found);
        (void)Ice_InputStream_end(is);
    }
    status = Ice_ObjectPrx_end(locator, status);
    return status == ICE_USER_EXCEPTION ? ICE_NO_ENDPOINT : status; /* not registered */
}

Ice_Status Ice_ObjectPrx_resolve(Ice_ObjectPrxPtr self, Ice_ObjectPrxPtr locator) {
    Ice_ObjectPrx asked = *self;
    /* two steps: for an object, the locator may first return an adapter, and then the adapter's
     * endpoints */
    int steps = 2;
    while (asked.endpoints[0] == 0 && steps-- > 0) {
        Ice_ObjectPrx found;
        Ice_Status status = find(&asked, locator, &found);
        if (status != ICE_OK)
            return status; /* `found` is not set after an error */
        if (Ice_ObjectPrx_isNull(&found))
            return ICE_NO_ENDPOINT;
        asked = found;
    }
    if (asked.endpoints[0] == 0)
        return ICE_NO_ENDPOINT;
    memcpy(self->endpoints, asked.endpoints, sizeof self->endpoints);
    self->endpointsSize = asked.endpointsSize;
    return ICE_OK;
}
