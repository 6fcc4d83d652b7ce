/* SPDX-License-Identifier: MIT
 *
 * sodium_rest: the few functions of libsodium's other files that signature checks need.
 */
#include <sodium/crypto_hash_sha512.h>
#include <sodium/utils.h>

void _crypto_sign_ed25519_ref10_hinit(crypto_hash_sha512_state* state, int prehashed);

void _crypto_sign_ed25519_ref10_hinit(crypto_hash_sha512_state* state, int prehashed) {
    (void)prehashed;
    (void)crypto_hash_sha512_init(state);
}

int sodium_memcmp(const void* a, const void* b, size_t bytes) {
    const volatile unsigned char* x = (const volatile unsigned char*)a;
    const volatile unsigned char* y = (const volatile unsigned char*)b;
    int difference = 0;
    while (bytes--)
        difference |= *x++ ^ *y++;
    return difference ? -1 : 0;
}

int sodium_is_zero(const unsigned char* bytes, const size_t count) {
    size_t i;
    unsigned all = 0;
    for (i = 0; i < count; ++i)
        all |= bytes[i];
    return all == 0;
}

/* libsodium calls this to wipe intermediate results; what is checked here is public. */
void sodium_memzero(void* const at, const size_t bytes) {
    (void)at;
    (void)bytes;
}
