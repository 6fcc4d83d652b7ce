/* SPDX-License-Identifier: MIT
 *
 * hw_core: functions and types that all servants generated from [":hw"] interfaces use
 * (docs/hw-mapping.md).
 *
 * A core has the registers of its interface in one slot. Each operation has a bit number, 0..15.
 * Calls of different operations may come from different tasks; calls of one operation must not
 * overlap.
 */
#pragma once

#include "base.h"

#define HW_OPERATIONS 16

typedef enum Hw_Status {
    HW_OK = 0,
    HW_WRONG_CORE, /* the slot contains another ID */
    HW_BUSY,       /* the operation is still running */
    HW_REFUSED,    /* the core refused the operation */
    HW_TIMEOUT,    /* the event did not arrive in time, and the core was reset */
    HW_UNALIGNED   /* the buffers do not begin at a multiple of their size */
} Hw_Status;

/* Buffers in DDR3 for frames, from the core that captures them to the core that processes them.
 * The servant of a camera core writes base, stride, width and height; the application sets the
 * other fields. */
typedef struct Hw_Frames {
    /* byte address of the first of three buffers, and the distance between buffers, bytes */
    U32 base, stride;
    /* size of a frame, pixels; width 0 means that no camera is running, and `picture` is the
     * frame */
    U32 width, height;
    /* byte addresses of a picture, and of its width and height, which are two values of 32 bits */
    U32 picture, pictureSize;
    void (*processed)(U32 findings); /* called for each frame that was processed */
} Hw_Frames;

/* Port between a core's servant and the system: functions that make the servant's task wait, and
 * resources that several servants share. On uC/OS-II a semaphore (OSSemPend, OSSemPost) is used for
 * waiting; one per operation is needed if several tasks call operations that take time. */
typedef struct Hw_Port {
    /* Waits until post is called for the operation, or until `ms` have passed. Returns 1 after a
     * post, and 0 after the time. A post before the wait is not lost. */
    int (*wait)(void* context, U32 operation, U32 ms);
    void (*post)(void* context, U32 operation);
    U32 (*nowMs)(void* context); /* milliseconds since any time; wraps */
    /* Returns the number of accesses that were not answered so far; the data of such reads is
     * not valid. */
    U32 (*busErrors)(void* context);
    Hw_Frames* frames; /* frames of the camera; 0 if no core of the program processes frames */
} Hw_Port;

#define HW_NEVER 0xFFFFFFFFU

typedef struct Hw_Core {
    U32 slot; /* 0..63 */
    U32 id;   /* expected value of the word ID */
    const Hw_Port* port;
    void* context;
    volatile U8 done[HW_OPERATIONS];  /* set by the interrupt routine when an operation has ended */
    U32 memory;                       /* DDR3 byte address of the buffers */
    volatile U8 later[HW_OPERATIONS]; /* operations that the polling task must answer */
    U32 deadline[HW_OPERATIONS];      /* deadlines of these operations, ms */
} Hw_Core;

/* Initialises a core: resets the core, and clears and enables its events. `id` is the expected
 * value of word ID; if it differs, returns HW_WRONG_CORE. */
Hw_Status Hw_Core_init(Hw_Core* self, U32 slot, U32 id, const Hw_Port* port, void* context);
/* Handles the slot's events while its interrupt line is high; called by the interrupt routine or
 * a task. */
void Hw_Core_interrupt(Hw_Core* self);

/* Access a word on `page` of a slot with more than 16 words. The register PAGE is restored
 * afterwards, so an interrupted task continues correctly. Tasks of equal priority that share
 * time must not use these functions. */
U32 Hw_Core_read(const Hw_Core* self, U32 word, U32 page);
void Hw_Core_write(const Hw_Core* self, U32 word, U32 page, U32 value);

/* Steps of an operation, for generated servants. ready: returns HW_OK if parameters may be written.
 * act: starts the operation. run: starts the operation and waits for its event, for at most
 * `ms`. */
Hw_Status Hw_Core_ready(const Hw_Core* self, U32 operation);
void Hw_Core_act(const Hw_Core* self, U32 operation);
/* Returns 1 if the core responds, which shows that all earlier accesses have been carried out; 0
 * if the core's clock is stopped. */
int Hw_Core_answers(const Hw_Core* self);
Hw_Status Hw_Core_run(Hw_Core* self, U32 operation, U32 ms);

/* Steps of an operation that is answered later. begin: starts the operation and its time. later:
 * leaves the reply to the polling task. ended: if the operation has ended, returns 1 and the
 * status; otherwise returns 0 and reduces `next` to the time left. */
void Hw_Core_begin(Hw_Core* self, U32 operation, U32 ms);
void Hw_Core_later(Hw_Core* self, U32 operation);
int Hw_Core_ended(Hw_Core* self, U32 operation, U32 nowMs, Hw_Status* status, U32* next);
/* Returns 1 if the core has raised the event since the last call of this function. */
int Hw_Core_event(Hw_Core* self, U32 event);

/* Convert between numbers and their IEEE 754 bits in registers. */
U32 Hw_floatBits(float value);
float Hw_float(U32 bits);
U32 Hw_doubleBits(double value, int high);
double Hw_double(U32 low, U32 high);
