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

/* Sends the whole message in `os`; under ICE_LOCK_SEND. ICE_CONNECTION_LOST: the connection is
 * over. */
Ice_Status icec_send(Ice_CommunicatorPtr ic, int connection, Ice_OutputStreamPtr os);
/* Sends a message without a body: ICEC_VALIDATE or ICEC_CLOSE. */
Ice_Status icec_sendHead(Ice_CommunicatorPtr ic, int connection, Ice_Byte type);

/* Begins a connection of this number; under the state lock. */
void icec_openConnection(Ice_CommunicatorPtr ic, int connection, Ice_ConnectionState state);
/* Closes the transport's connection; icec_loseConnection ends its calls. */
void icec_closeConnection(Ice_CommunicatorPtr ic, int connection);
Ice_ConnectionState icec_connectionState(Ice_CommunicatorPtr ic, int connection);

/* Sends CloseConnection, once: pending requests of the peer were not executed, and it closes. Waits
 * until operations under way have been answered: then the next call sends. */
void icec_askToClose(Ice_CommunicatorPtr ic, int connection);
int icec_isStopping(Ice_CommunicatorPtr ic);

/* Counts `change` more operations under way on a connection. 0: the number now belongs to another
 * connection, or to none. */
int icec_countPending(Ice_CommunicatorPtr ic, int connection, U16 generation, int change);

/* Gives `is` the part of the communicator's arena that outer operations do not use. */
void icec_giveArena(Ice_CommunicatorPtr ic, Ice_InputStreamPtr is);

#endif
