/* SPDX-License-Identifier: MIT
 *
 * x25519: agrees on a shared secret over a line that others can read (RFC 7748).
 *
 *     X25519(open, own, 0);           (`own`: 32 random bytes; send `open` to the peer)
 *     X25519(secret, own, peerOpen);  (both sides compute the same secret)
 *
 * Neither branches nor addresses depend on secrets. Only 16-bit multiplications are used; their
 * time is constant on a Cortex-M3; 32-bit multiplications with a 64-bit result end early for some
 * values. A call takes 480 bytes of stack.
 */
#pragma once

#include "base.h"

#define X25519_BYTES 32U

/* Multiplies a point by a number, both of 32 bytes. If `point` is 0, the base point of the curve is
 * used. */
void X25519(U8* result, const U8* number, const U8* point);
