/* SPDX-License-Identifier: MIT
 *
 * link_codec_clear: protects frames with a CRC.
 */
#include "link_codec_clear.h"

static U32 seal(U8* frame, U32 header, const Link_Seal* with) {
    return link_seal(frame, header, with->session);
}

static const U8* open(const U8* frame, U8* copy, const Link_Seal* with) {
    (void)copy;
    return link_crc(with->session, frame, LINK_LENGTH(frame) + LINK_OVERHEAD) == 0 ? frame : 0;
}

const Link_Codec link_codecClear = {LINK_OVERHEAD,      4U,   LINK_CHECK, 0,
                                    {1, 4, 8, 0, 0, 0}, seal, open};
