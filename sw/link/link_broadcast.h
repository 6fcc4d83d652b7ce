/* SPDX-License-Identifier: MIT
 *
 * link_broadcast: encrypts and decrypts packets for all vehicles on the channel, with the group's
 * key.
 *
 *     byte 0        LINK_BROADCAST, with which no frame of a link begins
 *     1..4          number, the low byte first: quarters of a second since the start of 2026
 *     5..12         salt: random, so that no nonce is used twice, even if a clock is set back
 *     13..          the message, encrypted
 *     last LINK_TAG tag
 *
 * Vehicles do not acknowledge the packet, so the ground station sends several copies. A vehicle
 * stores the newest number that it has accepted in memory that keeps it without power, and accepts
 * only newer numbers. Each message is therefore executed at most once. Without keys, a key of zeros
 * is used.
 */
#pragma once

#include "link_crypto.h"

#define LINK_BROADCAST 0x7EU
#define LINK_BROADCAST_HEAD 13U
#define LINK_BROADCAST_OVERHEAD (LINK_BROADCAST_HEAD + LINK_TAG)

/* Makes a packet from a message of `size` bytes; the message and the salt are already in the
 * packet. Returns the packet's size. */
U32 Link_sealBroadcast(U8* packet, U32 size, const U8* key, U32 number);

/* Decrypts the message in place. Returns the message's size; 0 if the packet is not authentic, or
 * if its number is not newer than `newest`. */
U32 Link_openBroadcast(U8* packet, U32 size, const U8* key, U32 newest);
#define LINK_BROADCAST_NUMBER(packet) link_get32((packet) + 1)
