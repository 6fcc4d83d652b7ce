/* SPDX-License-Identifier: MIT
 *
 * link_codec_keyed: the codec of sessions with a key.
 */
#pragma once

#include "link_codec.h"

/* Codec that encrypts and authenticates each frame with Ascon-AEAD128. */
extern const Link_Codec link_codecKeyed;

/* Completes a frame: writes the header with the epoch and the length of the payload, encrypts the
 * payload, which is already in `frame`, and appends the tag. `number` is the number of the frame;
 * its lowest byte is byte 1 of the frame. `acked` is the number with its lowest byte in the first
 * payload byte of a PIGGYBACK. Returns the size of the frame, bytes. */
U32 link_encryptFrame(U8* frame, U32 header, const U8* key, U32 number, U32 acked);

/* Decrypts the payload of a complete frame in place and stores its length in the header. The frame
 * must have at least LINK_SECURE_OVERHEAD bytes. If the tag is wrong, wipes the payload and returns
 * 0. */
int link_decryptFrame(U8* frame, const U8* key, U32 number, U32 acked);
