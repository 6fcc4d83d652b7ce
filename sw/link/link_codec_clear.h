/* SPDX-License-Identifier: MIT
 *
 * link_codec_clear: the codec of sessions without a key.
 */
#pragma once

#include "link_codec.h"

/* Ends each frame with a CRC that the session's value seeds. */
extern const Link_Codec link_codecClear;
