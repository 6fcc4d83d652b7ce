/* SPDX-License-Identifier: MIT
 *
 * ice_communicator: the communicator: its parts, its properties, its loop.
 */
#include "ice_private.h"

#include <string.h>

#define POLL_MS 1000

static void noLock(void *context, int which) {
    (void)context;
    (void)which;
}

static int neverWoken(void *context, int slot, Ice_Int timeoutMs) {
    (void)context;
    (void)slot;
    (void)timeoutMs;
    return 0;
}

static int oneTask(void *context) {
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

void Ice_Communicator_setOs(Ice_CommunicatorPtr ic, const Ice_Os *os, void *context) {
    ic->os = os;
    ic->osContext = context;
}

void Ice_Communicator_setEndpoint(Ice_CommunicatorPtr ic, const Ice_Endpoint *endpoint,
                                  void *context) {
    ic->endpoint = endpoint;
    ic->endpointContext = context;
}

void Ice_Communicator_waitForShutdown(Ice_CommunicatorPtr ic) {
    if (ICEC_TASKS)
        ic->receiver = ic->os->task(ic->osContext);
    while (!ic->stopping)
        (void)Ice_Communicator_poll(ic, POLL_MS);
    ic->receiver = -1;
    if (ICEC_TASKS)
        Ice_wakeCalls(ic); /* who waits for a reply receives it himself now */
}

void Ice_Communicator_shutdown(Ice_CommunicatorPtr ic) {
    ic->stopping = 1;
    ic->endpoint->wake(ic->endpointContext);
}

static int anyOpen(Ice_CommunicatorPtr ic) {
    int c;
    for (c = 0; c < ICE_CONNECTIONS; ++c)
        if (ic->connections[c].state != ICE_FREE)
            return 1;
    return 0;
}

void Ice_Communicator_destroy(Ice_CommunicatorPtr ic, Ice_Int timeoutMs) {
    U32 begin = Ice_nowMs(ic);
    Ice_Int left = timeoutMs;
    int c;
    for (c = 0; c < ICE_CONNECTIONS; ++c)
        if (ic->connections[c].state != ICE_FREE)
            (void)Ice_sendPlain(ic, c, ICE_CLOSE);
    while (anyOpen(ic) && left > 0) {
        (void)Ice_Communicator_poll(ic, left);
        left = timeoutMs - (Ice_Int)(Ice_nowMs(ic) - begin);
    }
    for (c = 0; c < ICE_CONNECTIONS; ++c)
        if (ic->connections[c].state != ICE_FREE) {
            ic->endpoint->close(ic->endpointContext, c);
            Ice_lose(ic, c, ICE_CONNECTION_LOST);
        }
}
