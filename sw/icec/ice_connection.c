/* SPDX-License-Identifier: MIT
 *
 * ice_connection: operations of a program on one connection: bound proxies, its end.
 */
#include "ice_calls.h"
#include "ice_message.h"
#include "ice_proxy.h"
#include "ice_transport.h"

Ice_Status Ice_Connection_createProxy(Ice_CommunicatorPtr ic, int connection, const char* identity,
                                      Ice_ObjectPrxPtr prx) {
    Ice_Identity id = icec_parseIdentity(identity);
    return Ice_Connection_createProxyTo(ic, connection, &id, prx);
}

Ice_Status Ice_Connection_createProxyTo(Ice_CommunicatorPtr ic, int connection,
                                        const Ice_Identity* identity, Ice_ObjectPrxPtr prx) {
    icec_initProxy(prx, ic);
    if (icec_connectionState(ic, connection) == ICE_CONNECTION_NONE)
        return ICE_CONNECTION_LOST;
    prx->connection = connection;
    prx->generation = ic->connections[connection].generation;
    return icec_setIdentity(prx, &identity->name, &identity->category, 0);
}

void Ice_Connection_close(Ice_CommunicatorPtr ic, int connection) {
    (void)icec_sendHead(ic, connection, ICEC_CLOSE);
    icec_closeConnection(ic, connection);
    icec_loseConnection(ic, connection, ICE_CONNECTION_LOST);
    ic->endpoint->wake(ic->endpointContext); /* the call that failed may be its receiver's */
}
