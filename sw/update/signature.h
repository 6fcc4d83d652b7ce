/* SPDX-License-Identifier: MIT
 *
 * signature: Ed25519 and SHA-512 by libsodium, in the shape that Slots_Port wants.
 */
#ifndef SIGNATURE_H
#define SIGNATURE_H

#include "slots.h"

/* Returns 1 if the signature (64 bytes) of the message is by the owner of the public key (32). It
 * takes 3.5 KB of stack. */
int Signature_isGood(const U8* signature, const U8* message, U32 bytes, const U8* key);
/* Writes the digest, 64 bytes, of what `read` reads from an offset on. */
void Signature_digest(Slots_Read read, void* context, U32 offset, U32 bytes, U8* digest);

#endif
