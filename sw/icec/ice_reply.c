/* SPDX-License-Identifier: MIT
 *
 * ice_reply: replies, also those after their operation's end.
 */
#include "ice_private.h"

/* Writes the reply's head. It is written last, since another reply may have used its place
 * before. */
static void writeHead(Ice_OutputStreamPtr os, Ice_Int id) {
    Ice_OutputStream head;
    Ice_OutputStream_init(&head, os->data, ICEC_REPLY_HEAD);
    icec_beginMessage(&head, ICEC_REPLY);
    head.minor = os->minor;
    icec_beginReply(&head, id);
}

Ice_Status icec_sendReply(Ice_CommunicatorPtr ic, int connection, Ice_OutputStreamPtr os,
                          Ice_Int id, Ice_Status status, const Icec_Target* target) {
    const char* reason;
    if (os->failed)
        status = ICE_MARSHAL;
    reason = os->failed ? Ice_Failed_text(os->failed, os->bound) : Ice_Status_text(status);
    /* The request has gone, and with it the names that this failure would repeat. */
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
        sent = icec_sendReply(ic, reply->connection, &ic->request, reply->id, status, 0);
    }
    icec_unlock(ic, ICE_LOCK_SEND);
    return sent;
}
