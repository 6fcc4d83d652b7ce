/* SPDX-License-Identifier: MIT
 *
 * link_codec_keyed: the codec of sessions under a key.
 */
#pragma once

#include "link_codec.h"

/* Encrypts and authenticates each frame by Ascon-AEAD128. */
extern const Link_Codec link_codecKeyed;

/* Writes the header with its epoch and the payload's length, encrypts the payload that `frame`
 * already holds, and appends the tag. `number` has byte 1 as its lowest byte; `acked` is the first
 * byte of the payload of a PIGGYBACK. Returns the frame's size in bytes. */
U32 link_encryptFrame(U8* frame, U32 header, const U8* key, U32 number, U32 acked);

/* Decrypts the payload of a complete frame, of at least LINK_SECURE_OVERHEAD bytes, in place, and
 * stores the payload's length in its header. Returns 0 if the tag is wrong; the payload is then
 * wiped. */
int link_decryptFrame(U8* frame, const U8* key, U32 number, U32 acked);
