/* SPDX-License-Identifier: MIT
 *
 * ice_communicator: initialises, shuts down and destroys the communicator.
 */
#include "ice_private.h"

#include <string.h>

static void noLock(void* context, int which) {
    (void)context;
    (void)which;
}

static int neverWoken(void* context, int slot, Ice_Int timeoutMs) {
    (void)context;
    (void)slot;
    (void)timeoutMs;
    return 0;
}

static int oneTask(void* context) {
    (void)context;
    return 0;
}

const Ice_Os Ice_Os_none = {noLock, noLock, neverWoken, noLock, oneTask};

void Ice_initialize(Ice_CommunicatorPtr ic) {
    memset(ic, 0, sizeof *ic);
    ic->os = &Ice_Os_none;
    ic->receiver = -1;
}

void Ice_Communicator_setOs(Ice_CommunicatorPtr ic, const Ice_Os* os, void* context) {
    ic->os = os;
    ic->osContext = context;
}

void Ice_Communicator_shutdown(Ice_CommunicatorPtr ic) {
    int t;
    icec_lock(ic, ICE_LOCK_STATE);
    ic->stopping = 1;
    for (t = 0; t < ICEC_TRANSPORTS(ic); ++t)
        (void)ic->transports[t].endpoint->listen(ic->transports[t].context, 0);
    icec_unlock(ic, ICE_LOCK_STATE);
    icec_wake(ic);
    ic->os->wake(ic->osContext, ICEC_SERVER_SLOT);
}

static int isOpen(Ice_CommunicatorPtr ic, int connection) {
    return icec_connectionState(ic, connection) != ICE_CONNECTION_NONE;
}

static int anyOpen(Ice_CommunicatorPtr ic) {
    int c;
    for (c = 0; c < ICE_TRANSPORTS * ICE_CONNECTIONS; ++c)
        if (isOpen(ic, c))
            return 1;
    return 0;
}

void Ice_Communicator_destroy(Ice_CommunicatorPtr ic, Ice_Int timeoutMs) {
    U32 begin = icec_nowMs(ic);
    Ice_Int left = timeoutMs;
    int c;
    Ice_Communicator_shutdown(ic);
    while (anyOpen(ic) && left > 0) {
        for (c = 0; c < ICE_TRANSPORTS * ICE_CONNECTIONS; ++c)
            icec_askToClose(ic, c);
        (void)Ice_Communicator_poll(ic, left);
        left = timeoutMs - (Ice_Int)(icec_nowMs(ic) - begin);
    }
    for (c = 0; c < ICE_TRANSPORTS * ICE_CONNECTIONS; ++c)
        if (isOpen(ic, c)) {
            icec_closeConnection(ic, c);
            icec_loseConnection(ic, c, ICE_CONNECTION_LOST);
        }
}

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
    icec_wake(ic); /* wakes the receiving task: one of its calls may have failed */
}
