/* SPDX-License-Identifier: MIT
 *
 * layer: the table of the link layer that this file is compiled with.
 */
#include "layer.h"

#ifdef LINK_SHRUNK
#define SENDS 2048U
#define TAKES 1024U
#define WINDOW 8U
static void initShrunk(Link* link, const Link_Port* port, void* context, U32 byteTimeUs16) {
    Link_initSmall(link, port, context, byteTimeUs16, SENDS, TAKES, WINDOW);
}
#define Link_init initShrunk
#define SIZE LINK_SIZE(SENDS, TAKES, WINDOW)
#else
#define TAKES LINK_MAX_MESSAGE
#define SIZE sizeof(Link)
#endif

#ifdef LINK_MINIMAL
#define Link_setKey 0
#endif

const Layer layer = {SIZE,         TAKES,      Link_init,        Link_setKey,       Link_start,
                     Link_stop,    Link_state, Link_openChannel, Link_closeChannel, Link_send,
                     Link_receive, Link_poll,  Link_deadline,    Link_statistics};
