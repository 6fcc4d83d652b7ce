/* SPDX-License-Identifier: MIT
 *
 * link_channels: opens and closes channels.
 */
#include "link_channels.h"

void link_closeChannel(Link_Channels* channels, U32 channel, int isQueued) {
    U32 bit = 1U << channel;
    channels->open = (U8)(channels->open ^ bit);
    channels->closing = (U8)(channels->closing | bit);
    if (!isQueued)
        channels->closeDue = (U8)(channels->closeDue | bit);
}

int link_onPeersChannel(Link_Channels* channels, U32 channel, U32 isOpen) {
    U32 bit = 1U << channel;
    if (channels->closing & bit) {
        if (!isOpen)
            /* the peer has closed the channel as well */
            channels->closing = (U8)(channels->closing & ~bit);
        return 0;
    }
    if (isOpen == LINK_IS_OPEN(channels, channel))
        return 0;
    channels->open = (U8)(channels->open ^ bit);
    if (!isOpen)
        channels->closeDue = (U8)(channels->closeDue | bit);
    return 1;
}
