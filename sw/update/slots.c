/* SPDX-License-Identifier: MIT
 *
 * slots: chooses the image that the boot loader starts, and checks the FPGA's bitstream when the
 * vehicle starts.
 */
#include "slots.h"

#include <string.h>

#define SYNC_WORD 0x665599AAU /* AA 99 55 66 (UG380, Table 5-6), with the low byte first */

const Slots_Layout slots_firmware = {0x20000U,   0x60000U, 0x20000U, SLOTS_READY,
                                     SLOTS_TRUE, 0xC000U,  0};
const Slots_Layout slots_fpga = {0x80000U,  0x80000U, 0x10000U, SLOTS_IMAGE_AT + SLOTS_SYNC_AT,
                                 SYNC_WORD, 0xFF000U, 1};

U32 Slots_at(const Slots_Layout* layout, U32 slot) {
    return layout->at + slot * layout->bytes;
}

void Slots_header(const Slots_Port* port, U32 slot, Slots_Header* header) {
    port->read(port->context, Slots_at(port->layout, slot), (U8*)header, (U32)sizeof *header);
}

static U32 stateAt(const Slots_Port* port, U32 slot, Slots_State state) {
    return Slots_at(port->layout, slot) +
           (state == SLOTS_READY ? port->layout->readyAt : (U32)state);
}

static U32 valueOf(const Slots_Port* port, Slots_State state) {
    return state == SLOTS_READY ? port->layout->ready : SLOTS_TRUE;
}

int Slots_is(const Slots_Port* port, U32 slot, Slots_State state) {
    U32 word;
    port->read(port->context, stateAt(port, slot, state), (U8*)&word, sizeof word);
    return word == valueOf(port, state);
}

int Slots_set(const Slots_Port* port, U32 slot, Slots_State state) {
    const U32 value = valueOf(port, state);
    return Slots_is(port, slot, state) || (port->program(port->context, stateAt(port, slot, state),
                                                         (const U8*)&value, sizeof value) &&
                                           Slots_is(port, slot, state));
}

const Slots_Header* Slots_keys(const Slots_Port* port) {
    U32 i, last = 0;
    for (i = 1; i < SLOTS_LISTS; ++i)
        if (port->keys[i].isComplete == SLOTS_TRUE)
            last = i;
    return &port->keys[last].list;
}

int Slots_fits(const Slots_Port* port, const Slots_Header* header, U32 slot, U32 product) {
    const Slots_Layout* layout = port->layout;
    return memcmp(header->board, port->keys->list.board, sizeof header->board) == 0 &&
           header->magic == SLOTS_MAGIC && header->product == product && header->version != 0U &&
           header->version != SLOTS_ERASED && header->bytes != 0U && header->bytes % 4U == 0U &&
           header->bytes <= layout->bytes - SLOTS_IMAGE_AT &&
           header->base == Slots_at(layout, slot) + SLOTS_IMAGE_AT;
}

int Slots_isSigned(const Slots_Port* port, const Slots_Header* keys, const Slots_Header* header) {
    U32 i;
    for (i = 0; i < SLOTS_DIGEST_BYTES; i += SLOTS_KEY_BYTES)
        if (port->isSigned(header->signature, (const U8*)header, (U32)SLOTS_SIGNED_BYTES,
                           keys->digest + i))
            return 1;
    return 0;
}

static int isWhole(const Slots_Port* port, U32 slot, const Slots_Header* header, Slots_Read read,
                   void* context) {
    U8 digest[SLOTS_DIGEST_BYTES];
    port->digest(read, context, Slots_at(port->layout, slot) + SLOTS_IMAGE_AT, header->bytes,
                 digest);
    return memcmp(digest, header->digest, sizeof digest) == 0;
}

int Slots_isWhole(const Slots_Port* port, U32 slot, const Slots_Header* header) {
    return isWhole(port, slot, header, port->read, port->context);
}

static int isSound(const Slots_Port* port, U32 slot, U32 product) {
    Slots_Header header;
    Slots_header(port, slot, &header);
    return Slots_fits(port, &header, slot, product) && Slots_is(port, slot, SLOTS_READY) &&
           Slots_isSigned(port, Slots_keys(port), &header) && Slots_isWhole(port, slot, &header);
}

/* Returns the highest version in the log. An entry is a version and its complement; an entry
 * without this property was cut off by a loss of power and is ignored. Sets `end` to the offset of
 * the first empty entry. */
static U32 readLog(const Slots_Port* port, U32* end) {
    U32 highest = 0, entry[2];
    for (*end = 0; *end < SLOTS_LOG_BYTES; *end += (U32)sizeof entry) {
        port->read(port->context, port->layout->logAt + *end, (U8*)entry, sizeof entry);
        if ((entry[0] & entry[1]) == SLOTS_ERASED)
            break;
        if (entry[0] == ~entry[1] && entry[0] > highest)
            highest = entry[0];
    }
    return highest;
}

U32 Slots_confirmed(const Slots_Port* port, U32 product) {
    U32 slot, end, highest = readLog(port, &end);
    for (slot = 0; slot < SLOTS_COUNT; ++slot) {
        Slots_Header header;
        Slots_header(port, slot, &header);
        if (Slots_fits(port, &header, slot, product) && Slots_is(port, slot, SLOTS_CONFIRMED) &&
            header.version > highest)
            highest = header.version;
    }
    return highest;
}

int Slots_retire(const Slots_Port* port, U32 slot) {
    static const U32 none = 0;
    Slots_Header header, other;
    U32 entry[2], end;
    if (!Slots_is(port, slot, SLOTS_READY))
        return 1;
    Slots_header(port, slot, &header);
    Slots_header(port, slot ^ 1U, &other);
    if (Slots_is(port, slot, SLOTS_CONFIRMED) &&
        (!Slots_is(port, slot ^ 1U, SLOTS_CONFIRMED) || other.version < header.version) &&
        readLog(port, &end) < header.version) {
        entry[0] = header.version;
        entry[1] = ~header.version;
        if (end == SLOTS_LOG_BYTES || !port->program(port->context, port->layout->logAt + end,
                                                     (const U8*)entry, sizeof entry))
            return 0;
    }
    return port->program(port->context, stateAt(port, slot, SLOTS_READY), (const U8*)&none,
                         sizeof none) &&
           !Slots_is(port, slot, SLOTS_READY);
}

static U32 versionOf(const Slots_Port* port, U32 slot) {
    Slots_Header header;
    Slots_header(port, slot, &header);
    return header.version;
}

U32 Slots_choose(const Slots_Port* port, U32 product, int mayTry) {
    const U32 confirmed = Slots_confirmed(port, product);
    const U32 newer = versionOf(port, 1) > versionOf(port, 0) ? 1U : 0U;
    U32 slot, i;
    for (i = 0; mayTry && i < SLOTS_COUNT; ++i) { /* new images */
        slot = newer ^ i;
        if (!Slots_is(port, slot, SLOTS_TRIED) && !Slots_is(port, slot, SLOTS_CONFIRMED) &&
            versionOf(port, slot) > confirmed && isSound(port, slot, product) &&
            Slots_set(port, slot, SLOTS_TRIED))
            return slot;
    }
    /* first pass: confirmed images; second pass: the others */
    for (i = 0; i < 2U * SLOTS_COUNT; ++i) {
        slot = newer ^ (i % SLOTS_COUNT);
        if ((i >= SLOTS_COUNT || Slots_is(port, slot, SLOTS_CONFIRMED)) &&
            isSound(port, slot, product))
            return slot;
    }
    return SLOTS_NONE;
}

/* Reads a bitstream as it was when it was signed: with an erased sync word. */
static void readUnready(void* context, U32 offset, U8* bytes, U32 count) {
    const Slots_Port* port = (const Slots_Port*)context;
    port->read(port->context, offset, bytes, count);
    if (offset % port->layout->bytes == SLOTS_IMAGE_AT)
        memset(bytes + SLOTS_SYNC_AT, 0xFF, sizeof port->layout->ready);
}

int Slots_isLoadable(const Slots_Port* port, U32 product) {
    const U32 slot = Slots_is(port, 1, SLOTS_READY) ? 1U : 0U;
    Slots_Header header;
    Slots_header(port, slot, &header);
    return Slots_fits(port, &header, slot, product) &&
           Slots_isSigned(port, slot ? Slots_keys(port) : &port->keys->list, &header) &&
           isWhole(port, slot, &header, readUnready, (void*)port);
}

int Slots_settleFpga(const Slots_Port* port, int isRefused) {
    if (!Slots_is(port, 1, SLOTS_READY))
        return 0;
    if (isRefused)
        return Slots_set(port, 1, SLOTS_REFUSED) && Slots_retire(port, 1);
    if (Slots_is(port, 1, SLOTS_CONFIRMED))
        return 0;
    return Slots_is(port, 1, SLOTS_TRIED) ? Slots_retire(port, 1) : Slots_set(port, 1, SLOTS_TRIED);
}
