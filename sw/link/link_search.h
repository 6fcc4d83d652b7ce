/* SPDX-License-Identifier: MIT
 *
 * link_search: finds frames in the bytes from the radio, which arrive in pieces of any size. It
 * keeps bytes until a frame is complete, lets the codec decrypt it, and passes it to the session.
 */
#pragma once

#include "link_session.h"

typedef struct Link_Search {
    Link_Session* session;
    U8 count;     /* bytes kept */
    U8 outOfStep; /* 1 if the last bytes were not a frame; the next frame then needs confirmation */
    U32 at;       /* time at which the last byte arrived, us */
    U32 paidAt;   /* time at which the search budget is full again, us */
    U8 bytes[2U * LINK_MAX_FRAME];
} Link_Search;

/* Accepts bytes from the radio. */
void link_takeBytes(Link_Search* search, const U8* bytes, U32 size);

/* Drops an incomplete frame after a silence. */
void link_pollSearch(Link_Search* search);
