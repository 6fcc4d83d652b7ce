/* SPDX-License-Identifier: MIT
 *
 * uav_keys: stores the vehicle's keys in slots, and replaces the current key by the next one.
 */
#include "uav_keys.h"
#include "ascon.h"

#include <string.h>

#define SLOT_WORDS ((U32)(sizeof(Backup_Slot) / sizeof(U32)))
/* value of the state if both slots have a key: STATE_NEXT + number of the slot with the next key */
#define STATE_NEXT 0x4E455830U
#define CHECK_SEED 0x4B455931U

static int nextSlot[UAV_PEERS]; /* slot of the next key; -1 if there is only one key */

/* Returns the index of the first word of a slot. */
static U32 slotAt(int role, int slot) {
    return (U32)role * UAV_PEER_WORDS + (U32)slot * SLOT_WORDS;
}

/* Returns the check word of a key; it is never 0. The check word detects a key that was written
 * only in part because of a loss of power. It does not protect against attackers. */
static U32 checkOf(const U32* words) {
    U32 check = CHECK_SEED, i;
    for (i = 0; i < BACKUP_KEY_WORDS; ++i)
        check = (check ^ words[i]) * 0x01000193U + i;
    return check | 1U;
}

int UAV_readKey(int role, int slot, U8* key) {
    U32 from = slotAt(role, slot), words[BACKUP_KEY_WORDS], i;
    int isKey;
    for (i = 0; i < BACKUP_KEY_WORDS; ++i)
        words[i] = UAV_load(from + i);
    isKey = UAV_load(from + BACKUP_KEY_WORDS) == checkOf(words);
    for (i = 0; i < LINK_KEY_BYTES; ++i)
        key[i] = isKey ? (U8)(words[i / 4U] >> 8U * (i % 4U)) : 0;
    Ascon_wipe(words, sizeof words);
    return isKey;
}

void UAV_writeKey(int role, int slot, const U8* key) {
    U32 from = slotAt(role, slot), words[BACKUP_KEY_WORDS], i;
    memset(words, 0, sizeof words);
    for (i = 0; key && i < LINK_KEY_BYTES; ++i)
        words[i / 4U] |= (U32)key[i] << 8U * (i % 4U);
    for (i = 0; i < BACKUP_KEY_WORDS; ++i)
        UAV_store(from + i, words[i]);
    UAV_store(from + BACKUP_KEY_WORDS, key ? checkOf(words) : 0);
    Ascon_wipe(words, sizeof words);
}

int UAV_provide(U32 address, const U8* key) {
    U32 word;
    for (word = BACKUP_AT(others); word < BACKUP_WORDS; ++word)
        UAV_store(word, 0);
    UAV_store(BACKUP_AT(vehicle.address), address);
    UAV_store(BACKUP_AT(vehicle.keys.state), key ? 0 : UAV_STATE_OPEN);
    UAV_writeKey(UAV_GROUND, 1, 0);
    UAV_writeKey(UAV_GROUND, 0, key);
    return 1;
}

int UAV_countKeys(int role) {
    U8 key[LINK_KEY_BYTES];
    int count = UAV_readKey(role, 0, key) + UAV_readKey(role, 1, key);
    Ascon_wipe(key, sizeof key);
    return count;
}

int UAV_isKey(const U8* key) {
    U8 ours[LINK_KEY_BYTES];
    int slot, isOurs = 0;
    for (slot = 0; slot < (int)BACKUP_SLOTS; ++slot)
        isOurs |= UAV_readKey(UAV_GROUND, slot, ours) & Ascon_isSame(ours, key, sizeof ours);
    Ascon_wipe(ours, sizeof ours);
    return isOurs;
}

int UAV_isOpen(void) {
    return UAV_countKeys(UAV_GROUND) == 0 &&
           UAV_load(BACKUP_AT(vehicle.keys.state)) == UAV_STATE_OPEN;
}

U32 UAV_addressOf(int role) {
    if (role == UAV_GROUND)
        return UAV_GROUND_ADDRESS;
    return UAV_countKeys(role) || UAV_isOpen() ? ~UAV_load(UAV_ADDRESS_AT(role)) : UAV_NO_PEER;
}

int UAV_hasGroundsPart(void) {
    return UAV_address() < UAV_addressOf(UAV_VEHICLE);
}

/* Sets a key of a link. A session is bound to the address of the vehicle. A session between two
 * vehicles is bound to the address of the vehicle that does not act as the ground station. */
static void giveKey(int role, Link* link, int slot, const U8* key) {
    Link_setKey(link, slot, key,
                role == UAV_VEHICLE && UAV_hasGroundsPart()
                    ? LINK_GROUND | UAV_addressOf(UAV_VEHICLE)
                    : UAV_address());
}

int UAV_giveKeys(int role, Link* link) {
    U8 key[LINK_KEY_BYTES];
    int slot, count = 0;
    for (slot = 0; slot < (int)BACKUP_SLOTS; ++slot)
        if (UAV_readKey(role, slot, key)) {
            giveKey(role, link, slot, key);
            ++count;
        }
    Ascon_wipe(key, sizeof key);
    nextSlot[role] =
        count < (int)BACKUP_SLOTS ? -1 : (int)(UAV_load(UAV_STATE_AT(role)) - STATE_NEXT);
    return count;
}

int UAV_setNextKey(int role, Link* link, const U8* key) {
    U8 present[LINK_KEY_BYTES];
    int inUse = Link_keyInUse(link), slot = 1 - inUse, isSame;
    if (inUse < 0)
        return 0;
    isSame = UAV_readKey(role, inUse, present) && memcmp(present, key, sizeof present) == 0;
    Ascon_wipe(present, sizeof present);
    if (isSame)
        return 1;
    /* The slot is emptied first, then the state is written, then the key: as soon as both slots
     * have a key, the state must already contain the number of the slot with the next key. */
    UAV_writeKey(role, slot, 0);
    UAV_store(UAV_STATE_AT(role), STATE_NEXT + (U32)slot);
    UAV_writeKey(role, slot, key);
    giveKey(role, link, slot, key);
    nextSlot[role] = slot;
    return 1;
}

int UAV_confirmKey(int role, Link* link) {
    int slot = nextSlot[role];
    if (slot < 0 || Link_keyInUse(link) != slot)
        return 0;
    UAV_writeKey(role, 1 - slot, 0);
    giveKey(role, link, 1 - slot, 0);
    nextSlot[role] = -1;
    return 1;
}
