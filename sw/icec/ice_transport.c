/* SPDX-License-Identifier: MIT
 *
 * ice_transport: locks, time, connections.
 */
#include "ice_private.h"

U32 icec_nowMs(Ice_CommunicatorPtr ic) {
    return ic->endpoint->nowMs(ic->endpointContext);
}

Ice_Status icec_send(Ice_CommunicatorPtr ic, int connection, Ice_OutputStreamPtr os) {
    return ic->endpoint->send(ic->endpointContext, connection, os->data, os->size);
}

Ice_Status icec_sendHead(Ice_CommunicatorPtr ic, int connection, Ice_Byte type) {
    Ice_Byte bytes[ICEC_HEADER];
    Ice_OutputStream os;
    Ice_Status status;
    Ice_OutputStream_init(&os, bytes, ICEC_HEADER);
    icec_beginMessage(&os, type);
    icec_lock(ic, ICE_LOCK_SEND);
    status = icec_send(ic, connection, &os);
    icec_unlock(ic, ICE_LOCK_SEND);
    return status;
}

void icec_openConnection(Ice_CommunicatorPtr ic, int connection, Ice_ConnectionState state) {
    Ice_Connection* c = &ic->connections[connection];
    c->state = state;
    c->pending = c->closing = 0;
    if (++c->generation == 0)
        c->generation = 1;
}

void icec_closeConnection(Ice_CommunicatorPtr ic, int connection) {
    icec_lock(ic, ICE_LOCK_STATE);
    ic->endpoint->close(ic->endpointContext, connection);
    icec_unlock(ic, ICE_LOCK_STATE);
}

Ice_ConnectionState icec_connectionState(Ice_CommunicatorPtr ic, int connection) {
    Ice_ConnectionState state;
    icec_lock(ic, ICE_LOCK_STATE);
    state = ic->connections[connection].state;
    icec_unlock(ic, ICE_LOCK_STATE);
    return state;
}

void icec_askToClose(Ice_CommunicatorPtr ic, int connection) {
    Ice_Connection* c = &ic->connections[connection];
    int asks;
    icec_lock(ic, ICE_LOCK_STATE);
    asks = c->state != ICE_CONNECTION_NONE && !c->pending && !c->closing;
    if (asks)
        c->closing = 1;
    icec_unlock(ic, ICE_LOCK_STATE);
    if (asks)
        (void)icec_sendHead(ic, connection, ICEC_CLOSE);
}

int icec_isStopping(Ice_CommunicatorPtr ic) {
    int is;
    icec_lock(ic, ICE_LOCK_STATE);
    is = ic->stopping;
    icec_unlock(ic, ICE_LOCK_STATE);
    return is;
}

int icec_countPending(Ice_CommunicatorPtr ic, int connection, U16 generation, int change) {
    Ice_Connection* c = &ic->connections[connection];
    int same;
    icec_lock(ic, ICE_LOCK_STATE);
    same = c->generation == generation && c->state == ICE_CONNECTION_OPEN;
    if (same)
        c->pending = (Ice_Byte)(c->pending + change);
    icec_unlock(ic, ICE_LOCK_STATE);
    return same;
}

void icec_giveArena(Ice_CommunicatorPtr ic, Ice_InputStreamPtr is) {
    is->arena = ic->arena;
    is->arenaSize = ICE_ARENA_BYTES / 4;
    is->arenaUsed = ic->decoding ? ic->decoding->arenaUsed : 0;
}
