/* SPDX-License-Identifier: MIT
 *
 * link_search: finds frames among the bytes from the radio, which arrive in portions of any size.
 * It keeps bytes until a frame is complete, opens the frame with the codec, and passes it to the
 * session.
 */
#pragma once

#include "link_session.h"

typedef struct Link_Search {
    Link_Session* session;
    U8 count; /* bytes kept */
    /* 1 if the last bytes did not belong to a frame; the next frame then needs confirmation */
    U8 outOfStep;
    U32 at;     /* time at which the last byte arrived, us */
    U32 paidAt; /* time at which the search budget is full again, us */
    U8 bytes[2U * LINK_MAX_FRAME];
} Link_Search;

/* Accepts bytes from the radio. */
void link_takeBytes(Link_Search* search, const U8* bytes, U32 size);

/* Drops an incomplete frame after a silence, and tries frames that had to wait for it. */
void link_pollSearch(Link_Search* search);
