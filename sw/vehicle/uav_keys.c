/* SPDX-License-Identifier: MIT
 *
 * uav_keys: keeps keys in slots, and changes from one to the next.
 */
#include "uav_keys.h"
#include "ascon.h"
#include "link_broadcast.h"

#include <string.h>

#define SLOT_WORDS 5U
#define CHECK 4U     /* a slot's check: detects words that are not whole */
#define STATE_AT 10U /* a ground's state word, or nothing */
#define ADDRESS_AT 12U
#define GROUND_AT 11U                       /* another ground's address, inverted: 0 is none */
#define NEWEST_AT (at(UAV_GROUP, STATE_AT)) /* number of the newest call to all vehicles */
#define STATE_OPEN 0x4F50454EU
#define STATE_NEXT 0x4E455830U /* + slot of the next key, if both have one */
#define CHECK_SEED 0x4B455931U
#define KEY_WORDS (LINK_KEY_BYTES / 4U)

static const UAV_Board* board;
static void* boardContext;
static int nextSlot[UAV_GROUNDS]; /* slot of the next key; -1: there is one key */

void UAV_useBoard(const UAV_Board* ours, void* context) {
    board = ours;
    boardContext = context;
}

U32 UAV_random(void* unused) {
    (void)unused;
    return board->random(boardContext);
}

/* Returns the place of a ground's word. */
static U32 at(int ground, U32 word) {
    return (U32)ground * UAV_GROUND_WORDS + word;
}

static U32 load(U32 word) {
    return board->load(boardContext, word);
}

static void store(U32 word, U32 value) {
    board->store(boardContext, word, value);
}

/* Returns the check of a key: against lost power, not against attackers. Never 0. */
static U32 checkOf(const U32* words) {
    U32 check = CHECK_SEED, i;
    for (i = 0; i < KEY_WORDS; ++i)
        check = (check ^ words[i]) * 0x01000193U + i;
    return check | 1U;
}

int UAV_readKey(int ground, int slot, U8* key) {
    U32 from = at(ground, (U32)slot * SLOT_WORDS), words[KEY_WORDS], i;
    int isKey;
    for (i = 0; i < KEY_WORDS; ++i)
        words[i] = load(from + i);
    isKey = load(from + CHECK) == checkOf(words);
    for (i = 0; i < LINK_KEY_BYTES; ++i)
        key[i] = isKey ? (U8)(words[i / 4U] >> 8U * (i % 4U)) : 0;
    Ascon_wipe(words, sizeof words);
    return isKey;
}

/* Writes a slot; without a key, empties it. */
static void writeKey(int ground, int slot, const U8* key) {
    U32 from = at(ground, (U32)slot * SLOT_WORDS), words[KEY_WORDS], i;
    memset(words, 0, sizeof words);
    for (i = 0; key && i < LINK_KEY_BYTES; ++i)
        words[i / 4U] |= (U32)key[i] << 8U * (i % 4U);
    for (i = 0; i < KEY_WORDS; ++i)
        store(from + i, words[i]);
    store(from + CHECK, key ? checkOf(words) : 0);
    Ascon_wipe(words, sizeof words);
}

void UAV_provide(U32 address, const U8* key) {
    int ground;
    for (ground = UAV_SECOND; ground <= UAV_GROUP; ++ground)
        UAV_provideGround(ground, UAV_NO_GROUND, 0);
    store(NEWEST_AT, 0);
    store(ADDRESS_AT, address);
    store(STATE_AT, key ? 0 : STATE_OPEN);
    writeKey(0, 1, 0);
    writeKey(0, 0, key);
}

void UAV_provideGround(int ground, U32 address, const U8* key) {
    store(at(ground, GROUND_AT), 0);
    if (ground != UAV_GROUP) /* or a recorded call would be new again */
        store(at(ground, STATE_AT), 0);
    writeKey(ground, 1, 0);
    writeKey(ground, 0, key);
    store(at(ground, GROUND_AT), ~address);
}

U32 UAV_address(void) {
    return load(ADDRESS_AT);
}

U32 UAV_addressOf(int ground) {
    return UAV_countKeys(ground) || UAV_isOpen() ? ~load(at(ground, GROUND_AT)) : UAV_NO_GROUND;
}

/* Reads the group's key: zeros, as of any slot without a key, where the vehicle is open. */
static int readGroupKey(U8* key) {
    return UAV_readKey(UAV_GROUP, 0, key) || UAV_isOpen();
}

int UAV_isOfGroup(void) {
    U8 key[LINK_KEY_BYTES];
    int is = readGroupKey(key);
    Ascon_wipe(key, sizeof key);
    return is;
}

U32 UAV_openBroadcast(U8* packet, U32 size) {
    U8 key[LINK_KEY_BYTES];
    (void)readGroupKey(key);
    size = Link_openBroadcast(packet, size, key, load(NEWEST_AT));
    Ascon_wipe(key, sizeof key);
    if (size)
        store(NEWEST_AT, LINK_BROADCAST_NUMBER(packet));
    return size;
}

int UAV_hasGroundsPart(void) {
    return UAV_address() < UAV_addressOf(UAV_FELLOW);
}

/* Their sessions are bound to the address of the vehicle that has the vehicle's part. */
static void giveKey(int ground, Link* link, int slot, const U8* key) {
    Link_setKey(link, slot, key,
                ground == UAV_FELLOW && UAV_hasGroundsPart()
                    ? LINK_GROUND | UAV_addressOf(UAV_FELLOW)
                    : UAV_address());
}

int UAV_countKeys(int ground) {
    U8 key[LINK_KEY_BYTES];
    int count = UAV_readKey(ground, 0, key) + UAV_readKey(ground, 1, key);
    Ascon_wipe(key, sizeof key);
    return count;
}

int UAV_isKey(const U8* key) {
    U8 ours[LINK_KEY_BYTES];
    int slot, isOurs = 0;
    for (slot = 0; slot < UAV_KEY_SLOTS; ++slot)
        isOurs |= UAV_readKey(0, slot, ours) & Ascon_isSame(ours, key, sizeof ours);
    Ascon_wipe(ours, sizeof ours);
    return isOurs;
}

int UAV_isFlying(void) {
    return load(UAV_FLIGHT_WORD) == UAV_FLYING;
}

void UAV_setFlying(int isFlying) {
    store(UAV_FLIGHT_WORD, isFlying ? UAV_FLYING : 0);
}

int UAV_isOpen(void) {
    return UAV_countKeys(0) == 0 && load(STATE_AT) == STATE_OPEN;
}

int UAV_giveKeys(int ground, Link* link) {
    U8 key[LINK_KEY_BYTES];
    int slot, count = 0;
    for (slot = 0; slot < UAV_KEY_SLOTS; ++slot)
        if (UAV_readKey(ground, slot, key)) {
            giveKey(ground, link, slot, key);
            ++count;
        }
    Ascon_wipe(key, sizeof key);
    nextSlot[ground] = count < UAV_KEY_SLOTS ? -1 : (int)(load(at(ground, STATE_AT)) - STATE_NEXT);
    return count;
}

int UAV_setNextKey(int ground, Link* link, const U8* key) {
    U8 present[LINK_KEY_BYTES];
    int inUse = Link_keyInUse(link), slot = 1 - inUse, isSame;
    if (inUse < 0)
        return 0;
    isSame = UAV_readKey(ground, inUse, present) && memcmp(present, key, sizeof present) == 0;
    Ascon_wipe(present, sizeof present);
    if (isSame)
        return 1;
    /* The state comes first: where both slots have a key, it says which is the next one. */
    writeKey(ground, slot, 0);
    store(at(ground, STATE_AT), STATE_NEXT + (U32)slot);
    writeKey(ground, slot, key);
    giveKey(ground, link, slot, key);
    nextSlot[ground] = slot;
    return 1;
}

int UAV_confirmKey(int ground, Link* link) {
    int slot = nextSlot[ground];
    if (slot < 0 || Link_keyInUse(link) != slot)
        return 0;
    writeKey(ground, 1 - slot, 0);
    giveKey(ground, link, 1 - slot, 0);
    nextSlot[ground] = -1;
    return 1;
}
