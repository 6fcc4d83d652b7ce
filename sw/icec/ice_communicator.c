/* SPDX-License-Identifier: MIT
 *
 * ice_communicator: communicator, adapters, and what arrives on connections.
 */
#include "ice_private.h"

#include <string.h>

static void nothing(void *context) {
    (void)context;
}

static void nothingForSlot(void *context, int slot) {
    (void)context;
    (void)slot;
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

const Ice_Os Ice_Os_none = {nothing, nothing, neverWoken, nothingForSlot, oneTask};

const char *Ice_Status_text(Ice_Status status) {
    static const char *const texts[] = {
        "ok", "object does not exist", "facet does not exist", "operation does not exist",
        "user exception", "the servant failed", "message malformed or too long for IceC's buffers",
        "timeout", "connection lost", "no such endpoint", "a limit of IceC was reached",
        "protocol or encoding not supported"};
    return texts[status];
}

void Ice_initialize(Ice_CommunicatorPtr ic) {
    memset(ic, 0, sizeof *ic);
    ic->os = &Ice_Os_none;
    ic->receiver = -1;
}

void Ice_Communicator_setOs(Ice_CommunicatorPtr ic, const Ice_Os *os, void *context) {
    ic->os = os;
    ic->osContext = context;
}

void Ice_Communicator_setEndpoint(Ice_CommunicatorPtr ic, const Ice_Endpoint *endpoint, void *context) {
    ic->endpoint = endpoint;
    ic->endpointContext = context;
}

/* The options behind "name", or 0 where the text names another transport. */
static const char *optionsOf(Ice_CommunicatorPtr ic, const char *text) {
    size_t n = ic->endpoint ? strlen(ic->endpoint->name) : 0;
    if (n == 0 || strncmp(text, ic->endpoint->name, n) != 0 || (text[n] != ' ' && text[n] != 0))
        return 0;
    return text + n;
}

Ice_Status Ice_Communicator_createObjectAdapterWithEndpoints(Ice_CommunicatorPtr ic, const char *name,
                                                             const char *endpoints,
                                                             Ice_ObjectAdapterPtr adapter) {
    const char *options = optionsOf(ic, endpoints);
    int a;
    memset(adapter, 0, sizeof *adapter);
    adapter->communicator = ic;
    adapter->name = name;
    if (!options)
        return ICE_NO_ENDPOINT;
    for (a = 0; a < ICE_ADAPTERS; ++a)
        if (!ic->adapters[a]) {
            ic->adapters[a] = adapter;
            return ic->endpoint->listen(ic->endpointContext, options);
        }
    return ICE_LIMIT;
}

Ice_Status Ice_ObjectAdapter_add(Ice_ObjectAdapterPtr adapter, Ice_ObjectPtr servant, const char *identity) {
    int s, free = -1;
    for (s = ICE_SERVANTS - 1; s >= 0; --s) {
        if (!adapter->servants[s].name)
            free = s;
        else if (strcmp(adapter->servants[s].name, identity) == 0)
            return ICE_LIMIT; /* the identity is taken */
    }
    if (free < 0)
        return ICE_LIMIT;
    adapter->servants[free].servant = servant;
    adapter->servants[free].name = identity;
    return ICE_OK;
}

Ice_Status Ice_ObjectAdapter_remove(Ice_ObjectAdapterPtr adapter, const char *identity) {
    int s;
    for (s = 0; s < ICE_SERVANTS; ++s)
        if (adapter->servants[s].name && strcmp(adapter->servants[s].name, identity) == 0) {
            adapter->servants[s].name = 0;
            return ICE_OK;
        }
    return ICE_OBJECT_NOT_EXIST;
}

void Ice_ObjectAdapter_activate(Ice_ObjectAdapterPtr adapter) {
    adapter->active = 1;
}

Ice_Status Ice_sendPlain(Ice_CommunicatorPtr ic, int connection, Ice_Byte type) {
    Ice_Byte bytes[ICE_HEADER];
    Ice_OutputStream os;
    Ice_OutputStream_init(&os, bytes, ICE_HEADER);
    Ice_beginMessage(&os, type);
    return ic->endpoint->send(ic->endpointContext, connection, bytes, ICE_HEADER);
}

static void lose(Ice_CommunicatorPtr ic, int connection) {
    ic->open[connection] = ic->validated[connection] = 0;
    Ice_failCalls(ic, connection);
}

/* 0: no IceP 1.0 message, or compressed: the connection is closed. */
static int takeMessage(Ice_CommunicatorPtr ic, int connection, Ice_Int size) {
    static const Ice_Byte head[6] = {'I', 'c', 'e', 'P', 1, 0};
    Ice_InputStream is;
    Ice_Byte type, compression;
    Ice_InputStream_init(&is, ic->in, size);
    if (size < ICE_HEADER || memcmp(ic->in, head, 6) != 0)
        return 0;
    is.position = 8;
    type = Ice_InputStream_readByte(&is);
    compression = Ice_InputStream_readByte(&is);
    if (Ice_InputStream_readInt(&is) != size || compression > 1)
        return 0;
    switch (type) {
    case ICE_REQUEST:
        Ice_dispatchMessage(ic, connection, &is);
        break;
    case ICE_BATCH:
        Ice_dispatchBatch(ic, connection, &is);
        break;
    case ICE_REPLY:
        Ice_takeReply(ic, &is);
        break;
    case ICE_VALIDATE:
        ic->validated[connection] = 1;
        Ice_wakeCalls(ic);
        break;
    case ICE_CLOSE:
        return 0;
    default:
        return 0;
    }
    return 1;
}

Ice_Status Ice_Communicator_poll(Ice_CommunicatorPtr ic, Ice_Int timeoutMs) {
    Ice_Event event;
    Ice_Status status;
    if (!ic->endpoint)
        return ICE_NO_ENDPOINT;
    event.kind = ICE_EVENT_NONE;
    status = ic->endpoint->receive(ic->endpointContext, ic->in, timeoutMs, &event);
    if (status != ICE_OK)
        return status;
    switch (event.kind) {
    case ICE_EVENT_OPENED: /* who accepts a connection speaks first */
        ic->open[event.connection] = 1;
        (void)Ice_sendPlain(ic, event.connection, ICE_VALIDATE);
        break;
    case ICE_EVENT_MESSAGE:
        if (!takeMessage(ic, event.connection, event.size)) {
            ic->endpoint->close(ic->endpointContext, event.connection);
            lose(ic, event.connection);
        }
        break;
    case ICE_EVENT_CLOSED:
        lose(ic, event.connection);
        break;
    default:
        return ICE_TIMEOUT;
    }
    return ICE_OK;
}

void Ice_Communicator_waitForShutdown(Ice_CommunicatorPtr ic) {
    ic->receiver = ic->os->task(ic->osContext);
    while (!ic->stopping)
        (void)Ice_Communicator_poll(ic, 1000);
    ic->receiver = -1;
}

void Ice_Communicator_shutdown(Ice_CommunicatorPtr ic) {
    ic->stopping = 1;
    if (ic->endpoint)
        ic->endpoint->wake(ic->endpointContext);
}
