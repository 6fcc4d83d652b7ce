/* SPDX-License-Identifier: MIT
 *
 * ice_communicator: the communicator: its parts, its properties, its loop.
 */
#include "ice_private.h"

#include <string.h>

#define POLL_MS 1000

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
    if (ICEC_TASKS)
        ic->os = &Ice_Os_none;
    ic->receiver = -1;
}

void Ice_Communicator_setOs(Ice_CommunicatorPtr ic, const Ice_Os* os, void* context) {
    ic->os = os;
    ic->osContext = context;
}

void Ice_Communicator_setEndpoint(Ice_CommunicatorPtr ic, const Ice_Endpoint* endpoint,
                                  void* context) {
    ic->endpoint = endpoint;
    ic->endpointContext = context;
}

static int isStopping(Ice_CommunicatorPtr ic) {
    int is;
    Ice_lock(ic, ICE_LOCK_STATE);
    is = ic->stopping;
    Ice_unlock(ic, ICE_LOCK_STATE);
    return is;
}

void Ice_Communicator_waitForShutdown(Ice_CommunicatorPtr ic) {
    Ice_Role role = ICEC_TASKS ? Ice_takeRole(ic, ICE_FOREVER) : ICE_ROLE_HAD;
    while (role != ICE_ROLE_NONE && !isStopping(ic))
        (void)Ice_receiveOne(ic, POLL_MS);
    if (ICEC_TASKS && role == ICE_ROLE_TAKEN)
        Ice_giveRole(ic); /* who waits for a reply receives it himself now */
}

Ice_Status Ice_Communicator_poll(Ice_CommunicatorPtr ic, Ice_Int timeoutMs) {
    Ice_Status status = ICE_TIMEOUT;
    U32 begin;
    Ice_Role role;
    if (!ICEC_TASKS)
        return Ice_receiveOne(ic, timeoutMs);
    begin = Ice_nowMs(ic);
    role = Ice_takeRole(ic, timeoutMs);
    if (role != ICE_ROLE_NONE) {
        Ice_Int left = timeoutMs - (Ice_Int)(Ice_nowMs(ic) - begin);
        status = Ice_receiveOne(ic, left > 0 ? left : 0);
    }
    if (role == ICE_ROLE_TAKEN)
        Ice_giveRole(ic);
    return status;
}

void Ice_Communicator_shutdown(Ice_CommunicatorPtr ic) {
    Ice_lock(ic, ICE_LOCK_STATE);
    ic->stopping = 1;
    Ice_unlock(ic, ICE_LOCK_STATE);
    ic->endpoint->wake(ic->endpointContext);
    if (ICEC_TASKS)
        ic->os->wake(ic->osContext, ICE_SERVER_SLOT);
}

static int isOpen(Ice_CommunicatorPtr ic, int connection) {
    int is;
    Ice_lock(ic, ICE_LOCK_STATE);
    is = ic->connections[connection].state != ICE_FREE;
    Ice_unlock(ic, ICE_LOCK_STATE);
    return is;
}

static int anyOpen(Ice_CommunicatorPtr ic) {
    int c;
    for (c = 0; c < ICE_CONNECTIONS; ++c)
        if (isOpen(ic, c))
            return 1;
    return 0;
}

void Ice_Communicator_destroy(Ice_CommunicatorPtr ic, Ice_Int timeoutMs) {
    U32 begin = Ice_nowMs(ic);
    Ice_Int left = timeoutMs;
    int c;
    for (c = 0; c < ICE_CONNECTIONS; ++c)
        if (isOpen(ic, c))
            (void)Ice_sendPlain(ic, c, ICE_CLOSE);
    while (anyOpen(ic) && left > 0) {
        (void)Ice_Communicator_poll(ic, left);
        left = timeoutMs - (Ice_Int)(Ice_nowMs(ic) - begin);
    }
    for (c = 0; c < ICE_CONNECTIONS; ++c)
        if (isOpen(ic, c)) {
            ic->endpoint->close(ic->endpointContext, c);
            Ice_lose(ic, c, ICE_CONNECTION_LOST);
        }
}
