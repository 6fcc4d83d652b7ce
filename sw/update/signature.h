/* SPDX-License-Identifier: MIT
 *
 * signature: Ed25519 and SHA-512 by libsodium, as functions of a Slots_Port.
 */
#pragma once

#include "slots.h"

/* Returns 1 if the owner of the public key (32 bytes) has signed the message (signature: 64 bytes).
 * Takes 3.5 KB of stack. */
int Signature_isGood(const U8* signature, const U8* message, U32 bytes, const U8* key);
/* Writes the digest, 64 bytes, of `bytes` bytes that `read` reads at `offset`. */
void Signature_digest(Slots_Read read, void* context, U32 offset, U32 bytes, U8* digest);
