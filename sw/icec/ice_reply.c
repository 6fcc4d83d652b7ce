/* SPDX-License-Identifier: MIT
 *
 * ice_reply: replies, and those that come later than their operation's end.
 */
#include "ice_private.h"

void Ice_finishReply(Ice_OutputStreamPtr os, Ice_Int id, Ice_Status status, const Ice_Byte* who,
                     Ice_Int whoSize) {
    Ice_Int end = os->size;
    Ice_Status code = os->failed ? ICE_MARSHAL : status;
    if (code > ICE_UNKNOWN_EXCEPTION)
        code = code <= ICE_PROTOCOL ? ICE_UNKNOWN_LOCAL_EXCEPTION : ICE_UNKNOWN_EXCEPTION;
    if (ICEC_ASYNC && code >= ICE_OBJECT_NOT_EXIST && code <= ICE_OPERATION_NOT_EXIST &&
        whoSize == 0)
        code = ICE_UNKNOWN_EXCEPTION;
    os->failed = 0;
    os->size = 0;
    Ice_beginMessage(os, ICE_REPLY);
    Ice_OutputStream_writeInt(os, id);
    Ice_OutputStream_writeByte(os, (Ice_Byte)code);
    if (code <= ICE_USER_EXCEPTION) {
        (void)Ice_beginEncapsulation(os);
        os->size = end;
        Ice_endEncapsulation(os, ICE_REPLY_BODY);
    } else if (code <= ICE_OPERATION_NOT_EXIST) {
        Ice_OutputStream_writeBlob(os, who, whoSize);
    } else if (ICEC_DETAILS) {
        Ice_OutputStream_writeText(os, Ice_Status_text(status));
    } else {
        Ice_OutputStream_writeByte(os, 0);
    }
    Ice_endMessage(os);
}

int Ice_countPending(Ice_CommunicatorPtr ic, int connection, U16 generation, int change) {
    Ice_Connection* c = &ic->connections[connection];
    int same;
    Ice_lock(ic, ICE_LOCK_STATE);
    same = c->generation == generation && c->state == ICE_DONE;
    if (same)
        c->pending = (Ice_Byte)(c->pending + change);
    Ice_unlock(ic, ICE_LOCK_STATE);
    return same;
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
    Ice_lock(ic, ICE_LOCK_SEND);
    Ice_initRequest(ic);
    ic->request.size = ICE_REPLY_HEAD;
    ic->request.minor = reply->minor;
    return &ic->request;
}

Ice_Status Ice_Reply_end(Ice_Reply* reply, Ice_Status status) {
    Ice_CommunicatorPtr ic = reply->communicator;
    Ice_Status sent = ICE_OK;
    if (!Ice_countPending(ic, reply->connection, reply->generation, -1)) {
        sent = ICE_CONNECTION_LOST;
    } else if (reply->id != 0) {
        Ice_finishReply(&ic->request, reply->id, status, 0, 0);
        sent = Ice_send(ic, reply->connection, &ic->request);
    }
    Ice_unlock(ic, ICE_LOCK_SEND);
    return sent;
}
