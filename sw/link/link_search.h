/* SPDX-License-Identifier: MIT
 *
 * link_search: finds frames in the bytes from the radio, which come in any portions. It keeps bytes
 * until a frame is whole, has the codec open it, and gives it to the session.
 */
#pragma once

#include "link_session.h"

typedef struct Link_Search {
    Link_Session* session;
    U8 count;     /* bytes kept */
    U8 outOfStep; /* 1: the last bytes were not a frame, so the next frame needs confirmation */
    U32 at;       /* time of the last byte, us */
    U32 paidAt;   /* time at which the search budget is full again, us */
    U8 bytes[2U * LINK_MAX_FRAME];
} Link_Search;

/* Takes bytes from the radio. */
void link_takeBytes(Link_Search* search, const U8* bytes, U32 size);

/* Drops half a frame after a silence. */
void link_pollSearch(Link_Search* search);
