/* SPDX-License-Identifier: MIT
 *
 * receiver: how an image gets into its slot. The slot's header is written when its sectors are
 * empty, so a header in flash says what the bytes behind it are of, also after a loss of power.
 */
#include "receiver.h"

#include <string.h>

U32 Receiver_slot(const Receiver* self) {
    return self->running ^ 1U;
}

static const U8* slotBytes(const Receiver* self) {
    return self->port->flash + Slots_at(Receiver_slot(self));
}

static U32 wordAt(const U8* bytes) {
    return (U32)bytes[0] | (U32)bytes[1] << 8 | (U32)bytes[2] << 16 | (U32)bytes[3] << 24;
}

static int isErased(const U8* from, U32 bytes) {
    while (bytes && wordAt(from) == SLOTS_ERASED) {
        from += 4;
        bytes -= 4;
    }
    return bytes == 0;
}

/* Programs words, and reads them back. */
static int put(const Receiver* self, U32 at, const U8* data, U32 bytes) {
    const Slots_Port* port = self->port;
    U32 i;
    for (i = 0; i < bytes; i += 4)
        if (wordAt(port->flash + at + i) != wordAt(data + i) &&
            !port->program(port->context, at + i, wordAt(data + i)))
            return 0;
    return memcmp(port->flash + at, data, bytes) == 0;
}

/* Returns 1 if this header is in flash, and nothing has come behind the image. */
static int hasBegun(const Receiver* self, const Slots_Header* header) {
    return memcmp(slotBytes(self), header, sizeof *header) == 0 &&
           isErased(slotBytes(self) + SLOTS_READY, SLOTS_IMAGE_AT - SLOTS_READY);
}

/* Takes up the image whose header is in flash. Its last word may be half written; it comes again.
 */
static void takeUp(Receiver* self) {
    const U8* image = slotBytes(self) + SLOTS_IMAGE_AT;
    self->received = self->header.bytes;
    while (self->received && wordAt(image + self->received - 4U) == SLOTS_ERASED)
        self->received -= 4U;
    if (self->received)
        self->received -= 4U;
    self->state = RECEIVER_RECEIVING;
}

static void end(Receiver* self, Receiver_Reason reason) {
    self->reason = reason;
    self->state = RECEIVER_IDLE;
}

/* Gives the image up: it must be sent anew, to an erased slot. */
static void spoil(Receiver* self, Receiver_Reason reason) {
    (void)self->port->program(self->port->context, Slots_at(Receiver_slot(self)) + SLOTS_READY, 0);
    end(self, reason);
}

void Receiver_init(Receiver* self, const Slots_Port* port, U32 product, U32 running) {
    const U32 slot = running ^ 1U;
    memset(self, 0, sizeof *self);
    self->port = port;
    self->product = product;
    self->running = running;
    self->header = *Slots_header(port, slot);
    if (!Slots_fits(&self->header, slot, product))
        return;
    if (hasBegun(self, &self->header))
        takeUp(self);
    else if (Slots_is(port, slot, SLOTS_TRIED) && !Slots_is(port, slot, SLOTS_CONFIRMED))
        self->reason = RECEIVER_WENT_BACK;
}

int Receiver_isOnTrial(const Receiver* self) {
    return !Slots_is(self->port, self->running, SLOTS_CONFIRMED);
}

Receiver_Reason Receiver_begin(Receiver* self, const Slots_Header* header) {
    if (self->state != RECEIVER_IDLE && self->state != RECEIVER_RECEIVING)
        return RECEIVER_BUSY;
    if (Receiver_isOnTrial(self))
        return RECEIVER_ON_TRIAL;
    if (!Slots_fits(header, Receiver_slot(self), self->product))
        return RECEIVER_FOREIGN;
    if (header->version <= Slots_confirmed(self->port, self->product))
        return RECEIVER_OLD;
    self->header = *header;
    self->received = 0;
    self->reason = RECEIVER_OK;
    self->state = RECEIVER_PREPARING;
    return RECEIVER_OK;
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
    return Slots_set(self->port, self->running, SLOTS_CONFIRMED) ? RECEIVER_OK : RECEIVER_FLASH;
}

/* Checks that the header is signed, and looks whether its image is here in part. */
static void prepare(Receiver* self) {
    if (!Slots_isSigned(self->port, &self->header))
        end(self, RECEIVER_UNSIGNED);
    else if (hasBegun(self, &self->header))
        takeUp(self);
    else
        self->state = RECEIVER_ERASING;
}

/* Erases the first sector that the image needs and that is not empty; where all are, writes the
 * header. The header's own sector is the first, so that what is left of an image is none. */
static void erase(Receiver* self) {
    const U32 slot = Receiver_slot(self), end_ = SLOTS_IMAGE_AT + self->header.bytes;
    U32 i;
    for (i = 0; i * SLOTS_SECTOR_BYTES < end_; ++i)
        if (!isErased(slotBytes(self) + i * SLOTS_SECTOR_BYTES, SLOTS_SECTOR_BYTES)) {
            if (!self->port->erase(self->port->context,
                                   SLOTS_FIRST_SECTOR + slot * SLOTS_SECTORS + i))
                end(self, RECEIVER_FLASH);
            return;
        }
    if (put(self, Slots_at(slot), (const U8*)&self->header, (U32)sizeof self->header))
        self->state = RECEIVER_RECEIVING;
    else
        end(self, RECEIVER_FLASH);
}

static void check(Receiver* self) {
    if (!Slots_isWhole(self->port, Receiver_slot(self)))
        spoil(self, RECEIVER_DAMAGED);
    else if (Slots_set(self->port, Receiver_slot(self), SLOTS_READY))
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
