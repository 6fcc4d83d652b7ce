/* SPDX-License-Identifier: MIT
 *
 * ice_loop: waits for events of the connections, and handles them.
 */
#include "ice_private.h"

/* Marks a connection as open for calls. This is done after the first message of the peer. */
static void validate(Ice_CommunicatorPtr ic, int connection) {
    icec_lock(ic, ICE_LOCK_STATE);
    ic->connections[connection].state = ICE_CONNECTION_OPEN;
    icec_wakeCalls(ic);
    icec_unlock(ic, ICE_LOCK_STATE);
}

/* Handles a message. Returns ICE_OK, or the reason why the connection must be closed. A malformed
 * message ends its connection. */
static Ice_Status takeMessage(Ice_CommunicatorPtr ic, int connection, const Ice_Byte* in,
                              Ice_Int size) {
    Ice_InputStream is;
    Ice_Int type;
    Ice_InputStream_init(&is, in, size);
    is.communicator = ic;
    type = icec_readHead(&is);
    switch (type) {
    case ICEC_REQUEST:
        return icec_dispatchRequest(ic, connection, &is);
    case ICEC_BATCH:
        return icec_dispatchBatch(ic, connection, &is);
    case ICEC_REPLY:
        return icec_takeReply(ic, connection, &is);
    case ICEC_VALIDATE:
        validate(ic, connection);
        return ICE_OK;
    case ICEC_CLOSE:
        return ICE_CONNECTION_CLOSED;
    default:
        /* A compressed request cannot be answered. CLOSE informs the caller that the request was
         * not executed. */
        if (type > 0xFF)
            (void)icec_sendHead(ic, connection, ICEC_CLOSE);
        return ICE_CONNECTION_LOST;
    }
}

static Ice_Status takeEvent(Ice_CommunicatorPtr ic, const Ice_Byte* in, const Ice_Event* event) {
    int connection = event->connection;
    Ice_Status end = ICE_CONNECTION_LOST;
    if (event->kind == ICE_EVENT_NONE)
        return ICE_TIMEOUT;
    /* the side that has accepted the connection sends the first message */
    if (event->kind == ICE_EVENT_OPENED) {
        int isRefused;
        icec_lock(ic, ICE_LOCK_STATE);
        isRefused = ic->stopping;
        if (!isRefused)
            icec_openConnection(ic, connection, ICE_CONNECTION_OPEN);
        icec_unlock(ic, ICE_LOCK_STATE);
        if (isRefused)
            icec_closeConnection(ic, connection);
        else
            (void)icec_sendHead(ic, connection, ICEC_VALIDATE);
        return ICE_OK;
    }
    if (event->kind == ICE_EVENT_MESSAGE) {
        end = takeMessage(ic, connection, in, event->size);
        if (end == ICE_OK)
            return ICE_OK;
        icec_closeConnection(ic, connection);
    }
    icec_loseConnection(ic, connection, end);
    return ICE_OK;
}

/* Finds a connection on which a heartbeat is due because its caller waits for an operation, and
 * records that the heartbeat is sent. Returns -1 if no such connection exists. Reduces `waitMs`
 * to the time until the next heartbeat. The caller holds the state lock. */
static int heartbeatDue(Ice_CommunicatorPtr ic, U32 now, Ice_Int* waitMs) {
    int c, due = -1;
    for (c = 0; c < ICE_TRANSPORTS * ICE_CONNECTIONS && due < 0; ++c) {
        Ice_Connection* connection = &ic->connections[c];
        Ice_Int left;
        if (!connection->pending || connection->state != ICE_CONNECTION_OPEN)
            continue;
        left = ICE_HEARTBEAT_MS - (Ice_Int)(now - connection->signMs);
        if (left <= 0) {
            due = c;
            connection->signMs = now;
        } else if (left < *waitMs) {
            *waitMs = left;
        }
    }
    return due;
}

/* Sends the heartbeats that are due, and ends asynchronous calls that have timed out. Reduces
 * `waitMs` to the time until the next heartbeat or time-out. Returns whether shutdown was
 * called. */
static int keepTimes(Ice_CommunicatorPtr ic, Ice_Int* waitMs) {
    for (;;) {
        U32 now = icec_nowMs(ic);
        Ice_Int id = 0;
        Ice_Call* call;
        int due, isStopping;
        icec_lock(ic, ICE_LOCK_STATE);
        due = heartbeatDue(ic, now, waitMs);
        call = icec_expiredCall(ic, now, &id, waitMs);
        isStopping = ic->stopping;
        icec_unlock(ic, ICE_LOCK_STATE);
        if (due >= 0)
            (void)icec_sendHead(ic, due, ICEC_VALIDATE);
        if (call)
            icec_expireCall(ic, call, id);
        if (due < 0 && !call)
            return isStopping;
    }
}

/* Number of successive events of one transport, after which the next transport has its turn. */
#define TURN_EVENTS 32

/* Receives from the transport that is served now. If nothing arrives, the next transport has its
 * turn. */
static Ice_Status receive(Ice_CommunicatorPtr ic, Ice_Byte* in, Ice_Int timeoutMs,
                          Ice_Event* event) {
    const Ice_Transport* t = ic->transports + (ICE_TRANSPORTS == 1 ? 0 : ic->turn);
    Ice_Status status;
    if (ICEC_TRANSPORTS(ic) > 1 && timeoutMs > ICE_TURN_MS)
        timeoutMs = ICE_TURN_MS;
    status = t->endpoint->receive(t->context, in, timeoutMs, event);
    if (ICEC_TRANSPORTS(ic) > 1) {
        event->connection += ic->turn * ICE_CONNECTIONS;
        if (event->kind == ICE_EVENT_NONE || ++ic->turnUsed == TURN_EVENTS) {
            ic->turn = (Ice_Byte)((ic->turn + 1) % ic->transportCount);
            ic->turnUsed = 0;
        }
    }
    return status;
}

#define SERVE (-1) /* value for timeoutMs: no time-out; waiting ends when shutdown is called */
#define POLL_MS 1000

/* Handles at most one event of the transport that is served now. The calling task acts as the
 * receiver. Returns ICE_TIMEOUT if no event arrived, ICE_LIMIT if ICE_NESTING is reached, and, with
 * SERVE, ICE_CONNECTION_CLOSED after shutdown was called. */
static Ice_Status receiveOne(Ice_CommunicatorPtr ic, Ice_Int timeoutMs) {
    Ice_Event event;
    Ice_Status status;
    Ice_Byte* in;
    Ice_Int waitMs = timeoutMs < 0 ? POLL_MS : timeoutMs;
    if (keepTimes(ic, &waitMs) && timeoutMs < 0)
        return ICE_CONNECTION_CLOSED;
    if (ic->depth == ICE_NESTING)
        return ICE_LIMIT;
    in = ic->in[ic->depth];
    event.kind = ICE_EVENT_NONE;
    ++ic->depth;
    status = receive(ic, in, waitMs, &event);
    if (status == ICE_OK)
        status = takeEvent(ic, in, &event);
    --ic->depth;
    return status;
}

/* ---- the receiver ---- One of several tasks has the role of the receiver. A server (a task in
 * waitForShutdown or poll) takes the role as soon as it is free. Without a server, a task that
 * waits for a reply (a leader) has the role while it waits. `receiver` and `servers` are only
 * changed by a task that holds the state lock. A task that gives the role up wakes another task
 * that may want it.
 */

typedef enum Role {
    ROLE_NONE,  /* another task has the role */
    ROLE_TAKEN, /* this task has taken the role, and must return it with giveRole */
    /* this task already had the role, because it makes this call while it executes an operation */
    ROLE_HAD
} Role;
/* value for timeoutMs: no time-out; waiting ends when the role is free or shutdown is called */
#define FOREVER 0x7FFFFFFF

/* Gives up the role of the receiver, and wakes a task that may want the role. The caller holds the
 * state lock. */
static void giveUp(Ice_CommunicatorPtr ic) {
    ic->receiver = -1;
    if (ic->servers)
        ic->os->wake(ic->osContext, ICEC_SERVER_SLOT);
    else
        icec_wakeCalls(ic);
}

/* Takes the role of the receiver for a server. Waits up to timeoutMs until the role is free. */
static Role takeRole(Ice_CommunicatorPtr ic, Ice_Int timeoutMs) {
    int task = ic->os->task(ic->osContext);
    U32 begin = icec_nowMs(ic);
    Role role = ROLE_TAKEN;
    icec_lock(ic, ICE_LOCK_STATE);
    if (ic->receiver == task) {
        role = ROLE_HAD;
    } else {
        ++ic->servers; /* makes a leader give the role up */
        while (ic->receiver >= 0) {
            Ice_Int left = FOREVER;
            if (timeoutMs != FOREVER)
                left = timeoutMs - (Ice_Int)(icec_nowMs(ic) - begin);
            if (left <= 0 || (timeoutMs == FOREVER && ic->stopping))
                break;
            icec_unlock(ic, ICE_LOCK_STATE);
            icec_wake(ic);
            (void)ic->os->wait(ic->osContext, ICEC_SERVER_SLOT, left);
            icec_lock(ic, ICE_LOCK_STATE);
        }
        --ic->servers;
        if (ic->receiver >= 0)
            role = ROLE_NONE;
        else
            ic->receiver = task;
        if (ic->stopping && ic->servers)
            /* shutdown was called: wakes the next server, which must also return */
            ic->os->wake(ic->osContext, ICEC_SERVER_SLOT);
    }
    icec_unlock(ic, ICE_LOCK_STATE);
    return role;
}

static void giveRole(Ice_CommunicatorPtr ic) {
    icec_lock(ic, ICE_LOCK_STATE);
    giveUp(ic);
    icec_unlock(ic, ICE_LOCK_STATE);
}

/* Returns whether this task, which waits for a reply, must receive now. The task becomes the leader
 * and sets `leads` if no task has the role and no server wants it. A leader gives the role up as
 * soon as a server wants it. */
static int mayReceive(Ice_CommunicatorPtr ic, int* leads) {
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

void Ice_Communicator_waitForShutdown(Ice_CommunicatorPtr ic) {
    Role role = takeRole(ic, FOREVER);
    while (role != ROLE_NONE && receiveOne(ic, SERVE) != ICE_CONNECTION_CLOSED) {
    }
    if (role == ROLE_TAKEN)
        giveRole(ic); /* wakes another server, or a task that waits for a reply */
}

Ice_Status Ice_Communicator_poll(Ice_CommunicatorPtr ic, Ice_Int timeoutMs) {
    Ice_Status status = ICE_TIMEOUT;
    U32 begin = icec_nowMs(ic);
    Role role = takeRole(ic, timeoutMs);
    if (role != ROLE_NONE) {
        int turns = ICEC_TRANSPORTS(ic);
        Ice_Int left;
        do {
            left = timeoutMs - (Ice_Int)(icec_nowMs(ic) - begin);
            status = receiveOne(ic, left > 0 ? left : 0);
        } while (ICE_TRANSPORTS > 1 && status == ICE_TIMEOUT &&
                 (--turns > 0 || (left > 0 && !icec_isStopping(ic))));
    }
    if (role == ROLE_TAKEN)
        giveRole(ic);
    return status;
}

Ice_Status icec_await(Ice_CommunicatorPtr ic, int (*waits)(Ice_CommunicatorPtr ic, int which),
                      int which, int slot, Ice_Int timeoutMs) {
    U32 begin = icec_nowMs(ic);
    Ice_Status status = ICE_OK;
    int leads = 0;
    while (waits(ic, which)) {
        Ice_Int left = timeoutMs - (Ice_Int)(icec_nowMs(ic) - begin);
        status = ICE_TIMEOUT;
        if (left <= 0)
            break;
        if (!mayReceive(ic, &leads))
            (void)ic->os->wait(ic->osContext, slot, left);
        else
            status = receiveOne(ic, left);
        if (status != ICE_OK && status != ICE_TIMEOUT)
            break;
        status = ICE_OK;
    }
    if (leads)
        giveRole(ic); /* wakes a server, or another task that waits for a reply */
    return status;
}
