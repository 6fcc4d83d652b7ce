/* SPDX-License-Identifier: MIT
 *
 * ice_receiver: chooses which of several tasks receives.
 *
 * One task at a time holds the role: a server (waitForShutdown, poll) as soon as it can have it,
 * else a task that waits for a reply (a leader), as long as it waits. `receiver` and `servers`
 * change under the state lock only. A task that gives the role up wakes another that may want it.
 */
#include "ice_private.h"

/* Gives the role up, and wakes a task that may want it; under the state lock. */
static void giveUp(Ice_CommunicatorPtr ic) {
    ic->receiver = -1;
    if (ic->servers)
        ic->os->wake(ic->osContext, ICEC_SERVER_SLOT);
    else
        icec_wakeCalls(ic);
}

Icec_Role icec_takeRole(Ice_CommunicatorPtr ic, Ice_Int timeoutMs) {
    int task = ic->os->task(ic->osContext);
    U32 begin = icec_nowMs(ic);
    Icec_Role role = ICEC_ROLE_TAKEN;
    icec_lock(ic, ICE_LOCK_STATE);
    if (ic->receiver == task) {
        role = ICEC_ROLE_HAD;
    } else {
        ++ic->servers; /* a leader that sees this gives the role up */
        while (ic->receiver >= 0) {
            Ice_Int left = ICEC_FOREVER;
            if (timeoutMs != ICEC_FOREVER)
                left = timeoutMs - (Ice_Int)(icec_nowMs(ic) - begin);
            if (left <= 0 || (timeoutMs == ICEC_FOREVER && ic->stopping))
                break;
            icec_unlock(ic, ICE_LOCK_STATE);
            ic->endpoint->wake(ic->endpointContext);
            (void)ic->os->wait(ic->osContext, ICEC_SERVER_SLOT, left);
            icec_lock(ic, ICE_LOCK_STATE);
        }
        --ic->servers;
        if (ic->receiver >= 0)
            role = ICEC_ROLE_NONE;
        else
            ic->receiver = task;
        if (ic->stopping && ic->servers)
            ic->os->wake(ic->osContext, ICEC_SERVER_SLOT); /* the next one to leave */
    }
    icec_unlock(ic, ICE_LOCK_STATE);
    return role;
}

void icec_giveRole(Ice_CommunicatorPtr ic) {
    icec_lock(ic, ICE_LOCK_STATE);
    giveUp(ic);
    icec_unlock(ic, ICE_LOCK_STATE);
}

int icec_mayReceive(Ice_CommunicatorPtr ic, int* leads) {
    int task = ic->os->task(ic->osContext), may;
    icec_lock(ic, ICE_LOCK_STATE);
    if (*leads && ic->servers) {
        *leads = 0;
        giveUp(ic);
    } else if (ic->receiver < 0 && !ic->servers) {
        *leads = 1;
        ic->receiver = task;
    }
    may = ic->receiver == task;
    icec_unlock(ic, ICE_LOCK_STATE);
    return may;
}
