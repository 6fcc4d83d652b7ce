/* SPDX-License-Identifier: MIT
 *
 * ice_receiver: which one of several tasks receives.
 *
 * One task at a time holds the role: a server (waitForShutdown, poll) as soon as it can have it,
 * else a task that waits for a reply (a leader), for as long as it waits. `receiver` and `servers`
 * change under the state lock only; who gives the role up wakes who may want it.
 */
#include "ice_private.h"

/* Under the state lock. */
static void giveUp(Ice_CommunicatorPtr ic) {
    ic->receiver = -1;
    if (ic->servers)
        ic->os->wake(ic->osContext, ICE_SERVER_SLOT);
    else
        Ice_wakeCalls(ic);
}

Ice_Role Ice_takeRole(Ice_CommunicatorPtr ic, Ice_Int timeoutMs) {
    int task = ic->os->task(ic->osContext);
    U32 begin = Ice_nowMs(ic);
    Ice_Role role = ICE_ROLE_TAKEN;
    Ice_lock(ic, ICE_LOCK_STATE);
    if (ic->receiver == task) {
        role = ICE_ROLE_HAD;
    } else {
        ++ic->servers; /* a leader that sees this gives the role up */
        while (ic->receiver >= 0) {
            Ice_Int left = ICE_FOREVER;
            if (timeoutMs != ICE_FOREVER)
                left = timeoutMs - (Ice_Int)(Ice_nowMs(ic) - begin);
            if (left <= 0 || (timeoutMs == ICE_FOREVER && ic->stopping))
                break;
            Ice_unlock(ic, ICE_LOCK_STATE);
            ic->endpoint->wake(ic->endpointContext);
            (void)ic->os->wait(ic->osContext, ICE_SERVER_SLOT, left);
            Ice_lock(ic, ICE_LOCK_STATE);
        }
        --ic->servers;
        if (ic->receiver >= 0)
            role = ICE_ROLE_NONE;
        else
            ic->receiver = task;
        if (ic->stopping && ic->servers)
            ic->os->wake(ic->osContext, ICE_SERVER_SLOT); /* the next one that is to leave */
    }
    Ice_unlock(ic, ICE_LOCK_STATE);
    return role;
}

void Ice_giveRole(Ice_CommunicatorPtr ic) {
    Ice_lock(ic, ICE_LOCK_STATE);
    giveUp(ic);
    Ice_unlock(ic, ICE_LOCK_STATE);
}

int Ice_mayReceive(Ice_CommunicatorPtr ic, int* leads) {
    int task = ic->os->task(ic->osContext), may;
    Ice_lock(ic, ICE_LOCK_STATE);
    if (*leads && ic->servers) {
        *leads = 0;
        giveUp(ic);
    } else if (ic->receiver < 0 && !ic->servers) {
        *leads = 1;
        ic->receiver = task;
    }
    may = ic->receiver == task;
    Ice_unlock(ic, ICE_LOCK_STATE);
    return may;
}
