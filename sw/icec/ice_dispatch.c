/* SPDX-License-Identifier: MIT
 *
 * ice_dispatch: from a request to a servant and back: built-in operations, replies, failures.
 */
#include "ice_private.h"

/* The servant, else the category's default servant, else the default servant of all. */
static Ice_ObjectPtr find(Ice_CommunicatorPtr ic, Ice_Current* current, Ice_Status* status) {
    Ice_ObjectAdapterPtr adapter;
    Ice_ObjectPtr servant = 0;
    int s, rank = 0;
    *status = ICE_OBJECT_NOT_EXIST;
    Ice_lock(ic, ICE_LOCK_STATE);
    for (adapter = ic->adapters; adapter; adapter = adapter->next)
        for (s = 0; adapter->active && s < ICE_SERVANTS; ++s) {
            const Ice_Identity* id = &adapter->servants[s].identity;
            int is = 0;
            if (!adapter->servants[s].servant)
                continue;
            if (id->name.size == 0) {
                if (id->category.size == 0)
                    is = 1;
                else if (Ice_String_same(&id->category, &current->category))
                    is = 2;
            } else if (Ice_String_same(&id->name, &current->name) &&
                       Ice_String_same(&id->category, &current->category)) {
                *status = ICE_FACET_NOT_EXIST;
                is = Ice_String_same(&adapter->servants[s].facet, &current->facet) ? 3 : 0;
            }
            if (is > rank) {
                rank = is;
                servant = adapter->servants[s].servant;
                current->adapter = adapter;
            }
        }
    Ice_unlock(ic, ICE_LOCK_STATE);
    return servant;
}

/* The operations that every object has; other ones are the servant's. */
static Ice_Status run(Ice_ObjectPtr servant, const Ice_Current* current, Ice_InputStreamPtr is,
                      Ice_OutputStreamPtr os) {
    const char* const* id = servant->ids;
    const Ice_String* operation = &current->operation;
    if (Ice_String_is(operation, "ice_isA")) {
        Ice_String wanted;
        Ice_InputStream_takeString(is, &wanted);
        while (*id && !Ice_String_is(&wanted, *id))
            ++id;
        Ice_OutputStream_writeByte(os, *id != 0);
    } else if (ICEC_IDS && Ice_String_is(operation, "ice_id")) {
        Ice_OutputStream_writeText(os, servant->id);
    } else if (ICEC_IDS && Ice_String_is(operation, "ice_ids")) {
        while (*id)
            ++id;
        Ice_OutputStream_writeSize(os, (Ice_Int)(id - servant->ids));
        for (id = servant->ids; *id; ++id)
            Ice_OutputStream_writeText(os, *id);
    } else if (!Ice_String_is(operation, "ice_ping")) {
        return servant->dispatch(servant, current, is, os);
    }
    return ICE_OK;
}

void Ice_giveArena(Ice_CommunicatorPtr ic, Ice_InputStreamPtr is) {
    is->arena = ic->arena;
    is->arenaSize = ICE_ARENA_BYTES / 4;
    if (ICEC_NESTING > 1)
        is->arenaUsed = ic->decoding ? ic->decoding->arenaUsed : 0;
    else
        is->arenaUsed = 0;
}

/* One request; in a batch they have no ids. */
static Ice_Status dispatch(Ice_CommunicatorPtr ic, int connection, Ice_InputStreamPtr is,
                           int isBatch) {
    Ice_InputStreamPtr outer = ic->decoding;
    U16 generation = ic->connections[connection].generation;
    Ice_OutputStream os;
    Ice_Current current;
    Ice_ObjectPtr servant;
    Ice_Status status, found;
    Ice_Int whole = is->size, who, whoSize, pairs, id = 0;
    if (!isBatch)
        id = Ice_InputStream_readInt(is);
    who = is->position;
    current.communicator = ic;
    current.connection = connection;
    if (ICEC_ASYNC)
        current.requestId = id;
    Ice_InputStream_takeString(is, &current.name);
    Ice_InputStream_takeString(is, &current.category);
    Ice_readFacet(is, &current.facet);
    Ice_InputStream_takeString(is, &current.operation);
    whoSize = is->position - who;
    current.mode = Ice_InputStream_readByte(is);
    if (ICEC_CONTEXTS)
        current.context = *is;
    pairs = Ice_InputStream_readSize(is);
    Ice_skipStrings(is, 2U * (U32)pairs); /* more than there can be are malformed */
    status = Ice_enterEncapsulation(is);
    if (status == ICE_MARSHAL)
        return ICE_CONNECTION_LOST;
    Ice_giveArena(ic, is);
    Ice_OutputStream_init(&os, ic->out, ICE_MESSAGE_MAX);
    os.minor = is->minor & 1U;
    if (ICEC_ASYNC)
        current.minor = os.minor;
    os.size = ICE_REPLY_HEAD;
    servant = find(ic, &current, &found);
    if (status == ICE_OK)
        status = found;
    if (servant && status != ICE_PROTOCOL) {
        if (ICEC_NESTING > 1)
            ic->decoding = is;
        if (ICEC_ASYNC)
            (void)Ice_countPending(ic, connection, generation, 1);
        status = run(servant, &current, is, &os);
        if (status == ICE_OK && is->failed)
            status = ICE_MARSHAL;
        if (ICEC_NESTING > 1)
            ic->decoding = outer;
        if (ICEC_ASYNC &&
            (status == ICE_LATER || !Ice_countPending(ic, connection, generation, -1)))
            id = 0; /* nothing to send now, or who asked has gone meanwhile */
    }
    if (ICEC_BATCH) { /* the next request begins where this one's parameters end */
        is->position = is->size;
        is->size = whole;
        is->failed = 0;
    }
    if (id != 0) {
        Ice_finishReply(&os, id, status, is->data + who, whoSize);
        Ice_lock(ic, ICE_LOCK_SEND);
        (void)Ice_send(ic, connection, &os);
        Ice_unlock(ic, ICE_LOCK_SEND);
    }
    return ICE_OK;
}

Ice_Status Ice_dispatchRequest(Ice_CommunicatorPtr ic, int connection, Ice_InputStreamPtr is) {
    return dispatch(ic, connection, is, 0);
}

Ice_Status Ice_dispatchBatch(Ice_CommunicatorPtr ic, int connection, Ice_InputStreamPtr is) {
    Ice_Int count = Ice_InputStream_readInt(is);
    Ice_Status status = is->failed || count < 0 ? ICE_CONNECTION_LOST : ICE_OK;
    for (; ICEC_BATCH && count > 0 && status == ICE_OK; --count)
        status = dispatch(ic, connection, is, 1);
    return status;
}

Ice_Bool Ice_Current_context(const Ice_Current* current, const char* key, Ice_String* value) {
    Ice_InputStream is = current->context;
    Ice_Int n;
    for (n = ICEC_CONTEXTS ? Ice_InputStream_readSize(&is) : 0; n > 0 && !is.failed; --n) {
        Ice_String found = Ice_InputStream_readString(&is);
        *value = Ice_InputStream_readString(&is);
        if (Ice_String_is(&found, key))
            return 1;
    }
    return 0;
}
