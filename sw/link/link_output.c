/* SPDX-License-Identifier: MIT
 *
 * link_output: frames go out: checksum, pacing, counts.
 */
#include "link.h"

/* Characters of silence behind a frame that does not fill its packet: they send the packet off. */
#define SILENCE 4U

U32 link_slack(const Link* link) {
    return LINK_MAX_FRAME * link->byteTimeUs16 >> 4;
}

int link_sendFrame(Link* link, U8* frame, U32 header, U32 key) {
    U32 size = link_seal(frame, header, key);
    U32 silence = size < link->longest + LINK_OVERHEAD ? SILENCE : 0;
    if (link->port->transmit(link->context, frame, size) != 0)
        return 0;
    if (LINK_BEFORE(link->paceUntil, link->now))
        link->paceUntil = link->now;
    link->paceUntil += (size + silence) * link->byteTimeUs16 >> 4;
    ++link->statistics.framesSent;
    link->statistics.bytesSent += size;
    return 1;
}

int link_sendControl(Link* link, U8* frame, Link_Kind kind, U32 byte1, U32 size) {
    U32 header = LINK_CONTROL_HEADER(kind, byte1, size);
    U32 key = link->session.key;
    if (LINK_IS_HANDSHAKE(kind)) {
        header |= LINK_HEADER_OF(0U, 0U, LINK_FEATURES);
        key |= LINK_NO_SEED;
    }
    return link_sendFrame(link, frame, header, key);
}
