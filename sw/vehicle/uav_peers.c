/* SPDX-License-Identifier: MIT
 *
 * uav_peers: stores addresses and keys of the peers other than the first ground station, and
 * decrypts calls to all vehicles.
 */
#include "uav_peers.h"
#include "ascon.h"
#include "link_broadcast.h"
#include "uav_keys.h"

/* index of the word that stores the number of the newest call to all vehicles */
#define NEWEST UAV_STATE_AT(UAV_GROUP)

int UAV_providePeer(int role, U32 address, const U8* key) {
    UAV_store(UAV_ADDRESS_AT(role), 0);
    /* For the group, the number of the newest call is kept. Otherwise the vehicle would accept
     * calls again that an attacker has recorded. */
    if (role != UAV_GROUP)
        UAV_store(UAV_STATE_AT(role), 0);
    UAV_writeKey(role, 1, 0);
    UAV_writeKey(role, 0, key);
    UAV_store(UAV_ADDRESS_AT(role), ~address);
    return 1;
}

/* Reads the group's key. If the slot is empty, sets the key to zeros, and returns 0 if the vehicle
 * requires a key. */
static int readGroupKey(U8* key) {
    return UAV_readKey(UAV_GROUP, 0, key) || UAV_isOpen();
}

int UAV_isOfGroup(void) {
    U8 key[LINK_KEY_BYTES];
    int is = readGroupKey(key);
    Ascon_wipe(key, sizeof key);
    return is;
}

void UAV_setCallNumber(U32 number) {
    UAV_store(NEWEST, number);
}

U32 UAV_openBroadcast(U8* packet, U32 size) {
    const U32 newest = UAV_load(NEWEST);
    U8 key[LINK_KEY_BYTES];
    (void)readGroupKey(key);
    size = Link_openBroadcast(packet, size, key, newest);
    Ascon_wipe(key, sizeof key);
    if (!size ||
        LINK_BROADCAST_NUMBER(packet) - newest > (newest ? UAV_MOST_AHEAD : UAV_FIRST_CALL))
        return 0;
    UAV_store(NEWEST, LINK_BROADCAST_NUMBER(packet));
    return size;
}
