/* SPDX-License-Identifier: MIT
 *
 * receiver: receives a new image (firmware or bitstream) into the free slot, in steps. A function
 * with work that takes long (a check, an erase) only requests this work. Receiver_work does the
 * work later, in a task of low priority; nothing else may use the flash while it runs.
 */
#pragma once

#include "slots.h"

typedef enum Receiver_State {
    RECEIVER_IDLE,
    RECEIVER_PREPARING, /* the signature is being checked */
    RECEIVER_ERASING,
    RECEIVER_RECEIVING,
    RECEIVER_CHECKING, /* the complete image is being checked */
    RECEIVER_READY     /* the image will start at the next reset */
} Receiver_State;

typedef enum Receiver_Reason {
    RECEIVER_OK,
    RECEIVER_FOREIGN,  /* the header is for another product, board or slot, or is malformed */
    RECEIVER_OLD,      /* the version is not higher than the confirmed one */
    RECEIVER_UNSIGNED, /* the image is not signed with one of this vehicle's keys */
    RECEIVER_DAMAGED,  /* the bytes of the image differ from the signed ones */
    /* the receiver is preparing or checking an image, or an image is ready to start */
    RECEIVER_BUSY,
    RECEIVER_ON_TRIAL,  /* the running image must be confirmed first */
    RECEIVER_NOT_BEGUN, /* no update was begun, or bytes of the image are missing */
    /* the piece does not follow the previous one, is not aligned, or exceeds the image */
    RECEIVER_MISPLACED,
    RECEIVER_FLASH,     /* the flash could not be programmed */
    RECEIVER_WENT_BACK, /* the new image was started but not confirmed */
    RECEIVER_REFUSED,   /* the FPGA did not start with the bitstream */
    /* the bitstream (or firmware) that the image needs is not confirmed; for keys: the previous
     * list is missing, or the running image is not signed with a key of the new list */
    RECEIVER_NEEDS_OTHER
} Receiver_Reason;

typedef struct Receiver {
    const Slots_Port* port;
    const struct Receiver*
        /* receiver of the other kind of image, set by the owner of this receiver; 0 if there is
         * none */
        counterpart;
    U32 product;
    U32 running, slot;   /* slot of the running image; slot for new images */
    U32 version;         /* version of the running image */
    U32 confirmed;       /* highest confirmed version */
    int isOnTrial;       /* 1: the running image is not confirmed yet */
    Slots_Header header; /* header of the current update */
    volatile Receiver_State state;
    Receiver_Reason reason; /* reason why the last update ended */
    U32 received;           /* number of bytes received so far, from the start of the image */
} Receiver;

/* Restores the state that the receiver had before the processor was restarted. `running` is the
 * slot of the running firmware or bitstream. */
void Receiver_init(Receiver* self, const Slots_Port* port, U32 product, U32 running);
/* Begins or continues the image with this header. Afterwards, `received` is the number of bytes
 * that are already in flash. A list of keys has no image: the list is valid when the state is idle
 * again and no reason of failure is set. */
Receiver_Reason Receiver_begin(Receiver* self, const Slots_Header* header);
/* Writes a piece of the image, which must directly follow the previous piece. Offset and size must
 * be multiples of 4 bytes. */
Receiver_Reason Receiver_write(Receiver* self, U32 offset, const U8* data, U32 bytes);
/* Requests the check of the complete image. */
Receiver_Reason Receiver_finish(Receiver* self);
/* Confirms the running image. If a later update fails, the vehicle returns to this image. */
Receiver_Reason Receiver_confirm(Receiver* self);
/* Does one step of the requested work: one signature, one sector or one digest. Returns 1 if more
 * steps remain. */
int Receiver_work(Receiver* self);
