/* SPDX-License-Identifier: MIT
 *
 * ice_dispatch: from a request to a servant and back: built-in operations, replies, failures.
 */
#include "ice_private.h"

/* Reply status on the wire. */
enum {
    REPLY_OK, REPLY_USER, REPLY_NO_OBJECT, REPLY_NO_FACET, REPLY_NO_OPERATION, REPLY_UNKNOWN_LOCAL,
    REPLY_UNKNOWN_USER, REPLY_UNKNOWN
};

void Ice_patchInt(Ice_OutputStreamPtr os, Ice_Int at, Ice_Int value) {
    Ice_Int end = os->size;
    if (os->failed)
        return;
    os->size = at;
    Ice_OutputStream_writeInt(os, value);
    os->size = end;
}

void Ice_beginMessage(Ice_OutputStreamPtr os, Ice_Byte type) {
    static const Ice_Byte head[8] = {'I', 'c', 'e', 'P', 1, 0, 1, 0};
    Ice_OutputStream_writeBlob(os, head, 8);
    Ice_OutputStream_writeByte(os, type);
    Ice_OutputStream_writeByte(os, 0);
    Ice_OutputStream_writeInt(os, ICE_HEADER);
}

void Ice_endMessage(Ice_OutputStreamPtr os) {
    Ice_patchInt(os, 10, os->size);
}

Ice_Int Ice_beginEncapsulation(Ice_OutputStreamPtr os) {
    Ice_Int begin = os->size;
    Ice_OutputStream_writeInt(os, 6);
    Ice_OutputStream_writeByte(os, 1);
    Ice_OutputStream_writeByte(os, os->minor);
    return begin;
}

void Ice_endEncapsulation(Ice_OutputStreamPtr os, Ice_Int begin) {
    Ice_patchInt(os, begin, os->size - begin);
}

Ice_Status Ice_enterEncapsulation(Ice_InputStreamPtr is) {
    Ice_Int size = Ice_InputStream_readInt(is);
    Ice_Byte major = Ice_InputStream_readByte(is);
    Ice_Byte minor = Ice_InputStream_readByte(is);
    if (is->failed || size < 6 || size - 6 > is->size - is->position)
        return ICE_MARSHAL;
    is->size = is->position + size - 6;
    is->minor = minor;
    return major == 1 && minor <= 1 ? ICE_OK : ICE_PROTOCOL;
}

static Ice_ObjectPtr find(Ice_CommunicatorPtr ic, Ice_Current *current) {
    int a, s;
    if (current->category.size)
        return 0;
    for (a = 0; a < ICE_ADAPTERS; ++a) {
        Ice_ObjectAdapterPtr adapter = ic->adapters[a];
        for (s = 0; adapter && adapter->active && s < ICE_SERVANTS; ++s)
            if (adapter->servants[s].name &&
                Ice_String_equals(current->name, adapter->servants[s].name)) {
                current->adapter = adapter;
                return adapter->servants[s].servant;
            }
    }
    return 0;
}

static int isA(Ice_ObjectPtr servant, Ice_String id) {
    const char *const *own;
    for (own = servant->ids; *own; ++own)
        if (Ice_String_equals(id, *own))
            return 1;
    return 0;
}

static Ice_Status builtIn(Ice_ObjectPtr servant, const Ice_Current *current, Ice_InputStreamPtr is,
                          Ice_OutputStreamPtr os) {
    if (Ice_String_equals(current->operation, "ice_ping"))
        return ICE_OK;
    if (Ice_String_equals(current->operation, "ice_isA")) {
        Ice_OutputStream_writeBool(os, (Ice_Bool)isA(servant, Ice_InputStream_readString(is)));
        return ICE_OK;
    }
    if (Ice_String_equals(current->operation, "ice_id")) {
        Ice_OutputStream_writeString(os, Ice_String_from(servant->id));
        return ICE_OK;
    }
    if (Ice_String_equals(current->operation, "ice_ids")) {
        Ice_Int n = 0;
        while (servant->ids[n])
            ++n;
        Ice_OutputStream_writeSize(os, n);
        for (n = 0; servant->ids[n]; ++n)
            Ice_OutputStream_writeString(os, Ice_String_from(servant->ids[n]));
        return ICE_OK;
    }
    return ICE_OPERATION_NOT_EXIST;
}

/* What follows the request id, up to the parameters. */
static Ice_Status readHead(Ice_InputStreamPtr is, Ice_Current *current) {
    Ice_Int n;
    Ice_Status status = ICE_OK;
    current->name = Ice_InputStream_readString(is);
    current->category = Ice_InputStream_readString(is);
    n = Ice_InputStream_readSequence(is, 1);
    if (n)
        status = ICE_FACET_NOT_EXIST;
    while (n--)
        (void)Ice_InputStream_readString(is);
    current->operation = Ice_InputStream_readString(is);
    current->mode = Ice_InputStream_readByte(is);
    for (n = Ice_InputStream_readSequence(is, 2); n > 0; --n) {
        (void)Ice_InputStream_readString(is); /* contexts are not used, and do not disturb */
        (void)Ice_InputStream_readString(is);
    }
    return is->failed ? ICE_MARSHAL : status;
}

static Ice_Status run(Ice_CommunicatorPtr ic, Ice_Current *current, Ice_InputStreamPtr is,
                      Ice_OutputStreamPtr os) {
    Ice_ObjectPtr servant = find(ic, current);
    Ice_Status status;
    if (!servant)
        return ICE_OBJECT_NOT_EXIST;
    status = builtIn(servant, current, is, os);
    if (status == ICE_OPERATION_NOT_EXIST)
        status = servant->dispatch(servant, current, is, os);
    return status == ICE_OK && (is->failed || os->failed) ? ICE_MARSHAL : status;
}

static void writeFailure(Ice_OutputStreamPtr os, Ice_Status status, const Ice_Current *current) {
    if (status >= ICE_OBJECT_NOT_EXIST && status <= ICE_OPERATION_NOT_EXIST) {
        Ice_OutputStream_writeByte(os, (Ice_Byte)(REPLY_NO_OBJECT + (status - ICE_OBJECT_NOT_EXIST)));
        Ice_OutputStream_writeString(os, current->name);
        Ice_OutputStream_writeString(os, current->category);
        Ice_OutputStream_writeSize(os, 0);
        Ice_OutputStream_writeString(os, current->operation);
        return;
    }
    Ice_OutputStream_writeByte(os, status == ICE_MARSHAL || status == ICE_PROTOCOL ? REPLY_UNKNOWN_LOCAL
                                                                                   : REPLY_UNKNOWN);
    Ice_OutputStream_writeString(os, Ice_String_from(Ice_Status_text(status)));
}

/* One request, its id already read. */
static void dispatch(Ice_CommunicatorPtr ic, int connection, Ice_InputStreamPtr is, Ice_Int id) {
    Ice_OutputStream os;
    Ice_Current current;
    Ice_Status status = readHead(is, &current);
    Ice_Int whole = is->size, body, afterId;
    Ice_Status entered;
    if (status == ICE_MARSHAL)
        return; /* the connection is told by the caller: nothing can be answered */
    current.connection = connection;
    current.adapter = 0;
    is->arena = ic->arena;
    is->arenaSize = ICE_ARENA_BYTES / 4;
    is->arenaUsed = 0;
    entered = Ice_enterEncapsulation(is);
    if (status == ICE_OK)
        status = entered;

    Ice_OutputStream_init(&os, ic->out, ICE_MESSAGE_MAX);
    os.minor = is->minor <= 1 ? is->minor : 1;
    Ice_beginMessage(&os, ICE_REPLY);
    Ice_OutputStream_writeInt(&os, id);
    afterId = os.size;
    Ice_OutputStream_writeByte(&os, REPLY_OK);
    body = Ice_beginEncapsulation(&os);
    ic->dispatching = 1;
    if (status == ICE_OK)
        status = run(ic, &current, is, &os);
    ic->dispatching = 0;
    if (status == ICE_USER_EXCEPTION)
        os.data[afterId] = REPLY_USER;
    Ice_endEncapsulation(&os, body);
    if (status != ICE_OK && status != ICE_USER_EXCEPTION) {
        os.failed = 0;
        os.size = afterId;
        writeFailure(&os, status, &current);
    }
    Ice_endMessage(&os);
    /* The next request of a batch begins where this one's parameters end. */
    is->position = is->size;
    is->size = whole;
    is->failed = 0;
    if (id != 0)
        (void)ic->endpoint->send(ic->endpointContext, connection, os.data, os.size);
}

void Ice_dispatchMessage(Ice_CommunicatorPtr ic, int connection, Ice_InputStreamPtr is) {
    Ice_Int id = Ice_InputStream_readInt(is);
    dispatch(ic, connection, is, id);
}

void Ice_dispatchBatch(Ice_CommunicatorPtr ic, int connection, Ice_InputStreamPtr is) {
    Ice_Int count = Ice_InputStream_readInt(is);
    while (count-- > 0 && !is->failed && is->position < is->size)
        dispatch(ic, connection, is, 0);
}
