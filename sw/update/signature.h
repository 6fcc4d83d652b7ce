/* SPDX-License-Identifier: MIT
 *
 * signature: verifies Ed25519 signatures and computes SHA-512 digests with libsodium, for a
 * Slots_Port.
 */
#pragma once

#include "slots.h"

/* Returns 1 if the signature (64 bytes) of the message is valid for the public key (32 bytes).
 * Takes 3.5 KB of stack. */
int Signature_isGood(const U8* signature, const U8* message, U32 bytes, const U8* key);
/* Writes the digest (64 bytes) of `bytes` bytes, which `read` returns from `offset` onwards. */
void Signature_digest(Slots_Read read, void* context, U32 offset, U32 bytes, U8* digest);
