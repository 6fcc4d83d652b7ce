/* SPDX-License-Identifier: MIT
 *
 * loader: the boot loader in flash sectors 0 and 1, which starts the firmware in one of the slots.
 * It also offers functions to this firmware (docs/firmware.md).
 */
#pragma once

#include "slots.h"

#define LOADER_MAGIC 0x1CE50C06UL

/* Functions of libsodium that the loader contains, so that images need not contain these functions.
 * The table follows the loader's vector table. */
typedef struct Loader_Services {
    U32 magic;
    int (*isSigned)(const U8* signature, const U8* message, U32 bytes, const U8* key);
    void (*digest)(Slots_Read read, void* context, U32 offset, U32 bytes, U8* digest);
} Loader_Services;
#define LOADER_KEYS ((const Slots_Keys*)(0x08000000UL + SLOTS_KEYS_AT))
#define LOADER_SERVICES ((const Loader_Services*)0x08000040UL)

/* Returns the slots of the firmware, and sets `running` to the slot of the running firmware.
 * Returns 0 if the firmware was started without a loader. */
const Slots_Port* Loader_slots(U32* running);
