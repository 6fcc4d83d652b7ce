/* SPDX-License-Identifier: MIT
 *
 * link_broadcast: encrypts and decrypts packets for all vehicles on the channel, with the group's
 * key.
 *
 *     byte 0        LINK_BROADCAST, with which no frame of a link begins
 *     1..4          number, the low byte first: quarters of a second since 2026 began
 *     5..12         salt, random: no nonce is used twice, even where a clock was set back
 *     13..          the message, encrypted
 *     last LINK_TAG tag
 *
 * Vehicles do not acknowledge the packet, so the ground sends several copies. A vehicle stores the
 * newest number that it has accepted, even without power, and accepts only newer numbers: so each
 * message is executed at most once. Without keys, the key is all zeros.
 */
#pragma once

#include "link_crypto.h"

#define LINK_BROADCAST 0x7EU
#define LINK_BROADCAST_HEAD 13U
#define LINK_BROADCAST_OVERHEAD (LINK_BROADCAST_HEAD + LINK_TAG)

/* Makes a packet around a message of `size` bytes; message and salt are already in place. Returns
 * the packet's size. */
U32 Link_sealBroadcast(U8* packet, U32 size, const U8* key, U32 number);

/* Decrypts the message in place. Returns its size; 0 if the packet is not newer than `newest`, or
 * not authentic. */
U32 Link_openBroadcast(U8* packet, U32 size, const U8* key, U32 newest);
#define LINK_BROADCAST_NUMBER(packet) link_get32((packet) + 1)
