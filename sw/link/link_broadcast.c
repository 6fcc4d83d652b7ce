/* SPDX-License-Identifier: MIT
 *
 * link_broadcast: encrypts and authenticates a packet with Ascon-AEAD128. The nonce is the header
 * of the packet.
 */
#include "link_broadcast.h"

#include "ascon.h"

#include <string.h>

static void crypt(U8* packet, U32 size, const U8* key, int isDecryption, U8* tag) {
    U8 nonce[ASCON_NONCE_BYTES];
    /* pads the nonce with 0xFF; no nonce of a link ends with this byte */
    memset(nonce, 0xFF, sizeof nonce);
    memcpy(nonce, packet, LINK_BROADCAST_HEAD);
    link_cipher(key, nonce, packet + LINK_BROADCAST_HEAD, size, isDecryption, tag);
}

U32 Link_sealBroadcast(U8* packet, U32 size, const U8* key, U32 number) {
    U8 tag[ASCON_TAG_BYTES];
    packet[0] = LINK_BROADCAST;
    link_put32(packet + 1, number);
    crypt(packet, size, key, 0, tag);
    memcpy(packet + LINK_BROADCAST_HEAD + size, tag, LINK_TAG);
    return size + LINK_BROADCAST_OVERHEAD;
}

U32 Link_openBroadcast(U8* packet, U32 size, const U8* key, U32 newest) {
    U8 tag[ASCON_TAG_BYTES];
    if (size <= LINK_BROADCAST_OVERHEAD || packet[0] != LINK_BROADCAST ||
        LINK_BROADCAST_NUMBER(packet) <= newest)
        return 0;
    size -= LINK_BROADCAST_OVERHEAD;
    crypt(packet, size, key, 1, tag);
    return Ascon_isSame(tag, packet + LINK_BROADCAST_HEAD + size, LINK_TAG) ? size : 0;
}
