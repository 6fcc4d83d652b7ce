/* SPDX-License-Identifier: MIT
 *
 * ice_async: calls that do not wait, and proxies that are bound to a connection.
 */
#include "ice_private.h"

Ice_Status Ice_ObjectPrx_invokeAsync(Ice_ObjectPrxPtr self, Ice_Callback callback, void* cookie) {
    Ice_CommunicatorPtr ic = self->communicator;
    int slot = self->call;
    Ice_Status status = Ice_sendRequest(self, callback, cookie);
    if (status != ICE_OK || self->mode != ICE_TWOWAY)
        return Ice_ObjectPrx_end(self, status);
    /* A task that receives already must not sleep past this call's time. */
    if (ic->calls[slot].state == ICE_WAITING)
        ic->endpoint->wake(ic->endpointContext);
    return ICE_OK;
}

Ice_Status Ice_Connection_createProxy(Ice_CommunicatorPtr ic, int connection, const char* identity,
                                      Ice_ObjectPrxPtr prx) {
    Ice_Identity id = Ice_parseIdentity(identity);
    Ice_ObjectPrx_init(prx, ic);
    if (ic->connections[connection].state == ICE_FREE)
        return ICE_CONNECTION_LOST;
    prx->connection = connection;
    prx->generation = ic->connections[connection].generation;
    return Ice_ObjectPrx_setIdentity(prx, &id.name, &id.category, 0);
}
