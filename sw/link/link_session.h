/* SPDX-License-Identifier: MIT
 *
 * link_session: begins and ends sessions, and gives each opened frame to the part that it is for.
 */
#pragma once

#include "link_handshake.h"
#include "link_liveness.h"
#include "link_sender.h"

typedef struct Link_Session {
    U8 wanted;    /* 1: Link_start was called */
    U32 failures; /* frames of the session with a wrong tag */
    Link_Handshake handshake;
    Link_Liveness liveness;
    Link_Receiver receiver;
    Link_Sender sender;
} Link_Session;

/* Records whether the program wants a session. */
#define LINK_WANT(session, isWanted) ((session)->wanted = (isWanted))

/* Ends the session, if any: clears its state and reports its end. */
void link_endSession(Link_Session* session, Link_State next);

/* Ends a session that the peer's wish or silence has ended. */
void link_lose(Link_Session* session);

/* Ends the session, if any, on request of this side, and sends BYE. */
void link_abort(Link_Session* session);

/* Returns the cost of trying to open a plausible frame, rounds of Ascon; 0 if it is not for this
 * side. */
U32 link_costOf(const Link_Session* session, const U8* frame);

/* Fills in the seal of a frame, on the assumption that it is genuine. `attempt`: 0 or 1. Returns 0
 * if a genuine frame cannot have a seal. */
int link_expect(Link_Session* session, const U8* frame, U32 attempt, Link_Seal* seal);

/* Acts upon an opened frame; `attempt` is the one that opened it. */
void link_onFrame(Link_Session* session, const U8* frame, U32 attempt);

/* Counts an expected frame that no key of the session could authenticate. A frame of the handshake
 * wipes the candidate instead. */
void link_onForgery(Link_Session* session, const U8* frame);

/* Polls handshake and liveness; ends a session that is silent or has lasted too long. Returns 1 if
 * there is a session. */
int link_pollSession(Link_Session* session);
