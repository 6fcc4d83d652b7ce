/* SPDX-License-Identifier: MIT
 *
 * crypto_arm: what a key costs the Cortex-M3, for bench_crypto: a breakpoint before and behind
 * each.
 */
#include "link.h"

extern void stack_top(void);
extern U32 data_begin[], data_end[], data_load[], bss_begin[], bss_end[];

void Reset_Handler(void);
__attribute__((section(".vectors"), used)) static void (*const vectors[2])(void) = {stack_top,
                                                                                    Reset_Handler};

#define MARK __asm__ volatile("bkpt #1" ::: "memory")

U32 isGood; /* all tags were right */

void Reset_Handler(void) {
    static U8 frame[LINK_MAX_FRAME];
    static const U8 key[LINK_KEY_BYTES] = {1}, nonces[2U * LINK_NONCE_BYTES] = {2};
    Link_Keys keys;
    U32* to;
    for (to = bss_begin; to < bss_end;)
        *to++ = 0;
    MARK;
    (void)link_protect(frame, LINK_MAX_ENCRYPTED - LINK_SECURE_OVERHEAD, key, 7, 0);
    MARK;
    isGood = (U32)link_unprotect(frame, key, 7, 0);
    MARK;
    (void)link_protect(frame, LINK_CONTROL_HEADER(LINK_KIND_ACK, 7U, 1U), key, 7, 0);
    MARK;
    isGood &= (U32)link_unprotect(frame, key, 7, 0);
    MARK;
    link_deriveKeys(key, nonces, nonces + LINK_NONCE_BYTES, &keys);
    MARK;
}
