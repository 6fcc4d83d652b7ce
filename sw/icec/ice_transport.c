/* SPDX-License-Identifier: MIT
 *
 * ice_transport: manages transports, locks, time and connections.
 */
#include "ice_private.h"

#include <string.h>

/* OF(ic, connection) returns the transport of a connection; OWN returns the connection's number
 * within this transport. */
#define OF(ic, connection) ((ic)->transports + (ICE_TRANSPORTS == 1 ? 0 : NUMBER(connection, /)))
#define OWN(connection) (ICE_TRANSPORTS == 1 ? (connection) : NUMBER(connection, %))
#define NUMBER(connection, part) ((connection)part ICE_CONNECTIONS)

void Ice_Communicator_setEndpoint(Ice_CommunicatorPtr ic, const Ice_Endpoint* endpoint,
                                  void* context) {
    Ice_Transport* t;
    if (ICE_TRANSPORTS > 1 && ic->transportCount < ICE_TRANSPORTS)
        ++ic->transportCount;
    t = &ic->transports[ICEC_TRANSPORTS(ic) - 1];
    t->endpoint = endpoint;
    t->context = context;
}

U32 icec_nowMs(Ice_CommunicatorPtr ic) {
    return ic->transports[0].endpoint->nowMs(ic->transports[0].context);
}

Ice_Status icec_send(Ice_CommunicatorPtr ic, int connection, Ice_OutputStreamPtr os) {
    const Ice_Transport* t = OF(ic, connection);
    return t->endpoint->send(t->context, OWN(connection), os->data, os->size);
}

void icec_wake(Ice_CommunicatorPtr ic) {
    int t;
    for (t = 0; t < ICEC_TRANSPORTS(ic); ++t)
        ic->transports[t].endpoint->wake(ic->transports[t].context);
}

const char* icec_optionsOf(Ice_CommunicatorPtr ic, const char* text, int* transport) {
    Ice_String name;
    int t;
    name.data = text;
    name.size = (Ice_Int)strcspn(text, ICEC_SPACES ":");
    for (t = 0; t < ICEC_TRANSPORTS(ic); ++t)
        if (Ice_String_is(&name, ic->transports[t].endpoint->name) ||
            Ice_String_is(&name, "default")) { /* "default" selects the first transport */
            *transport = t;
            return text + name.size;
        }
    return 0;
}

Ice_Status icec_addEndpoint(Ice_ObjectPrxPtr prx, int transport, const char* options) {
    const Ice_Transport* t = prx->communicator->transports + (ICE_TRANSPORTS == 1 ? 0 : transport);
    Ice_OutputStream os;
    Ice_OutputStream_init(&os, prx->endpoints, ICE_ENDPOINT_MAX);
    os.size = prx->endpoints[0] ? prx->endpointsSize : 1;
    t->endpoint->encode(t->context, options, &os);
    if (os.failed)
        return icec_parseFailure(&os);
    prx->endpointsSize = (Ice_Byte)os.size;
    ++prx->endpoints[0];
    return ICE_OK;
}

int icec_printEndpoint(Ice_CommunicatorPtr ic, const Ice_Byte* encoded, Ice_Int size,
                       Ice_OutputStreamPtr text) {
    int t;
    for (t = 0; t < ICEC_TRANSPORTS(ic); ++t) {
        const Ice_Endpoint* endpoint = ic->transports[t].endpoint;
        if (endpoint && endpoint->print &&
            endpoint->print(ic->transports[t].context, encoded, size, text))
            return 1;
    }
    return 0;
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
    const Ice_Transport* t = OF(ic, connection);
    icec_lock(ic, ICE_LOCK_STATE);
    t->endpoint->close(t->context, OWN(connection));
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
