/* SPDX-License-Identifier: MIT
 *
 * receiver: takes a new image, firmware or bitstream, into the slot that is free for it, in steps.
 * Calls that take long (checks, erases) only ask for them; Receiver_work does them, in a task below
 * all that matters; all others leave the flash alone meanwhile.
 */
#ifndef RECEIVER_H
#define RECEIVER_H

#include "slots.h"

typedef enum Receiver_State {
    RECEIVER_IDLE,
    RECEIVER_PREPARING, /* checks the signature */
    RECEIVER_ERASING,
    RECEIVER_RECEIVING,
    RECEIVER_CHECKING, /* the whole image */
    RECEIVER_READY     /* starts at the next reset */
} Receiver_State;

typedef enum Receiver_Reason {
    RECEIVER_OK,
    RECEIVER_FOREIGN,   /* not for this product, or this slot, or no image at all */
    RECEIVER_OLD,       /* its version is not above the confirmed one */
    RECEIVER_UNSIGNED,  /* not signed with this vehicle's key */
    RECEIVER_DAMAGED,   /* what has arrived is not what was signed */
    RECEIVER_BUSY,      /* preparing, checking, or ready */
    RECEIVER_ON_TRIAL,  /* what runs must be confirmed before another comes */
    RECEIVER_NOT_BEGUN, /* nothing to write to, or not all is there yet */
    RECEIVER_MISPLACED, /* a piece behind a gap, not in words, or over the end */
    RECEIVER_FLASH,     /* the flash does not take it */
    RECEIVER_WENT_BACK, /* the image was tried and not confirmed */
    RECEIVER_REFUSED    /* the FPGA did not take the bitstream */
} Receiver_Reason;

typedef struct Receiver {
    const Slots_Port* port;
    U32 product;
    U32 running, slot;   /* the slot of what runs, and that which images come to */
    U32 version;         /* of what runs */
    U32 confirmed;       /* the highest version that was */
    int isOnTrial;       /* what runs is not confirmed */
    Slots_Header header; /* that was begun with */
    volatile Receiver_State state;
    Receiver_Reason reason; /* why the last update ended */
    U32 received;           /* bytes of the image, from its beginning */
} Receiver;

/* Looks what a start before this one has left. `running`: the slot of what runs, firmware or
 * bitstream. */
void Receiver_init(Receiver* self, const Slots_Port* port, U32 product, U32 running);
/* Begins, or goes on with, the image of this header: `received` says what is there already. */
Receiver_Reason Receiver_begin(Receiver* self, const Slots_Header* header);
/* Writes a piece of the image, a multiple of 4 bytes that begins at one, not behind a gap. */
Receiver_Reason Receiver_write(Receiver* self, U32 offset, const U8* data, U32 bytes);
/* Asks for the check of the whole image. */
Receiver_Reason Receiver_finish(Receiver* self);
/* Makes what runs the one to go back to. */
Receiver_Reason Receiver_confirm(Receiver* self);
/* Does a step: one signature, one sector, one digest. Returns 1 if there is more to do. */
int Receiver_work(Receiver* self);

#endif
