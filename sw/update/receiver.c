/* SPDX-License-Identifier: MIT
 *
 * receiver: writes an image into its slot. The slot's header is only written when all sectors of
 * the slot are empty. A header in flash therefore always belongs to the image that follows it, even
 * after a loss of power.
 */
#include "receiver.h"

#include <string.h>

#define CHUNK 256U /* largest number of bytes that are read or programmed at once */

static U32 slotAt(const Receiver* self) {
    return Slots_at(self->port->layout, self->slot);
}

static int isErased(const Receiver* self, U32 at, U32 bytes) {
    U8 chunk[CHUNK];
    U32 i, size;
    for (; bytes; at += size, bytes -= size) {
        size = bytes < CHUNK ? bytes : CHUNK;
        self->port->read(self->port->context, at, chunk, size);
        for (i = 0; i < size; ++i)
            if (chunk[i] != 0xFFU)
                return 0;
    }
    return 1;
}

static int holds(const Receiver* self, U32 at, const U8* data, U32 bytes) {
    U8 chunk[CHUNK];
    self->port->read(self->port->context, at, chunk, bytes);
    return memcmp(chunk, data, bytes) == 0;
}

/* Programs the bytes that are not in flash yet, and reads all bytes back. */
static int put(const Receiver* self, U32 at, const U8* data, U32 bytes) {
    const Slots_Port* port = self->port;
    U32 size;
    for (; bytes; at += size, data += size, bytes -= size) {
        size = CHUNK - at % CHUNK;
        if (size > bytes)
            size = bytes;
        if (!holds(self, at, data, size) &&
            !(port->program(port->context, at, data, size) && holds(self, at, data, size)))
            return 0;
    }
    return 1;
}

/* Returns 1 if the flash contains this header, and its image is neither ready nor abandoned. */
static int hasBegun(const Receiver* self, const Slots_Header* header) {
    return holds(self, slotAt(self), (const U8*)header, (U32)sizeof *header) &&
           isErased(self, slotAt(self) + SLOTS_READY, SLOTS_IMAGE_AT - SLOTS_READY) &&
           isErased(self, slotAt(self) + self->port->layout->readyAt, 4);
}

/* Continues the image with its header in flash. The last piece may have been written only in part,
 * so it must be sent again. */
static void takeUp(Receiver* self) {
    const U32 at = slotAt(self) + SLOTS_IMAGE_AT;
    self->received = (self->header.bytes - 1U) & ~(CHUNK - 1U);
    while (self->received && isErased(self, at + self->received, 4) &&
           isErased(self, at + self->received, CHUNK))
        self->received -= CHUNK;
    self->state = RECEIVER_RECEIVING;
}

static void end(Receiver* self, Receiver_Reason reason) {
    self->reason = reason;
    self->state = RECEIVER_IDLE;
}

/* Abandons the image. It must then be sent again, into an erased slot. */
static void spoil(Receiver* self, Receiver_Reason reason) {
    static const U8 never[4] = {0, 0, 0, 0};
    (void)self->port->program(self->port->context, slotAt(self) + self->port->layout->readyAt,
                              never, sizeof never);
    end(self, reason);
}

void Receiver_init(Receiver* self, const Slots_Port* port, U32 product, U32 running) {
    memset(self, 0, sizeof *self);
    self->port = port;
    self->product = product;
    self->running = running;
    self->slot = port->layout->hasGolden ? 1U : running ^ 1U;
    Slots_header(port, running, &self->header);
    self->version = self->header.version;
    self->confirmed = Slots_confirmed(port, product);
    self->isOnTrial = !Slots_is(port, running, SLOTS_CONFIRMED);
    Slots_header(port, self->slot, &self->header);
    if (self->slot == running || !Slots_fits(port, &self->header, self->slot, product))
        return;
    if (hasBegun(self, &self->header))
        takeUp(self);
    else if (Slots_is(port, self->slot, SLOTS_REFUSED))
        self->reason = RECEIVER_REFUSED;
    else if (Slots_is(port, self->slot, SLOTS_TRIED) &&
             !Slots_is(port, self->slot, SLOTS_CONFIRMED))
        self->reason = RECEIVER_WENT_BACK;
}

static Receiver_Reason prepareFor(Receiver* self, const Slots_Header* header) {
    self->header = *header;
    self->received = 0;
    self->reason = RECEIVER_OK;
    self->state = RECEIVER_PREPARING;
    return RECEIVER_OK;
}

/* Checks everything in a list of keys except its signatures. */
static Receiver_Reason looksAtKeys(const Receiver* self, const Slots_Header* list) {
    const Slots_Header* keys = Slots_keys(self->port);
    if (!self->port->mapped || list->magic != SLOTS_MAGIC ||
        memcmp(list->board, keys->board, sizeof list->board) != 0)
        return RECEIVER_FOREIGN;
    if (list->version <= keys->version)
        return RECEIVER_OLD;
    if (list->version != keys->version + 1U)
        return RECEIVER_NEEDS_OTHER;
    return self->counterpart && self->counterpart->isOnTrial ? RECEIVER_ON_TRIAL : RECEIVER_OK;
}

Receiver_Reason Receiver_begin(Receiver* self, const Slots_Header* header) {
    if (self->state != RECEIVER_IDLE && self->state != RECEIVER_RECEIVING)
        return RECEIVER_BUSY;
    if (self->isOnTrial)
        return RECEIVER_ON_TRIAL;
    if (header->product == SLOTS_KEYS) {
        const Receiver_Reason reason = looksAtKeys(self, header);
        return reason == RECEIVER_OK ? prepareFor(self, header) : reason;
    }
    if (!Slots_fits(self->port, header, self->slot, self->product))
        return RECEIVER_FOREIGN;
    if (header->version <= self->confirmed)
        return RECEIVER_OLD;
    if (header->needs && (!self->counterpart || self->counterpart->isOnTrial ||
                          self->counterpart->version < header->needs))
        return RECEIVER_NEEDS_OTHER;
    return prepareFor(self, header);
}

Receiver_Reason Receiver_write(Receiver* self, U32 offset, const U8* data, U32 bytes) {
    if (self->state != RECEIVER_RECEIVING)
        return RECEIVER_NOT_BEGUN;
    if (offset % 4U || bytes % 4U || offset > self->received || bytes > self->header.bytes - offset)
        return RECEIVER_MISPLACED;
    if (!put(self, self->header.base + offset, data, bytes)) {
        spoil(self, RECEIVER_FLASH);
        return RECEIVER_FLASH;
    }
    if (offset + bytes > self->received)
        self->received = offset + bytes;
    return RECEIVER_OK;
}

Receiver_Reason Receiver_finish(Receiver* self) {
    if (self->state != RECEIVER_RECEIVING || self->received != self->header.bytes)
        return RECEIVER_NOT_BEGUN;
    self->state = RECEIVER_CHECKING;
    return RECEIVER_OK;
}

Receiver_Reason Receiver_confirm(Receiver* self) {
    if (self->isOnTrial && !Slots_set(self->port, self->running, SLOTS_CONFIRMED))
        return RECEIVER_FLASH;
    self->isOnTrial = 0;
    if (self->confirmed < self->version)
        self->confirmed = self->version;
    return RECEIVER_OK;
}

/* Returns 1 if the running image is signed with a key of the new list, so that it can start
 * again. */
static int staysSigned(const Receiver* self, const Slots_Header* list) {
    Slots_Header header;
    if (self->port->layout->hasGolden && self->running == 0U)
        return 1;
    Slots_header(self->port, self->running, &header);
    return Slots_isSigned(self->port, list, &header);
}

/* Adds the list of keys at the first empty place. Places before it may contain a part of another
 * list, left by a loss of power. */
static Receiver_Reason addKeys(const Receiver* self) {
    static const U32 complete = SLOTS_TRUE;
    const Slots_Header* list = &self->header;
    U32 at = SLOTS_KEYS_AT, i;
    if (!staysSigned(self, list) || (self->counterpart && !staysSigned(self->counterpart, list)))
        return RECEIVER_NEEDS_OTHER;
    for (i = 0; i < SLOTS_LISTS; ++i, at += (U32)sizeof(Slots_Keys))
        if (isErased(self, at, (U32)sizeof(Slots_Keys)))
            return put(self, at, (const U8*)list, (U32)sizeof *list) &&
                           put(self, at + (U32)(sizeof(Slots_Keys) - sizeof complete),
                               (const U8*)&complete, (U32)sizeof complete)
                       ? RECEIVER_OK
                       : RECEIVER_FLASH;
    return RECEIVER_FLASH;
}

/* Checks the signature of the header, and whether the flash already contains a part of its
 * image. */
static void prepare(Receiver* self) {
    if (!Slots_isSigned(self->port, Slots_keys(self->port), &self->header))
        end(self, RECEIVER_UNSIGNED);
    else if (self->header.product == SLOTS_KEYS)
        end(self, addKeys(self));
    else if (hasBegun(self, &self->header))
        takeUp(self);
    else
        self->state = RECEIVER_ERASING;
}

/* Looks for the first sector in the slot that is not empty, and erases it. If all sectors are
 * empty, writes the header. The sector with the header is the first sector, so a partly erased
 * image has no header. */
static void erase(Receiver* self) {
    const Slots_Port* port = self->port;
    const U32 at = slotAt(self), size = port->layout->sectorBytes;
    U32 i;
    for (i = 0; i < SLOTS_IMAGE_AT + self->header.bytes; i += size)
        if (!isErased(self, at + i, size)) {
            if (!Slots_retire(port, self->slot) || !port->erase(port->context, at + i))
                end(self, RECEIVER_FLASH);
            return;
        }
    if (put(self, at, (const U8*)&self->header, (U32)sizeof self->header))
        self->state = RECEIVER_RECEIVING;
    else
        end(self, RECEIVER_FLASH);
}

static void check(Receiver* self) {
    if (!Slots_isWhole(self->port, self->slot, &self->header))
        spoil(self, RECEIVER_DAMAGED);
    else if (Slots_set(self->port, self->slot, SLOTS_READY))
        self->state = RECEIVER_READY;
    else
        end(self, RECEIVER_FLASH);
}

int Receiver_work(Receiver* self) {
    switch (self->state) {
    case RECEIVER_PREPARING:
        prepare(self);
        break;
    case RECEIVER_ERASING:
        erase(self);
        break;
    case RECEIVER_CHECKING:
        check(self);
        break;
    default:
        break;
    }
    return self->state == RECEIVER_ERASING;
}
