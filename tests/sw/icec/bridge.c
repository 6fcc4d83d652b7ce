/* SPDX-License-Identifier: MIT
 *
 * bridge: IceC as server and as client between two stock programs (with server.c). Each request
 * passes through generated code to the server on the port given as argument. The program ends with
 * the operation `shutdown`.
 */
#include "serve.h"

#include <stdio.h>
#include <string.h>

#define CONTEXT 16
#define TIMEOUT_MS 60000

Ice_ObjectPrx Bridge_far;
static Ice_ObjectPrx server;

/* Copies a string and a terminating zero to `*room`, and advances `*room`. Returns the copy. */
static char* keep(char** room, Ice_String text) {
    char* kept = *room;
    memcpy(kept, text.data, (size_t)text.size);
    kept[text.size] = 0;
    *room += text.size + 1;
    return kept;
}

/* Makes the proxy with which a request continues on the other side. The proxy has the identity,
 * facet, encoding, mode and context of the request. */
static Ice_Status aim(const Ice_Current* current, Ice_ObjectPrxPtr far) {
    static Ice_ContextEntry context[CONTEXT + 1];
    static char texts[4096];
    static int client;
    Ice_CommunicatorPtr ic = current->communicator;
    Ice_String key, value;
    Ice_Identity id;
    char* room = texts;
    int n, connection;
    Ice_Status status = Ice_ObjectPrx_ice_getConnection(&server, &connection);
    if (current->connection == connection)
        /* calls of the server back to the client use the client's connection */
        connection = client;
    else
        client = current->connection;
    id.name = current->name;
    id.category = current->category;
    if (status == ICE_OK)
        status = Ice_Connection_createProxyTo(ic, connection, &id, far);
    if (status == ICE_OK)
        status = Ice_ObjectPrx_ice_facet(far, keep(&room, current->facet));
    Ice_ObjectPrx_ice_encodingVersion(far, current->minor);
    Ice_ObjectPrx_ice_invocationTimeout(far, TIMEOUT_MS);
    if (!current->requestId)
        Ice_ObjectPrx_ice_oneway(far);
    for (n = 0; n < CONTEXT && Ice_Current_contextAt(current, n, &key, &value); ++n) {
        context[n].key = keep(&room, key);
        context[n].value = keep(&room, value);
    }
    context[n].key = 0;
    Ice_ObjectPrx_ice_context(far, context);
    return status;
}

/* Passes on one of the operations that every object has, without decoding its parameters. */
static Ice_Status passWhole(Ice_ObjectPrxPtr far, const Ice_Current* current, Ice_InputStreamPtr is,
                            Ice_OutputStreamPtr os) {
    Ice_InputStreamPtr back;
    Ice_OutputStreamPtr call;
    Ice_Status status;
    char operation[32];
    sprintf(operation, "%.*s", (int)current->operation.size, current->operation.data);
    call = Ice_ObjectPrx_begin(far, operation, (Ice_Byte)(current->mode | ICE_RESULTS));
    if (!call)
        return (Ice_Status)far->status;
    Ice_OutputStream_writeBlob(call, is->data + is->position, is->size - is->position);
    status = Ice_ObjectPrx_invoke(far, &back);
    if (status == ICE_OK) {
        Ice_Int size = back->size - back->position;
        Ice_OutputStream_writeBlob(os, Ice_InputStream_readBlob(back, size), size);
    }
    return Ice_ObjectPrx_end(far, status);
}

/* Returns the servant for the type of the object. Returns null and sets `status` if no servant
 * fits. */
static Ice_ObjectPtr servantOf(const Ice_ObjectPrx* far, Ice_Status* status) {
    Ice_ObjectPrx asked = *far;
    Ice_ObjectPtr servant = 0;
    Ice_String id;
    int n;
    Ice_ObjectPrx_ice_twoway(&asked);
    Ice_ObjectPrx_ice_context(&asked, 0);
    *status = Ice_ObjectPrx_ice_id(&asked, &id);
    if (*status == ICE_OK)
        for (n = 0; (servant = Bridge_servant(n)) != 0 && !Ice_String_equals(id, servant->id);
             ++n) {
        }
    if (*status == ICE_OK && !servant)
        *status = ICE_OPERATION_NOT_EXIST;
    return servant;
}

static Ice_Status pass(Ice_ObjectPtr self, const Ice_Current* current, Ice_InputStreamPtr is,
                       Ice_OutputStreamPtr os) {
    Ice_ObjectPrx far;
    Ice_ObjectPtr servant;
    Ice_Status status = aim(current, &far);
    (void)self;
    if (status != ICE_OK)
        return status;
    if (current->operation.size > 4 && memcmp(current->operation.data, "ice_", 4) == 0)
        return passWhole(&far, current, is, os);
    servant = servantOf(&far, &status);
    if (!servant)
        return status;
    /* requests that arrived during the call above may have changed this proxy */
    status = aim(current, &Bridge_far);
    if (status == ICE_OK)
        status = servant->dispatch(servant, current, is, os);
    if (status == ICE_CONNECTION_LOST)
        status = ICE_UNKNOWN_LOCAL_EXCEPTION;
    if (status == ICE_OK && Ice_String_equals(current->operation, "shutdown"))
        Ice_Communicator_shutdown(current->communicator);
    return status;
}

Ice_Status Suite_serve(Ice_ObjectAdapterPtr adapter) {
    static Ice_Object passer = {pass, 0, 0};
    char text[64];
    sprintf(text, "server:tcp -h 127.0.0.1 -p %.8s", suite_argument);
    if (Ice_Communicator_stringToProxy(adapter->communicator, text, &server) != ICE_OK)
        return ICE_PARSE;
    return Ice_ObjectAdapter_addDefaultServant(adapter, &passer, "");
}
