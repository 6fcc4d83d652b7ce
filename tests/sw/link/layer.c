/* SPDX-License-Identifier: MIT
 *
 * layer: defines the table (layer.h) of the link layer with which this file is compiled.
 */
#include "layer.h"

#ifdef LINK_MINIMAL
#define Link_setKey 0
#define TAKES LINK_MAX_MESSAGE

typedef struct Whole {
    Link link;
} Whole;

static void init(Link* link, const Link_Port* port, void* context, U32 byteTimeUs16) {
    Link_Config config;
    config.port = port;
    config.context = context;
    config.byteTimeUs16 = byteTimeUs16;
    Link_init(link, &config);
}
#else
#ifdef LINK_SHRUNK /* uses smaller buffers than the layer allows */
#define SENDS 2048U
#define TAKES 1024U
#define WINDOW 8U
#else
#define SENDS LINK_SEND_BYTES
#define TAKES LINK_MAX_MESSAGE
#define WINDOW LINK_WINDOW
#endif

/* A link together with its buffers. */
typedef struct Whole {
    Link link;
    LINK_BUFFERS(SENDS, TAKES, WINDOW) buffers;
} Whole;

static void init(Link* link, const Link_Port* port, void* context, U32 byteTimeUs16) {
    Whole* whole = (Whole*)(void*)link;
    Link_Config config;
    config.port = port;
    config.context = context;
    config.byteTimeUs16 = byteTimeUs16;
    config.send = whole->buffers.send;
    config.sendBytes = SENDS;
    config.message = whole->buffers.message;
    config.maxMessage = TAKES;
    config.fragments = whole->buffers.fragments;
    config.slots = whole->buffers.slots;
    config.window = WINDOW;
    Link_init(link, &config);
}
#endif

const Layer layer = {sizeof(Whole),     TAKES,          init,         Link_setKey,
                     Link_start,        Link_stop,      Link_state,   Link_openChannel,
                     Link_closeChannel, Link_send,      Link_receive, Link_poll,
                     Link_deadline,     Link_statistics};
