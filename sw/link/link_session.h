/* SPDX-License-Identifier: MIT
 *
 * link_session: begins and ends sessions, and passes each opened frame to the part of the link that
 * handles it.
 */
#pragma once

#include "link_handshake.h"
#include "link_liveness.h"
#include "link_sender.h"

typedef struct Link_Session {
    U8 wanted;    /* 1: Link_start was called */
    U32 failures; /* number of the session's frames with a wrong tag */
    Link_Handshake handshake;
    Link_Liveness liveness;
    Link_Receiver receiver;
    Link_Sender sender;
} Link_Session;

/* Records whether the program wants a session. */
#define LINK_WANT(session, isWanted) ((session)->wanted = (isWanted))

/* Ends the session, if there is one: clears its state and reports its end. */
void link_endSession(Link_Session* session, Link_State next);

/* Ends the session because the peer has ended it, or because the peer has been silent for too
 * long. */
void link_lose(Link_Session* session);

/* Ends the session, if there is one, by decision of this side, and sends BYE. */
void link_abort(Link_Session* session);

/* Returns the cost of trying to open a plausible frame, in rounds of Ascon; 0 if the frame is
 * not for this side. */
U32 link_costOf(const Link_Session* session, const U8* frame);

/* Writes the seal with which a genuine frame must have been made. Two seals may be possible;
 * `attempt` (0 or 1) selects one. Returns 0 if no genuine frame of this kind can exist now. */
int link_expect(Link_Session* session, const U8* frame, U32 attempt, Link_Seal* seal);

/* Processes a frame that was opened with the seal of `attempt`. */
void link_onFrame(Link_Session* session, const U8* frame, U32 attempt);

/* Counts a frame that could not be opened with any key of the session. If it is a handshake frame,
 * wipes the candidate instead. */
void link_onForgery(Link_Session* session, const U8* frame);

/* Polls the handshake and the liveness. Ends a session if the peer is silent, or if the session has
 * reached LINK_LAST_NUMBER or LINK_MOST_FAILURES. Returns 1 if there is a session. */
int link_pollSession(Link_Session* session);
