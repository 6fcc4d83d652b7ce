/* SPDX-License-Identifier: MIT
 *
 * signature: calls libsodium. On the host, Debian's library is linked; the firmware is built from
 * the same sources.
 */
#include "signature.h"

#include <sodium/crypto_hash_sha512.h>
#include <sodium/crypto_sign_ed25519.h>

int Signature_isGood(const U8* signature, const U8* message, U32 bytes, const U8* key) {
    return crypto_sign_ed25519_verify_detached(signature, message, bytes, key) == 0;
}

void Signature_digest(Slots_Read read, void* context, U32 offset, U32 bytes, U8* digest) {
    crypto_hash_sha512_state state;
    U8 part[256];
    U32 size;
    (void)crypto_hash_sha512_init(&state);
    for (; bytes; offset += size, bytes -= size) {
        size = bytes < sizeof part ? bytes : (U32)sizeof part;
        read(context, offset, part, size);
        (void)crypto_hash_sha512_update(&state, part, size);
    }
    (void)crypto_hash_sha512_final(&state, digest);
}
