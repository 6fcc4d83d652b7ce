/* SPDX-License-Identifier: MIT
 *
 * ice_minimal: the run time of the minimal configuration: one task, one active adapter, one message
 * at a time.
 *
 * What is received lies in `in`, what is sent is written to `out`; a connection and the call under
 * way have an Ice_Status, ICE_LATER as long as the peer's answer is waited for. The functions are
 * those of icec.h; the streams, proxies and tables of operations are the full run time's.
 */
#include "ice_private.h"

#include <string.h>

static U32 nowMs(Ice_CommunicatorPtr ic) {
    return ic->endpoint->nowMs(ic->endpointContext);
}

static Ice_OutputStreamPtr begin(Ice_CommunicatorPtr ic, Ice_Byte type) {
    Ice_OutputStreamPtr os = &ic->os;
    Ice_OutputStream_init(os, ic->out, ICE_MESSAGE_MAX);
    Ice_beginMessage(os, type);
    return os;
}

static Ice_Status send(Ice_CommunicatorPtr ic, int connection) {
    Ice_OutputStreamPtr os = &ic->os;
    Ice_endMessage(os);
    return ic->endpoint->send(ic->endpointContext, connection, os->data, os->size);
}

/* ---- requests that come in ---- */

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
    Ice_OutputStreamPtr os = begin(ic, ICE_REPLY);
    Ice_Int who, whoSize, id = Ice_InputStream_readInt(is);
    Ice_Status status;
    Ice_Current current;
    current.communicator = ic;
    current.adapter = ic->adapter;
    current.connection = connection;
    who = is->position;
    Ice_InputStream_takeString(is, &current.name);
    Ice_InputStream_takeString(is, &current.category);
    current.facet.size = Ice_InputStream_readByte(is); /* how many: one is too many */
    Ice_skipStrings(is, (U32)current.facet.size);
    Ice_InputStream_takeString(is, &current.operation);
    whoSize = is->position - who;
    current.mode = Ice_InputStream_readByte(is);
    Ice_skipStrings(is, 2U * (U32)Ice_InputStream_readSize(is)); /* the context */
    status = Ice_enterEncapsulation(is);
    if (status == ICE_MARSHAL)
        return ICE_CONNECTION_LOST;
    Ice_OutputStream_writeInt(os, id);
    os->minor = is->minor & 1U;
    os->size = ICE_REPLY_BODY;
    (void)Ice_beginEncapsulation(os);
    if (status == ICE_OK) {
        ic->busy = 1;
        status = run(&current, is, os);
        ic->busy = 0;
        if (is->failed | os->failed)
            status = ICE_MARSHAL;
    }
    if (id == 0)
        return ICE_OK;
    if (status > ICE_UNKNOWN_EXCEPTION)
        status = status <= ICE_PROTOCOL ? ICE_UNKNOWN_LOCAL_EXCEPTION : ICE_UNKNOWN_EXCEPTION;
    os->data[ICE_REPLY_BODY - 1] = (Ice_Byte)status;
    if (status <= ICE_USER_EXCEPTION) {
        Ice_endEncapsulation(os, ICE_REPLY_BODY);
    } else {
        os->failed = 0;
        os->size = ICE_REPLY_BODY;
        if (status <= ICE_OPERATION_NOT_EXIST)
            Ice_OutputStream_writeBlob(os, is->data + who, whoSize);
        else
            Ice_OutputStream_writeByte(os, 0); /* the reason, in no words */
    }
    (void)send(ic, connection);
    return ICE_OK;
}

/* ---- what arrives ---- */

/* From a reply's status byte on. */
static Ice_Status readReply(Ice_InputStreamPtr is) {
    Ice_Status code = (Ice_Status)Ice_InputStream_readByte(is), entered;
    if (code > ICE_UNKNOWN_EXCEPTION)
        return ICE_MARSHAL;
    if (code <= ICE_USER_EXCEPTION) {
        entered = Ice_enterEncapsulation(is);
        if (entered != ICE_OK)
            return entered;
    }
    return code;
}

/* ICE_OK, or why the connection is to be closed; what is malformed loses it. */
static Ice_Status takeMessage(Ice_CommunicatorPtr ic, int connection, Ice_Int size) {
    Ice_InputStreamPtr is = &ic->is;
    Ice_Int type;
    Ice_InputStream_init(is, ic->in, size);
    is->communicator = ic;
    is->arena = ic->arena;
    is->arenaSize = ICE_ARENA_BYTES / 4;
    is->position = ICE_TYPE_AT;
    type = Ice_InputStream_readShort(is) & 0xFEFF; /* and compression: 0 or 1 is none */
    if (Ice_InputStream_readInt(is) != size || memcmp(ic->in, Ice_head, ICE_TYPE_AT) != 0)
        return ICE_CONNECTION_LOST;
    if (type == ICE_REQUEST)
        return dispatch(ic, connection, is);
    if (type == ICE_VALIDATE)
        ic->connections[connection] = ICE_OK;
    else if (type != ICE_REPLY)
        return type == ICE_CLOSE ? ICE_CONNECTION_CLOSED : ICE_CONNECTION_LOST;
    else if (Ice_InputStream_readInt(is) == ic->id && connection == ic->connection)
        ic->call = (Ice_Byte)readReply(is); /* another one came too late */
    return ICE_OK;
}

Ice_Status Ice_Communicator_poll(Ice_CommunicatorPtr ic, Ice_Int timeoutMs) {
    Ice_Event event;
    Ice_Status end = ICE_CONNECTION_LOST;
    event.kind = ICE_EVENT_NONE;
    (void)ic->endpoint->receive(ic->endpointContext, ic->in, timeoutMs, &event);
    if (event.kind == ICE_EVENT_NONE)
        return ICE_TIMEOUT;
    if (event.kind == ICE_EVENT_OPENED) { /* who accepts a connection speaks first */
        ic->connections[event.connection] = ICE_OK;
        (void)begin(ic, ICE_VALIDATE);
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

/* ---- calls ---- */

/* Receives until `status` is another one than ICE_LATER. */
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
        *connection = ICE_LATER; /* until the peer's first message */
    return await(self, connection);
}

Ice_OutputStreamPtr Ice_ObjectPrx_begin(Ice_ObjectPrxPtr self, const char* operation,
                                        Ice_Byte mode) {
    Ice_CommunicatorPtr ic = self->communicator;
    Ice_OutputStreamPtr os;
    self->status = ICE_LIMIT;
    if (ic->busy)
        return 0;
    self->status = ICE_TWOWAY_ONLY;
    if (self->mode != ICE_TWOWAY && mode & ICE_RESULTS)
        return 0;
    self->status = (Ice_Byte)connect(self);
    os = begin(ic, ICE_REQUEST);
    os->minor = self->minor;
    ic->id += 2;
    Ice_OutputStream_writeInt(os, self->mode == ICE_TWOWAY ? ic->id : 0);
    Ice_OutputStream_writeBlob(os, self->identity, self->identitySize);
    Ice_OutputStream_writeText(os, operation);
    Ice_OutputStream_writeShort(os, mode & ~ICE_RESULTS); /* and no context */
    ic->body = Ice_beginEncapsulation(os);
    return os;
}

Ice_Status Ice_ObjectPrx_invoke(Ice_ObjectPrxPtr self, Ice_InputStreamPtr* is) {
    Ice_CommunicatorPtr ic = self->communicator;
    Ice_Status status = (Ice_Status)self->status;
    *is = &ic->is;
    ic->is.failed = 0; /* a oneway call reads nothing */
    if (ic->os.failed)
        status = ICE_MARSHAL;
    if (status != ICE_OK)
        return status;
    Ice_endEncapsulation(&ic->os, ic->body);
    ic->connection = self->connection;
    ic->call = ICE_LATER;
    status = send(ic, self->connection);
    return status != ICE_OK || self->mode != ICE_TWOWAY ? status : await(self, &ic->call);
}

Ice_Status Ice_ObjectPrx_end(Ice_ObjectPrxPtr self, Ice_Status status) {
    return status <= ICE_USER_EXCEPTION && self->communicator->is.failed ? ICE_MARSHAL : status;
}

/* ---- proxies' strings ---- */

/* The options behind the transport's name, or 0 where the text names another transport. */
static const char* optionsOf(Ice_CommunicatorPtr ic, const char* text) {
    size_t size = strlen(ic->endpoint->name);
    return strncmp(text, ic->endpoint->name, size) == 0 && text[size] <= ' ' ? text + size : 0;
}

/* "name [-t|-o]:transport options"; without a transport: of an object here. */
static Ice_Status parse(Ice_CommunicatorPtr ic, const char* text, Ice_ObjectPrxPtr prx) {
    size_t size = strcspn(text, " :");
    const char* options = strchr(text, ':');
    Ice_OutputStream os;
    Ice_ObjectPrx_init(prx, ic);
    if (size - 1U > ICE_IDENTITY_MAX - 4U)
        return ICE_LIMIT;
    prx->identity[0] = (Ice_Byte)size;
    memcpy(prx->identity + 1, text, size); /* behind it are 0: no category, no facet */
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

/* ---- adapter and communicator ---- */

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
