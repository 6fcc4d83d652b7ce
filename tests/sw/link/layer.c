/* SPDX-License-Identifier: MIT
 *
 * layer: the table of the link layer that this file is compiled with.
 */
#include "layer.h"

#if !LINK_SECURE
#define Link_setKey 0
#endif

const Layer layer = {sizeof(Link),      LINK_MAX_MESSAGE, Link_init,    Link_setKey,
                     Link_start,        Link_stop,        Link_state,   Link_openChannel,
                     Link_closeChannel, Link_send,        Link_receive, Link_poll,
                     Link_deadline,     Link_statistics};
