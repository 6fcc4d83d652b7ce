/* SPDX-License-Identifier: MIT
 *
 * x25519: agrees on a secret over a line that others hear (RFC 7748).
 *
 *     X25519(open, own, 0);           (`own`: 32 random bytes; `open` goes to the peer)
 *     X25519(secret, own, peerOpen);  (both sides get the same)
 *
 * Neither branches nor addresses depend on secrets, nor does the time of a multiplication of 16
 * bits on a Cortex-M3, whose multiplications of 32 bits into 64 end early. A call takes 480 bytes
 * of stack.
 */
#pragma once

#include "base.h"

#define X25519_BYTES 32U

/* Multiplies a point by a number, both of 32 bytes; `point` 0: the curve's base point. */
void X25519(U8* result, const U8* number, const U8* point);
