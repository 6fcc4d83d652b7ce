/* SPDX-License-Identifier: MIT
 *
 * ice_transport: locks, time, and the connections: their states, and sending on them.
 */
#ifndef ICE_TRANSPORT_H
#define ICE_TRANSPORT_H

#include "icec.h"

/* `which`: ICE_LOCK_STATE or ICE_LOCK_SEND. */
#define icec_lock(ic, which) ((ic)->os->lock((ic)->osContext, which))
#define icec_unlock(ic, which) ((ic)->os->unlock((ic)->osContext, which))

/* Milliseconds since any time; wraps. */
U32 icec_nowMs(Ice_CommunicatorPtr ic);

/* Sends the whole message in `os`; under ICE_LOCK_SEND. ICE_CONNECTION_LOST: it is over. */
Ice_Status icec_send(Ice_CommunicatorPtr ic, int connection, Ice_OutputStreamPtr os);
/* Sends a message that is nothing but its head: ICEC_VALIDATE or ICEC_CLOSE. */
Ice_Status icec_sendHead(Ice_CommunicatorPtr ic, int connection, Ice_Byte type);

/* Begins a connection of this number; under the state lock. */
void icec_openConnection(Ice_CommunicatorPtr ic, int connection, Ice_ConnectionState state);
/* Closes the transport's connection; its calls are another matter (icec_loseConnection). */
void icec_closeConnection(Ice_CommunicatorPtr ic, int connection);
Ice_ConnectionState icec_connectionState(Ice_CommunicatorPtr ic, int connection);

/* Sends CloseConnection, once: what the peer waits for was not executed, and it closes. Waits until
 * operations under way have been answered: then the next call sends. */
void icec_askToClose(Ice_CommunicatorPtr ic, int connection);
int icec_isStopping(Ice_CommunicatorPtr ic);

/* Counts `change` more operations under way on a connection. 0: the number is another connection's
 * by now, or nobody's. */
int icec_countPending(Ice_CommunicatorPtr ic, int connection, U16 generation, int change);

/* Gives `is` the communicator's arena behind what outer operations use of it. */
void icec_giveArena(Ice_CommunicatorPtr ic, Ice_InputStreamPtr is);

#endif
