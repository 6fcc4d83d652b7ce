/* SPDX-License-Identifier: MIT
 *
 * x25519: agrees on a shared secret over a line that others can read (RFC 7748).
 *
 *     X25519(open, own, 0);           (`own`: 32 random bytes; `open` is sent to the peer)
 *     X25519(secret, own, peerOpen);  (both sides get the same secret)
 *
 * Neither branches nor addresses depend on secrets, nor does the time of a 16-bit multiplication on
 * a Cortex-M3 (32-bit multiplications into 64 bits end early). A call takes 480 bytes of stack.
 */
#pragma once

#include "base.h"

#define X25519_BYTES 32U

/* Multiplies a point by a number, both of 32 bytes; `point` 0: the curve's base point. */
void X25519(U8* result, const U8* number, const U8* point);
