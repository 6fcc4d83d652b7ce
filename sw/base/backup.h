/* SPDX-License-Identifier: MIT
 *
 * backup: the layout of the data in the STM32's backup SRAM, which a battery preserves. The
 * firmware and the boot loader use the same layout. Vehicles in the field hold data in it, so it
 * must not change.
 */
#pragma once

#include "base.h"

#include <stddef.h>

#define BACKUP_KEY_WORDS 4U
#define BACKUP_SLOTS 2U /* slots for the keys of a peer: the current key and the next key */
#define BACKUP_OTHERS 3U
/* value of `flight` while the vehicle flies; any other value means that it is on the ground */
#define BACKUP_FLYING 0x464C5921U

typedef struct Backup_Slot {
    U32 key[BACKUP_KEY_WORDS];
    U32 check; /* checksum of the key; any other value marks the slot as empty */
} Backup_Slot;

typedef struct Backup_Keys {
    Backup_Slot slots[BACKUP_SLOTS];
    /* slot that contains the next key. For the first ground station, this word also stores whether
     * the vehicle accepts links without a key. For the group, this word stores the number of the
     * newest call to all vehicles instead. */
    U32 state;
} Backup_Keys;

/* Keys of the first ground station, and the vehicle's state. */
typedef struct Backup_Vehicle {
    Backup_Keys keys;
    U32 flight;  /* BACKUP_FLYING in flight; also read by the boot loader */
    U32 address; /* address (MY) of the vehicle's modem */
    U32 unused[3];
} Backup_Vehicle;

/* Keys of an observer, another vehicle, or the group. */
typedef struct Backup_Other {
    Backup_Keys keys;
    U32 inverted; /* inverted value of the address; 0 if the entry is unused */
    U32 unused[4];
} Backup_Other;

typedef struct Backup {
    Backup_Vehicle vehicle;
    Backup_Other others[BACKUP_OTHERS];
} Backup;

/* Offset of a member, in words. */
#define BACKUP_AT(member) ((U32)(offsetof(Backup, member) / sizeof(U32)))
#define BACKUP_WORDS ((U32)(sizeof(Backup) / sizeof(U32)))
