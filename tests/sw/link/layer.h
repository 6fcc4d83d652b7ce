/* SPDX-License-Identifier: MIT
 *
 * layer: a table of the functions and sizes of a link layer. With such tables, one test can connect
 * layers that were compiled with different options.
 */
#pragma once

#ifdef LINK_MINIMAL
#include "link_minimal.h"
#else
#include "link.h"
#endif

typedef struct Layer {
    U32 size;       /* size of a Link and its buffers, bytes; the Link comes first */
    U32 maxMessage; /* size of the largest message that can be received, bytes */
    void (*init)(Link* link, const Link_Port* port, void* context, U32 byteTimeUs16);
    void (*setKey)(Link* link, int slot, const U8* key, U32 side);
    void (*start)(Link* link, U32 nowUs);
    void (*stop)(Link* link, U32 nowUs);
    Link_State (*state)(const Link* link);
    Link_Status (*openChannel)(Link* link, int channel);
    Link_Status (*closeChannel)(Link* link, int channel);
    Link_Status (*send)(Link* link, int channel, const U8* data, U32 size, U32 tag);
    void (*receive)(Link* link, const U8* bytes, U32 size, U32 nowUs);
    void (*poll)(Link* link, U32 nowUs);
    U32 (*deadline)(const Link* link, U32 nowUs);
    const Link_Statistics* (*statistics)(const Link* link);
} Layer;

/* The table of the layer with which this file is compiled. */
extern const Layer layer;
