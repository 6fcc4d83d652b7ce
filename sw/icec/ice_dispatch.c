/* SPDX-License-Identifier: MIT
 *
 * ice_dispatch: passes a request to its servant, and sends the reply.
 */
#include "ice_operation.h"
#include "ice_private.h"

#include <string.h>

/* Rank of a servant's entry for a request. The best entry has exactly the identity of the request.
 * Next come the default servant of the category, and then the default servant of all categories. */
enum { NO_MATCH, DEFAULT_OF_ALL, DEFAULT_OF_CATEGORY, EXACT };

static int match(const Ice_Servant* entry, const Ice_Current* current, Ice_Status* status) {
    const Ice_Identity* id = &entry->identity;
    /* the sizes are compared first, because most names differ in size */
    if (!entry->servant || (id->name.size && id->name.size != current->name.size))
        return NO_MATCH;
    if (id->name.size == 0 && id->category.size == 0)
        return DEFAULT_OF_ALL;
    if ((id->name.size && !Ice_String_same(&id->name, &current->name)) ||
        !Ice_String_same(&id->category, &current->category))
        return NO_MATCH;
    if (id->name.size == 0)
        return DEFAULT_OF_CATEGORY;
    *status = ICE_FACET_NOT_EXIST;
    return Ice_String_same(&entry->facet, &current->facet) ? EXACT : NO_MATCH;
}

/* Finds the servant for `current`, sets current->adapter, and counts the operation as in progress.
 * Returns 0 and sets `status` if the servant is missing; after shutdown, the status is
 * ICE_CONNECTION_CLOSED. */
static Ice_ObjectPtr find(Ice_CommunicatorPtr ic, Ice_Current* current, Ice_Status* status) {
    Ice_ObjectAdapterPtr adapter;
    Ice_ObjectPtr servant = 0;
    int s, best = NO_MATCH;
    icec_lock(ic, ICE_LOCK_STATE);
    *status = ic->stopping ? ICE_CONNECTION_CLOSED : ICE_OBJECT_NOT_EXIST;
    for (adapter = ic->stopping ? 0 : ic->adapters; adapter; adapter = adapter->next)
        for (s = 0; adapter->active && s < ICE_SERVANTS && best != EXACT; ++s) {
            int found = match(&adapter->servants[s], current, status);
            if (found > best) {
                best = found;
                servant = adapter->servants[s].servant;
                current->adapter = adapter;
            }
        }
    if (servant && ic->connections[current->connection].pending++ == 0)
        ic->connections[current->connection].signMs = icec_nowMs(ic);
    icec_unlock(ic, ICE_LOCK_STATE);
    return servant;
}

static Ice_Status isA(Ice_ObjectPtr servant, Ice_InputStreamPtr is, Ice_OutputStreamPtr os) {
    const char* const* id = servant->ids;
    Ice_String wanted;
    Ice_InputStream_takeString(is, &wanted);
    if (Ice_InputStream_end(is))
        return ICE_MARSHAL;
    while (*id && !Ice_String_is(&wanted, *id))
        ++id;
    Ice_OutputStream_writeByte(os, *id != 0);
    return ICE_OK;
}

static Ice_Status writeIds(Ice_ObjectPtr servant, Ice_OutputStreamPtr os) {
    const char* const* id = servant->ids;
    while (*id)
        ++id;
    Ice_OutputStream_writeSize(os, (Ice_Int)(id - servant->ids));
    for (id = servant->ids; *id; ++id)
        Ice_OutputStream_writeText(os, *id);
    return ICE_OK;
}

Ice_Status Ice_Object_invoke(Ice_ObjectPtr servant, const Ice_Current* current,
                             Ice_InputStreamPtr is, Ice_OutputStreamPtr os) {
    const Ice_String* operation = &current->operation;
    if (!servant->ids || operation->size < 4 || memcmp(operation->data, "ice_", 4) != 0)
        return servant->dispatch(servant, current, is, os);
    if (Ice_String_is(operation, "ice_ping"))
        return ICE_OK;
    if (Ice_String_is(operation, "ice_isA"))
        return isA(servant, is, os);
    if (Ice_String_is(operation, "ice_ids"))
        return writeIds(servant, os);
    if (!Ice_String_is(operation, "ice_id"))
        return servant->dispatch(servant, current, is, os);
    Ice_OutputStream_writeText(os, servant->id);
    return ICE_OK;
}

/* Executes an operation that is counted as in progress on its connection. Sets `answers` to 0 if no
 * reply is to be sent now, because the servant replies later or the caller has disconnected. */
static Ice_Status runCounted(Ice_ObjectPtr servant, const Ice_Current* current,
                             Ice_InputStreamPtr is, Ice_OutputStreamPtr os, int* answers) {
    Ice_CommunicatorPtr ic = current->communicator;
    U16 generation = ic->connections[current->connection].generation;
    Ice_InputStreamPtr outer = ic->decoding;
    Ice_Status status;
    ic->decoding = is;
    status = Ice_Object_invoke(servant, current, is, os);
    if (is->bound)
        os->bound = is->bound;
    if (is->failed && (status == ICE_OK || status == ICE_MARSHAL))
        os->failed = is->failed;
    ic->decoding = outer;
    if (status == ICE_LATER || !icec_countPending(ic, current->connection, generation, -1))
        *answers = 0;
    return status;
}

/* Reads the fields of a request that follow the id, and restricts `is` to the parameters. Returns
 * the status of icec_enterEncapsulation. */
static Ice_Status readRequest(Ice_InputStreamPtr is, Ice_Current* current, Icec_Target* target) {
    Ice_Int begin = is->position;
    target->data = is->data + begin;
    Ice_InputStream_takeString(is, &current->name);
    Ice_InputStream_takeString(is, &current->category);
    icec_readFacet(is, &current->facet);
    Ice_InputStream_takeString(is, &current->operation);
    target->size = is->position - begin;
    current->mode = Ice_InputStream_readByte(is);
    current->context = *is;
    /* a facet with more than one string is malformed */
    icec_skipStrings(is, 2U * (U32)Ice_InputStream_readSize(is));
    return icec_enterEncapsulation(is);
}

/* Writes the header of the reply. This is done last, because another reply that was sent meanwhile
 * may have used the same buffer. */
static void writeHead(Ice_OutputStreamPtr os, Ice_Int id) {
    Ice_OutputStream head;
    Ice_OutputStream_init(&head, os->data, ICEC_REPLY_HEAD);
    icec_beginMessage(&head, ICEC_REPLY);
    head.minor = os->minor;
    icec_beginReply(&head, id);
}

/* Sends the results, which start at ICEC_REPLY_HEAD of `os`; or sends the failure `status`, with
 * its reason as text. The caller holds ICE_LOCK_SEND. `target` is 0 if the request's names are no
 * longer known. */
static Ice_Status sendReply(Ice_CommunicatorPtr ic, int connection, Ice_OutputStreamPtr os,
                            Ice_Int id, Ice_Status status, const Icec_Target* target) {
    const char* reason = os->bound;
    if (os->failed) {
        status = ICE_MARSHAL;
        reason = Ice_Failed_text(os->failed, reason);
    } else if (!reason) {
        reason = Ice_Status_text(status);
    }
    /* A reply with one of these failures must repeat the names in the request. If the request's
     * bytes no longer exist, another failure is sent. */
    if (!target && status >= ICE_OBJECT_NOT_EXIST && status <= ICE_OPERATION_NOT_EXIST)
        status = ICE_UNKNOWN_EXCEPTION;
    writeHead(os, id);
    icec_endReply(os, status, target);
    if (status > ICE_OPERATION_NOT_EXIST) {
        os->size = ICEC_REPLY_BODY;
        Ice_OutputStream_writeText(os, reason);
    }
    icec_endMessage(os);
    return icec_send(ic, connection, os);
}

/* Executes a request after its id was read. Leaves `is` at the end of the request's
 * parameters. */
static Ice_Status dispatch(Ice_CommunicatorPtr ic, int connection, Ice_InputStreamPtr is,
                           Ice_Int id) {
    Ice_OutputStream os;
    Ice_Current current;
    Icec_Target target;
    Ice_ObjectPtr servant;
    Ice_Status status;
    int answers = id != 0;
    current.communicator = ic;
    current.connection = connection;
    current.requestId = id;
    status = readRequest(is, &current, &target);
    if (status == ICE_MARSHAL)
        return ICE_CONNECTION_LOST;
    icec_giveArena(ic, is);
    Ice_OutputStream_init(&os, ic->out, ICE_RESULT_MAX);
    os.minor = current.minor = is->minor & 1U;
    os.size = ICEC_REPLY_HEAD;
    if (status == ICE_OK) {
        servant = find(ic, &current, &status);
        if (servant) {
            status = runCounted(servant, &current, is, &os, &answers);
        } else if (status == ICE_CONNECTION_CLOSED) {
            /* asks the peer to close the connection, because the request was not executed */
            icec_askToClose(ic, connection);
            answers = 0;
        }
    }
    if (answers) {
        icec_lock(ic, ICE_LOCK_SEND);
        (void)sendReply(ic, connection, &os, id, status, &target);
        icec_unlock(ic, ICE_LOCK_SEND);
    }
    return ICE_OK;
}

Ice_Status icec_dispatchRequest(Ice_CommunicatorPtr ic, int connection, Ice_InputStreamPtr is) {
    Ice_Int id = Ice_InputStream_readInt(is);
    return dispatch(ic, connection, is, id);
}

Ice_Status icec_dispatchBatch(Ice_CommunicatorPtr ic, int connection, Ice_InputStreamPtr is) {
    Ice_Int count = Ice_InputStream_readInt(is), whole = is->size;
    Ice_Status status = is->failed || count < 0 ? ICE_CONNECTION_LOST : ICE_OK;
    for (; count > 0 && status == ICE_OK; --count) {
        status = dispatch(ic, connection, is, 0);
        is->position = is->size; /* the next request begins at the end of these parameters */
        is->size = whole;
        is->failed = 0;
    }
    return status;
}

int Ice_markBroadcast(Ice_Byte* message, Ice_Int size) {
    Ice_InputStream is;
    Ice_InputStream_init(&is, message, size);
    if (icec_readHead(&is) != ICEC_REQUEST || Ice_InputStream_readInt(&is) != 0)
        return 0;
    icec_skipStrings(&is, 2); /* skips the identity, then the facet and the operation */
    icec_skipStrings(&is, (U32)Ice_InputStream_readSize(&is) + 1U);
    if (is.failed || is.position == size)
        return 0;
    message[is.position] |= ICE_BROADCAST;
    return 1;
}

void Ice_Current_later(const Ice_Current* current, Ice_Reply* reply) {
    reply->communicator = current->communicator;
    reply->id = current->requestId;
    reply->connection = current->connection;
    reply->generation = current->communicator->connections[current->connection].generation;
    reply->minor = current->minor;
}

Ice_OutputStreamPtr Ice_Reply_begin(Ice_Reply* reply) {
    Ice_CommunicatorPtr ic = reply->communicator;
    icec_lock(ic, ICE_LOCK_SEND);
    Ice_OutputStream_init(&ic->request, ic->requestData, ICE_REQUEST_MAX);
    ic->request.size = ICEC_REPLY_HEAD;
    ic->request.minor = reply->minor;
    return &ic->request;
}

Ice_Status Ice_Reply_end(Ice_Reply* reply, Ice_Status status) {
    Ice_CommunicatorPtr ic = reply->communicator;
    Ice_Status sent = ICE_OK;
    if (!icec_countPending(ic, reply->connection, reply->generation, -1)) {
        sent = ICE_CONNECTION_LOST;
    } else if (reply->id != 0) {
        if (ic->request.failed == ICE_FAILED_RESULT)
            ic->request.failed = ICE_FAILED_REQUEST;
        sent = sendReply(ic, reply->connection, &ic->request, reply->id, status, 0);
    }
    icec_unlock(ic, ICE_LOCK_SEND);
    return sent;
}

Ice_Bool Ice_Current_contextAt(const Ice_Current* current, Ice_Int index, Ice_String* key,
                               Ice_String* value) {
    Ice_InputStream is = current->context;
    Ice_Int left = Ice_InputStream_readSize(&is);
    if (index < 0 || index >= left)
        return 0;
    do {
        *key = Ice_InputStream_readString(&is);
        *value = Ice_InputStream_readString(&is);
    } while (index-- > 0);
    return !is.failed;
}

Ice_Bool Ice_Current_context(const Ice_Current* current, const char* key, Ice_String* value) {
    Ice_String found;
    Ice_Int index;
    for (index = 0; Ice_Current_contextAt(current, index, &found, value); ++index)
        if (Ice_String_is(&found, key))
            return 1;
    return 0;
}

Ice_Status Ice_Current_refuse(const Ice_Current* current, const char* text) {
    current->communicator->decoding->bound = text;
    return ICE_UNKNOWN_EXCEPTION;
}

Ice_Status Ice_Current_fail(const Ice_Current* current, const char* text) {
    Ice_InputStreamPtr is = current->communicator->decoding;
    is->failed = ICE_FAILED_BOUND;
    is->bound = text;
    return ICE_MARSHAL;
}

void* Ice_Current_allocate(const Ice_Current* current, Ice_Int bytes) {
    Ice_InputStreamPtr is = current->communicator->decoding;
    Ice_Byte failed = is->failed;
    void* room;
    is->failed = 0;
    room = bytes > 0 ? Ice_InputStream_allocate(is, bytes, 1) : 0;
    /* restored, so that a lack of room here does not make the reading of the parameters fail */
    is->failed = failed;
    return room;
}
