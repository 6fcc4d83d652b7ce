/* SPDX-License-Identifier: MIT
 *
 * slots: the choice that the boot loader makes.
 */
#include "slots.h"

#include <string.h>

U32 Slots_at(U32 slot) {
    return SLOTS_AT + slot * SLOTS_BYTES;
}

const Slots_Header* Slots_header(const Slots_Port* port, U32 slot) {
    return (const Slots_Header*)(const void*)(port->flash + Slots_at(slot));
}

static U32 word(const Slots_Port* port, U32 slot, Slots_State state) {
    return *(const volatile U32*)(const void*)(port->flash + Slots_at(slot) + (U32)state);
}

int Slots_is(const Slots_Port* port, U32 slot, Slots_State state) {
    return word(port, slot, state) == SLOTS_TRUE;
}

int Slots_set(const Slots_Port* port, U32 slot, Slots_State state) {
    return Slots_is(port, slot, state) ||
           (port->program(port->context, Slots_at(slot) + (U32)state, SLOTS_TRUE) &&
            Slots_is(port, slot, state));
}

int Slots_fits(const Slots_Header* header, U32 slot, U32 product) {
    return header->magic == SLOTS_MAGIC && header->product == product && header->version != 0U &&
           header->version != SLOTS_ERASED && header->bytes != 0U && header->bytes % 4U == 0U &&
           header->bytes <= SLOTS_IMAGE_BYTES && header->base == Slots_at(slot) + SLOTS_IMAGE_AT;
}

int Slots_isSigned(const Slots_Port* port, const Slots_Header* header) {
    return port->isSigned(header->signature, (const U8*)header, (U32)SLOTS_SIGNED_BYTES,
                          port->flash + SLOTS_KEY_AT);
}

int Slots_isWhole(const Slots_Port* port, U32 slot) {
    const Slots_Header* header = Slots_header(port, slot);
    U8 digest[SLOTS_DIGEST_BYTES];
    port->digest(port->flash + header->base, header->bytes, digest);
    return memcmp(digest, header->digest, sizeof digest) == 0;
}

static int isSound(const Slots_Port* port, U32 slot, U32 product) {
    return Slots_fits(Slots_header(port, slot), slot, product) &&
           Slots_is(port, slot, SLOTS_READY) && Slots_isSigned(port, Slots_header(port, slot)) &&
           Slots_isWhole(port, slot);
}

U32 Slots_confirmed(const Slots_Port* port, U32 product) {
    U32 slot, highest = 0;
    for (slot = 0; slot < SLOTS_COUNT; ++slot) {
        const Slots_Header* header = Slots_header(port, slot);
        if (Slots_fits(header, slot, product) && Slots_is(port, slot, SLOTS_CONFIRMED) &&
            header->version > highest)
            highest = header->version;
    }
    return highest;
}

U32 Slots_choose(const Slots_Port* port, U32 product) {
    const U32 confirmed = Slots_confirmed(port, product);
    const U32 newer = Slots_header(port, 1)->version > Slots_header(port, 0)->version ? 1U : 0U;
    U32 slot, i;
    for (i = 0; i < SLOTS_COUNT; ++i) { /* new ones */
        slot = newer ^ i;
        if (!Slots_is(port, slot, SLOTS_TRIED) && !Slots_is(port, slot, SLOTS_CONFIRMED) &&
            Slots_header(port, slot)->version > confirmed && isSound(port, slot, product) &&
            Slots_set(port, slot, SLOTS_TRIED))
            return slot;
    }
    for (i = 0; i < 2U * SLOTS_COUNT; ++i) { /* confirmed ones first, then whatever runs */
        slot = newer ^ (i % SLOTS_COUNT);
        if ((i >= SLOTS_COUNT || Slots_is(port, slot, SLOTS_CONFIRMED)) &&
            isSound(port, slot, product))
            return slot;
    }
    return SLOTS_NONE;
}
