/* SPDX-License-Identifier: MIT
 *
 * ice_minimal: the minimal run time: one task, one active adapter, one message at a time.
 *
 * `in` holds received messages, `out` holds messages to send. The connection and the current call
 * each have an Ice_Status, which is ICE_LATER while a message of the peer is expected. The
 * functions are declared in icec.h. Streams, proxies and tables of operations are the same as in
 * the full run time.
 */
#include "ice_message.h"

#include <stdlib.h>
#include <string.h>

static U32 nowMs(Ice_CommunicatorPtr ic) {
    return ic->endpoint->nowMs(ic->endpointContext);
}

static Ice_Status send(Ice_CommunicatorPtr ic, int connection) {
    Ice_OutputStreamPtr os = &ic->os;
    icec_endMessage(os);
    return ic->endpoint->send(ic->endpointContext, connection, os->data, os->size);
}

static Ice_ObjectPtr find(const Ice_Current* current) {
    Ice_ObjectAdapterPtr adapter = current->adapter;
    int s;
    if (adapter && current->category.size + current->facet.size == 0)
        for (s = 0; s < ICE_SERVANTS; ++s)
            if (adapter->servants[s].servant &&
                Ice_String_is(&current->name, adapter->servants[s].name))
                return adapter->servants[s].servant;
    return 0;
}

static Ice_Status run(const Ice_Current* current, Ice_InputStreamPtr is, Ice_OutputStreamPtr os) {
    Ice_ObjectPtr servant = find(current);
    const char* const* id;
    Ice_String wanted;
    if (!servant)
        return ICE_OBJECT_NOT_EXIST;
    if (Ice_String_is(&current->operation, "ice_isA")) {
        Ice_InputStream_takeString(is, &wanted);
        for (id = servant->ids; *id && !Ice_String_is(&wanted, *id);)
            ++id;
        Ice_OutputStream_writeByte(os, *id != 0);
    } else if (!Ice_String_is(&current->operation, "ice_ping")) {
        return servant->dispatch(servant, current, is, os);
    }
    return ICE_OK;
}

static Ice_Status dispatch(Ice_CommunicatorPtr ic, int connection, Ice_InputStreamPtr is) {
    Ice_OutputStreamPtr os = &ic->os;
    Ice_Int id = Ice_InputStream_readInt(is);
    Ice_Status status;
    Ice_Current current;
    Icec_Target target;
    current.communicator = ic;
    current.adapter = ic->adapter;
    current.connection = connection;
    target.size = is->position;
    target.data = is->data + target.size;
    Ice_InputStream_takeString(is, &current.name);
    Ice_InputStream_takeString(is, &current.category);
    /* number of strings of the facet; requests with a facet are not supported */
    current.facet.size = Ice_InputStream_readByte(is);
    icec_skipStrings(is, (U32)current.facet.size);
    Ice_InputStream_takeString(is, &current.operation);
    target.size = is->position - target.size;
    current.mode = Ice_InputStream_readByte(is);
    icec_skipStrings(is, 2U * (U32)Ice_InputStream_readSize(is)); /* the context */
    status = icec_enterEncapsulation(is);
    if (status == ICE_MARSHAL)
        return ICE_CONNECTION_LOST;
    icec_beginMessage(os, ICEC_REPLY);
    os->minor = is->minor & 1U;
    icec_beginReply(os, id);
    if (status == ICE_OK) {
        ic->busy = 1;
        status = run(&current, is, os);
        ic->busy = 0;
        if (is->failed | os->failed)
            status = ICE_MARSHAL;
    }
    if (id != 0) {
        icec_endReply(os, status, &target);
        (void)send(ic, connection);
    }
    return ICE_OK;
}

/* Handles a message. Returns ICE_OK, or the reason why the connection must be closed. A malformed
 * message ends its connection. */
static Ice_Status takeMessage(Ice_CommunicatorPtr ic, int connection, Ice_Int size) {
    Ice_InputStreamPtr is = &ic->is;
    Ice_InputStream_init(is, ic->in, size);
    is->communicator = ic;
    is->arena = ic->arena;
    is->arenaSize = ICE_ARENA_BYTES / 4;
    switch (icec_readHead(is)) {
    case ICEC_REQUEST:
        return dispatch(ic, connection, is);
    case ICEC_REPLY:
        if (Ice_InputStream_readInt(is) == ic->id && connection == ic->connection)
            ic->call = (Ice_Byte)icec_readReply(is); /* a reply to an earlier call is ignored */
        return ICE_OK;
    case ICEC_VALIDATE:
        ic->connections[connection] = ICE_OK;
        return ICE_OK;
    case ICEC_CLOSE:
        return ICE_CONNECTION_CLOSED;
    default:
        return ICE_CONNECTION_LOST;
    }
}

Ice_Status Ice_Communicator_poll(Ice_CommunicatorPtr ic, Ice_Int timeoutMs) {
    Ice_Event event;
    Ice_Status end = ICE_CONNECTION_LOST;
    event.kind = ICE_EVENT_NONE;
    (void)ic->endpoint->receive(ic->endpointContext, ic->in, timeoutMs, &event);
    if (event.kind == ICE_EVENT_NONE)
        return ICE_TIMEOUT;
    /* the side that has accepted the connection sends the first message */
    if (event.kind == ICE_EVENT_OPENED) {
        ic->connections[event.connection] = ICE_OK;
        icec_beginMessage(&ic->os, ICEC_VALIDATE);
        (void)send(ic, event.connection);
        return ICE_OK;
    }
    if (event.kind == ICE_EVENT_MESSAGE) {
        end = takeMessage(ic, event.connection, event.size);
        if (end == ICE_OK)
            return ICE_OK;
        ic->endpoint->close(ic->endpointContext, event.connection);
    }
    ic->connections[event.connection] = (Ice_Byte)end;
    if (event.connection == ic->connection)
        ic->call = (Ice_Byte)end;
    return ICE_OK;
}

/* Receives messages until `status` is no longer ICE_LATER. */
static Ice_Status await(Ice_ObjectPrxPtr self, const volatile Ice_Byte* status) {
    U32 begun = nowMs(self->communicator);
    while (*status == ICE_LATER) {
        Ice_Int left = self->timeoutMs - (Ice_Int)(nowMs(self->communicator) - begun);
        if (left <= 0)
            return ICE_TIMEOUT;
        (void)Ice_Communicator_poll(self->communicator, left);
    }
    return (Ice_Status)*status;
}

static Ice_Status connect(Ice_ObjectPrxPtr self) {
    Ice_CommunicatorPtr ic = self->communicator;
    Ice_Byte* connection;
    Ice_Status status = ic->endpoint->connect(ic->endpointContext, self->endpoints + 1,
                                              self->endpointsSize - 1, &self->connection);
    if (status != ICE_OK)
        return status;
    connection = ic->connections + self->connection;
    if (*connection != ICE_OK)
        /* the connection is open when the first message of the peer has arrived */
        *connection = ICE_LATER;
    return await(self, connection);
}

Ice_OutputStreamPtr Ice_ObjectPrx_begin(Ice_ObjectPrxPtr self, const char* operation,
                                        Ice_Byte mode) {
    Ice_CommunicatorPtr ic = self->communicator;
    Ice_OutputStreamPtr os = &ic->os;
    self->status = ICE_LIMIT;
    if (ic->busy)
        return 0;
    self->status = ICE_TWOWAY_ONLY;
    if (self->mode != ICE_TWOWAY && mode & ICE_RESULTS)
        return 0;
    self->status = (Ice_Byte)connect(self);
    icec_beginMessage(os, ICEC_REQUEST);
    os->minor = self->minor;
    ic->id += 2;
    Ice_OutputStream_writeInt(os, self->mode == ICE_TWOWAY ? ic->id : 0);
    Ice_OutputStream_writeBlob(os, self->identity, self->identitySize);
    Ice_OutputStream_writeText(os, operation);
    Ice_OutputStream_writeShort(os, mode & ~ICE_RESULTS); /* the mode, and an empty context */
    ic->body = icec_beginEncapsulation(os);
    return os;
}

Ice_Status Ice_ObjectPrx_invoke(Ice_ObjectPrxPtr self, Ice_InputStreamPtr* is) {
    Ice_CommunicatorPtr ic = self->communicator;
    Ice_Status status = (Ice_Status)self->status;
    *is = &ic->is;
    /* clears the failure of an earlier call: the caller checks this stream even after a oneway
     * call, which reads nothing */
    ic->is.failed = 0;
    if (ic->os.failed)
        status = ICE_MARSHAL;
    if (status != ICE_OK)
        return status;
    icec_endEncapsulation(&ic->os, ic->body);
    ic->connection = self->connection;
    ic->call = ICE_LATER;
    status = send(ic, self->connection);
    return status != ICE_OK || self->mode != ICE_TWOWAY ? status : await(self, &ic->call);
}

Ice_Status Ice_ObjectPrx_end(Ice_ObjectPrxPtr self, Ice_Status status) {
    return status <= ICE_USER_EXCEPTION && self->communicator->is.failed ? ICE_MARSHAL : status;
}

U32 Ice_numberOption(const char* options, char letter, U32 otherwise) {
    for (; options && *options; ++options)
        if (options[0] == '-' && options[1] == letter) { /* quoted values are not supported here */
            options += 3;
            return (U32)strtoul(options, 0, options[0] == '0' && options[1] == 'x' ? 16 : 10);
        }
    return otherwise;
}

/* Returns the options that follow the transport name; 0 if the text names another transport. */
static const char* optionsOf(Ice_CommunicatorPtr ic, const char* text) {
    size_t size = strlen(ic->endpoint->name);
    return strncmp(text, ic->endpoint->name, size) == 0 && text[size] <= ' ' ? text + size : 0;
}

/* Parses "name [-t|-o]:transport options"; without a transport, the proxy refers to an object of
 * this program. */
static Ice_Status parse(Ice_CommunicatorPtr ic, const char* text, Ice_ObjectPrxPtr prx) {
    size_t size = strcspn(text, " :");
    const char* options = strchr(text, ':');
    Ice_OutputStream os;
    icec_initProxy(prx, ic);
    if (size - 1U > ICE_IDENTITY_MAX - 4U)
        return ICE_LIMIT;
    prx->identity[0] = (Ice_Byte)size;
    memcpy(prx->identity + 1, text, size); /* two zeros follow the name: no category and no facet */
    prx->identitySize = (Ice_Byte)(size + 3U);
    prx->mode = strncmp(text + size, " -o", 3) == 0; /* ICE_ONEWAY */
    if (options) {
        options = optionsOf(ic, options + 1);
        if (!options)
            return ICE_NO_ENDPOINT;
    }
    Ice_OutputStream_init(&os, prx->endpoints, ICE_ENDPOINT_MAX);
    Ice_OutputStream_writeByte(&os, 1);
    ic->endpoint->encode(ic->endpointContext, options, &os);
    prx->endpointsSize = (Ice_Byte)os.size;
    return os.failed ? ICE_LIMIT : ICE_OK;
}

Ice_Status Ice_Communicator_stringToProxy(Ice_CommunicatorPtr ic, const char* proxy,
                                          Ice_ObjectPrxPtr prx) {
    return strchr(proxy, ':') ? parse(ic, proxy, prx) : ICE_NO_ENDPOINT;
}

Ice_Status Ice_ObjectAdapter_createProxy(Ice_ObjectAdapterPtr adapter, const char* identity,
                                         Ice_ObjectPrxPtr prx) {
    return parse(adapter->communicator, identity, prx);
}

Ice_Status Ice_Communicator_createObjectAdapterWithEndpoints(Ice_CommunicatorPtr ic,
                                                             const char* name,
                                                             const char* endpoints,
                                                             Ice_ObjectAdapterPtr adapter) {
    const char* options = optionsOf(ic, endpoints);
    (void)name;
    memset(adapter, 0, sizeof *adapter);
    adapter->communicator = ic;
    return options ? ic->endpoint->listen(ic->endpointContext, options) : ICE_NO_ENDPOINT;
}

Ice_Status Ice_ObjectAdapter_add(Ice_ObjectAdapterPtr adapter, Ice_ObjectPtr servant,
                                 const char* identity) {
    int s;
    for (s = 0; s < ICE_SERVANTS; ++s)
        if (!adapter->servants[s].servant) {
            adapter->servants[s].servant = servant;
            adapter->servants[s].name = identity;
            return ICE_OK;
        }
    return ICE_LIMIT;
}

void Ice_ObjectAdapter_activate(Ice_ObjectAdapterPtr adapter) {
    adapter->communicator->adapter = adapter;
}

void Ice_ObjectAdapter_deactivate(Ice_ObjectAdapterPtr adapter) {
    adapter->communicator->adapter = 0;
}

void Ice_initialize(Ice_CommunicatorPtr ic) {
    memset(ic, 0, sizeof *ic);
    memset(ic->connections, ICE_CONNECTION_LOST, sizeof ic->connections);
    Ice_OutputStream_init(&ic->os, ic->out, ICE_RESULT_MAX);
    ic->id = 1;
}

void Ice_Communicator_setEndpoint(Ice_CommunicatorPtr ic, const Ice_Endpoint* endpoint,
                                  void* context) {
    ic->endpoint = endpoint;
    ic->endpointContext = context;
}

void Ice_Communicator_shutdown(Ice_CommunicatorPtr ic) {
    ic->stopping = 1;
    ic->endpoint->wake(ic->endpointContext);
}

void Ice_Communicator_waitForShutdown(Ice_CommunicatorPtr ic) {
    while (!ic->stopping)
        (void)Ice_Communicator_poll(ic, 1000);
}
