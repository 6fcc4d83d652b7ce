/* SPDX-License-Identifier: MIT
 *
 * receiver: takes a new image, firmware or bitstream, into the free slot, in steps. Calls that need
 * long work (checks, erases) only request it. Receiver_work does it, in a task of low priority;
 * meanwhile nothing else uses the flash.
 */
#pragma once

#include "slots.h"

typedef enum Receiver_State {
    RECEIVER_IDLE,
    RECEIVER_PREPARING, /* checks the signature */
    RECEIVER_ERASING,
    RECEIVER_RECEIVING,
    RECEIVER_CHECKING, /* the complete image is being checked */
    RECEIVER_READY     /* the image starts at the next reset */
} Receiver_State;

typedef enum Receiver_Reason {
    RECEIVER_OK,
    RECEIVER_FOREIGN,    /* another product, board or slot, or no image */
    RECEIVER_OLD,        /* its version is not above the confirmed one */
    RECEIVER_UNSIGNED,   /* not signed with one of this vehicle's keys */
    RECEIVER_DAMAGED,    /* the bytes differ from the signed ones */
    RECEIVER_BUSY,       /* preparing, checking, or ready */
    RECEIVER_ON_TRIAL,   /* the running image must be confirmed first */
    RECEIVER_NOT_BEGUN,  /* no update was begun, or bytes are missing */
    RECEIVER_MISPLACED,  /* a piece after a gap, unaligned, or beyond the end */
    RECEIVER_FLASH,      /* the flash could not be programmed */
    RECEIVER_WENT_BACK,  /* the image was tried and not confirmed */
    RECEIVER_REFUSED,    /* the FPGA did not take the bitstream */
    RECEIVER_NEEDS_OTHER /* the required counterpart is not confirmed; for keys: the previous list
                          * is missing, or the running image is signed with none of them */
} Receiver_Reason;

typedef struct Receiver {
    const Slots_Port* port;
    const struct Receiver* counterpart; /* receiver of the other kind of image, set by the owner; or
                                         * 0 */
    U32 product;
    U32 running, slot;   /* the slot that runs, and the slot for new images */
    U32 version;         /* version that runs */
    U32 confirmed;       /* highest confirmed version */
    int isOnTrial;       /* the running image is not confirmed */
    Slots_Header header; /* header of the current update */
    volatile Receiver_State state;
    Receiver_Reason reason; /* why the last update ended */
    U32 received;           /* bytes of the image, from its beginning */
} Receiver;

/* Restores the state that an earlier start left. `running`: the slot that runs, of firmware or
 * bitstream. */
void Receiver_init(Receiver* self, const Slots_Port* port, U32 product, U32 running);
/* Begins or continues the image of this header; `received` is the number of bytes already present.
 * A list of keys has no image: it is valid as soon as the state is idle again, without a reason. */
Receiver_Reason Receiver_begin(Receiver* self, const Slots_Header* header);
/* Writes a piece of the image, aligned to 4 bytes in offset and size, without a gap before it. */
Receiver_Reason Receiver_write(Receiver* self, U32 offset, const U8* data, U32 bytes);
/* Requests the check of the complete image. */
Receiver_Reason Receiver_finish(Receiver* self);
/* Confirms the running image: a failed update then reverts to it. */
Receiver_Reason Receiver_confirm(Receiver* self);
/* Does a step: one signature, one sector, one digest. Returns 1 if there is more to do. */
int Receiver_work(Receiver* self);
