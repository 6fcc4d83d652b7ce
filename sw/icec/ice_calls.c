/* SPDX-License-Identifier: MIT
 *
 * ice_calls: the table of pending calls.
 */
#include "ice_private.h"

#include <string.h>

int icec_takeCall(Ice_CommunicatorPtr ic) {
    int task = ic->os->task(ic->osContext);
    int c, slot = -1;
    Ice_Call* call = ic->calls;
    icec_lock(ic, ICE_LOCK_STATE);
    for (c = 0; c < ICE_CALLS; ++c, ++call) {
        if (call->state == ICE_CALL_KEPT && call->task == task)
            call->state = ICE_CALL_FREE;
        if (call->state == ICE_CALL_FREE)
            slot = c;
    }
    if (slot >= 0) {
        call = &ic->calls[slot];
        call->state = ICE_CALL_BUILDING;
        call->task = task;
        call->callback = 0;
        call->unknown.size = 0;
    }
    icec_unlock(ic, ICE_LOCK_STATE);
    return slot;
}

void Ice_Communicator_endTask(Ice_CommunicatorPtr ic, int task) {
    Ice_Call* call;
    icec_lock(ic, ICE_LOCK_STATE);
    for (call = ic->calls; call < ic->calls + ICE_CALLS; ++call)
        if (call->state == ICE_CALL_KEPT && call->task == task)
            call->state = ICE_CALL_FREE;
    icec_unlock(ic, ICE_LOCK_STATE);
}

Ice_CallState icec_callState(Ice_CommunicatorPtr ic, int slot) {
    Ice_CallState state;
    icec_lock(ic, ICE_LOCK_STATE);
    state = ic->calls[slot].state;
    icec_unlock(ic, ICE_LOCK_STATE);
    return state;
}

void icec_wakeCalls(Ice_CommunicatorPtr ic) {
    int c;
    for (c = 0; c < ICE_CALLS; ++c)
        if (ic->calls[c].state > ICE_CALL_KEPT)
            ic->os->wake(ic->osContext, c);
}

/* Ends the call with this id if it still waits for its reply: wakes the waiting task, or calls the
 * callback. `is` is 0 without a reply. */
static void finish(Ice_CommunicatorPtr ic, Ice_Call* call, Ice_Int id, Ice_Status status,
                   Ice_InputStreamPtr is) {
    static const Ice_Byte nothing[1] = {0};
    Ice_InputStream none;
    Ice_Callback callback = 0;
    void* cookie = 0;
    Ice_InputStream_init(&none, nothing, 0);
    icec_lock(ic, ICE_LOCK_STATE);
    if (call->state == ICE_CALL_WAITING && call->id == id) {
        callback = call->callback;
        cookie = call->cookie;
        call->status = status;
        /* Frees the slot before the callback runs, because the callback may make the next
         * call. */
        call->state = callback ? ICE_CALL_FREE : ICE_CALL_DONE;
        if (!callback) {
            call->is.size = 0; /* empty: without a reply, no results exist */
            ic->os->wake(ic->osContext, (int)(call - ic->calls));
        }
    }
    icec_unlock(ic, ICE_LOCK_STATE);
    if (callback)
        callback(cookie, status, is ? is : &none);
}

void icec_loseConnection(Ice_CommunicatorPtr ic, int connection, Ice_Status status) {
    int c;
    icec_lock(ic, ICE_LOCK_STATE);
    ic->connections[connection].state = ICE_CONNECTION_NONE;
    icec_wakeCalls(ic); /* some tasks may wait until this connection is open */
    icec_unlock(ic, ICE_LOCK_STATE);
    for (c = 0; c < ICE_CALLS; ++c) {
        Ice_Call* call = &ic->calls[c];
        Ice_Int id;
        int isLost;
        icec_lock(ic, ICE_LOCK_STATE);
        isLost = call->state == ICE_CALL_WAITING && call->connection == connection;
        id = call->id;
        icec_unlock(ic, ICE_LOCK_STATE);
        if (isLost)
            finish(ic, call, id, status, 0);
    }
}

Ice_Call* icec_expiredCall(Ice_CommunicatorPtr ic, U32 now, Ice_Int* id, Ice_Int* waitMs) {
    Ice_Call *call, *expired = 0;
    for (call = ic->calls; call < ic->calls + ICE_CALLS; ++call) {
        Ice_Int left = call->timeoutMs - (Ice_Int)(now - call->begunMs);
        if (call->state != ICE_CALL_WAITING || !call->callback)
            continue;
        if (left <= 0) {
            expired = call;
            *id = call->id;
        } else if (left < *waitMs) {
            *waitMs = left;
        }
    }
    return expired;
}

void icec_expireCall(Ice_CommunicatorPtr ic, Ice_Call* call, Ice_Int id) {
    finish(ic, call, id, ICE_TIMEOUT, 0);
}

/* Reads a reply's status, and the reason of a failure. */
static Ice_Status readReply(Ice_Call* call, Ice_InputStreamPtr is) {
    Ice_Status status = icec_readReply(is);
    if (status == ICE_MARSHAL && is->failed)
        call->unknown = Ice_String_from(Ice_Failed_text(is->failed, is->bound));
    if (status > ICE_OPERATION_NOT_EXIST && status <= ICE_UNKNOWN_EXCEPTION)
        Ice_InputStream_takeString(is, &call->unknown);
    return status;
}

/* Copies the rest of the message to the waiting task's buffer; the call's stream then reads the
 * copy. */
static void keepReply(Ice_Call* call, Ice_InputStreamPtr is) {
    Ice_CommunicatorPtr ic = is->communicator;
    Ice_Int size = is->size - is->position;
    if (size > call->replySize) {
        is->failed = ICE_FAILED_REPLY;
        return;
    }
    memcpy(call->reply, is->data + is->position, (size_t)size);
    Ice_InputStream_init(is, (const Ice_Byte*)call->reply, size);
    /* size in words; rounded up to a multiple of 8 bytes, where the arena begins */
    size = (size + 7) / 8 * 2;
    is->arena = call->reply + size;
    is->arenaSize = call->replySize / 4 - size;
    is->communicator = ic;
}

/* Returns the call that waits for the reply with this id; 0 if no such call exists or it has
 * timed out. */
static Ice_Call* waitingCall(Ice_CommunicatorPtr ic, int connection, Ice_Int id) {
    Ice_Call* call;
    for (call = ic->calls; call < ic->calls + ICE_CALLS; ++call)
        if (call->state == ICE_CALL_WAITING && call->id == id && call->connection == connection)
            return call;
    return 0;
}

Ice_Status icec_takeReply(Ice_CommunicatorPtr ic, int connection, Ice_InputStreamPtr is) {
    Ice_Int id = Ice_InputStream_readInt(is);
    Ice_Call* call;
    int isAsynchronous = 0;
    if (is->failed)
        return ICE_CONNECTION_LOST;
    icec_lock(ic, ICE_LOCK_STATE); /* while this lock is held, the call cannot time out */
    call = waitingCall(ic, connection, id);
    if (call && call->callback) {
        isAsynchronous = 1;
    } else if (call) {
        keepReply(call, is);
        call->status = readReply(call, is);
        call->is = *is;
        call->state = ICE_CALL_DONE;
        ic->os->wake(ic->osContext, (int)(call - ic->calls));
    }
    icec_unlock(ic, ICE_LOCK_STATE);
    if (isAsynchronous) {
        icec_giveArena(ic, is);
        finish(ic, call, id, readReply(call, is), is);
    }
    return ICE_OK;
}
