/* SPDX-License-Identifier: MIT
 *
 * link_codec_clear: the codec of sessions without a key.
 */
#pragma once

#include "link_codec.h"

/* Codec that ends each frame with a CRC; a value of the session is the CRC's seed. */
extern const Link_Codec link_codecClear;
