/* SPDX-License-Identifier: MIT
 *
 * ice_reply: answers that come later than their operation's end.
 */
#include "ice_private.h"

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
