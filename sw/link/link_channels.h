/* SPDX-License-Identifier: MIT
 *
 * link_channels: records which channels are open. Both sides open and close them; a channel that
 * was closed here cannot be opened again until the peer has answered.
 */
#pragma once

#include "base.h"

/* Sets of channels, one bit each. */
typedef struct Link_Channels {
    U8 open;     /* channels on which messages may be sent */
    U8 closing;  /* channels that were closed here; the peer's closing has not arrived */
    U8 closeDue; /* closings of this side that are not queued yet */
} Link_Channels;

#define LINK_IS_OPEN(channels, channel) ((U32)(channels)->open >> (channel) & 1U)

/* Closes all channels without notifying the peer. */
#define LINK_RESET_CHANNELS(channels) \
    ((channels)->open = (channels)->closing = (channels)->closeDue = 0)

/* Returns whether a channel may be opened here: no closing is pending. */
#define LINK_MAY_OPEN(channels, channel) \
    (!(((channels)->closing | (channels)->closeDue) >> (channel) & 1))

/* Records that an opening has been queued here. */
#define LINK_OPEN(channels, channel) ((channels)->open = (U8)((channels)->open | 1U << (channel)))

/* Records that an open channel is closed here. `isQueued` is 1 if its closing is in the queue. */
void link_closeChannel(Link_Channels* channels, U32 channel, int isQueued);

/* Records that a closing that was due has been queued. */
#define LINK_NOTE_CLOSING(channels, channel) \
    ((channels)->closeDue = (U8)((channels)->closeDue ^ 1U << (channel)))

/* Records that the peer opened or closed a channel. Returns whether this changes anything here. */
int link_onPeersChannel(Link_Channels* channels, U32 channel, U32 isOpen);
