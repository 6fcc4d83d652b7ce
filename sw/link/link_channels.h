/* SPDX-License-Identifier: MIT
 *
 * link_channels: records which channels are open. Both sides can open and close channels. A channel
 * that this side has closed cannot be opened again until the peer has answered.
 */
#pragma once

#include "base.h"

/* Sets of channels, one bit each. */
typedef struct Link_Channels {
    U8 open; /* channels on which messages may be sent */
    /* channels that this side has closed; the peer's closing has not arrived yet */
    U8 closing;
    U8 closeDue; /* channels that this side closes; their closing is not queued yet */
} Link_Channels;

#define LINK_IS_OPEN(channels, channel) ((U32)(channels)->open >> (channel) & 1U)

/* Closes all channels without notifying the peer. */
#define LINK_RESET_CHANNELS(channels) \
    ((channels)->open = (channels)->closing = (channels)->closeDue = 0)

/* Returns whether this side may open a channel: no closing of the channel is pending. */
#define LINK_MAY_OPEN(channels, channel) \
    (!(((channels)->closing | (channels)->closeDue) >> (channel) & 1))

/* Records that this side has queued the opening of a channel. */
#define LINK_OPEN(channels, channel) ((channels)->open = (U8)((channels)->open | 1U << (channel)))

/* Records that this side closes an open channel. `isQueued` is 1 if the fragment that closes the
 * channel is already in the queue. */
void link_closeChannel(Link_Channels* channels, U32 channel, int isQueued);

/* Records that the closing of a channel, for which the queue had no room before, is now in the
 * queue. */
#define LINK_NOTE_CLOSING(channels, channel) \
    ((channels)->closeDue = (U8)((channels)->closeDue ^ 1U << (channel)))

/* Records that the peer has opened or closed a channel. Returns whether the channel's state has
 * changed on this side. */
int link_onPeersChannel(Link_Channels* channels, U32 channel, U32 isOpen);
