/* SPDX-License-Identifier: MIT
 *
 * link_codec_clear: the codec of sessions without a key.
 */
#pragma once

#include "link_codec.h"

/* Codec that ends each frame with a CRC. The seed of the CRC depends on the session. */
extern const Link_Codec link_codecClear;
