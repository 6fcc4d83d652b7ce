/* SPDX-License-Identifier: MIT
 *
 * link_input: keeps bytes until a frame is whole, and gives each good frame to its part.
 */
#pragma once

#include "link_session.h"

typedef struct Link_Input {
    Link_Output* output;
    Link_Session* session;
    U8 count;     /* bytes kept */
    U8 outOfStep; /* the last bytes were no frame: the next frame needs confirmation */
    U32 at;       /* time of the last byte */
    U32 paidAt;   /* when the rounds that the search has computed are paid for */
    U8 bytes[2U * LINK_MAX_FRAME];
} Link_Input;

/* Takes bytes from the radio. */
void link_takeBytes(Link_Input* input, const U8* bytes, U32 size);
/* Drops half a frame behind which silence has come. */
void link_pollInput(Link_Input* input);

/* For the codecs: */

/* True if a header makes sense: most garbage fails here, before the checksum. */
/* True if a frame, none of the handshake, has the epoch of a session's key. */
int link_isOfEpoch(const U8* frame, U32 key);
int link_isPlausible(const Link_Output* output, const U8* frame);
/* Acts upon a good frame of `size` bytes, whose header has the payload's length. */
void link_accept(Link_Input* input, const U8* frame, U32 size);
/* Counts a byte where no frame begins. */
void link_skip(Link_Input* input, const U8* frame, U32 left);
