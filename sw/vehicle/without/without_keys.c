/* SPDX-License-Identifier: MIT
 *
 * without_keys: functions for a vehicle without keys (ICESOC_KEYS=OFF); its links are not
 * encrypted. The vehicle starts only if it was explicitly opened (provision.h), so that a vehicle
 * that had a key never flies unprotected.
 */
#include "uav_keyring.h"
#include "uav_keys.h"

#include <string.h>

int UAV_provide(U32 address, const U8* key) {
    U32 word;
    if (key)
        return 0;
    for (word = 0; word < BACKUP_WORDS; ++word)
        if (word != BACKUP_AT(vehicle.flight))
            UAV_store(word, 0);
    UAV_store(BACKUP_AT(vehicle.address), address);
    UAV_store(BACKUP_AT(vehicle.keys.state), UAV_STATE_OPEN);
    return 1;
}

int UAV_readKey(int role, int slot, U8* key) {
    (void)role;
    (void)slot;
    memset(key, 0, LINK_KEY_BYTES);
    return 0;
}

void UAV_writeKey(int role, int slot, const U8* key) {
    (void)role;
    (void)slot;
    (void)key;
}

int UAV_isKey(const U8* key) {
    (void)key;
    return 0;
}

int UAV_countKeys(int role) {
    (void)role;
    return 0;
}

int UAV_isOpen(void) {
    return UAV_load(BACKUP_AT(vehicle.keys.state)) == UAV_STATE_OPEN;
}

U32 UAV_addressOf(int role) {
    if (role == UAV_GROUND)
        return UAV_GROUND_ADDRESS;
    return UAV_isOpen() ? ~UAV_load(UAV_ADDRESS_AT(role)) : UAV_NO_PEER;
}

int UAV_hasGroundsPart(void) {
    return UAV_address() < UAV_addressOf(UAV_VEHICLE);
}

int UAV_giveKeys(int role, Link* link) {
    (void)role;
    (void)link;
    return 0;
}

int UAV_confirmKey(int role, Link* link) {
    (void)role;
    (void)link;
    return 0;
}

int UAV_setNextKey(int role, Link* link, const U8* key) {
    (void)role;
    (void)link;
    (void)key;
    return 0;
}

void UAV_startKeyRing(Ice_ObjectAdapterPtr adapter) {
    (void)adapter;
}
