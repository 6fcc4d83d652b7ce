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
    HW_WRONG_CORE, /* the slot contains a core with another ID */
    HW_BUSY,       /* the operation is still running */
    HW_REFUSED,    /* the core rejected the operation */
    HW_TIMEOUT,    /* the event did not arrive in time, and the core was reset */
    HW_UNALIGNED   /* the address of the buffers is not a multiple of their size */
} Hw_Status;

/* Buffers in DDR3 for the frames of a camera. The camera's core writes frames into them; another
 * core processes the frames. The servant of the camera's core sets base, stride, width and height;
 * the application sets the other fields. */
typedef struct Hw_Frames {
    /* byte address of the first of three buffers, and distance from one buffer to the next, bytes
     */
    U32 base, stride;
    /* size of a frame, pixels. Width 0 means that no camera is running; the frame is then in
     * `picture`. */
    U32 width, height;
    /* byte address of a picture in memory, and byte address of its size: width and height, 32 bits
     * each */
    U32 picture, pictureSize;
    /* function called for each frame that was processed; 0 if not needed */
    void (*processed)(U32 findings);
} Hw_Frames;

/* Interface of a servant to the operating system: functions with which the servant's task waits,
 * and resources that several servants share. On uC/OS-II, a semaphore (OSSemPend, OSSemPost)
 * implements wait and post. If several tasks call operations that take time, each operation needs a
 * separate semaphore. */
typedef struct Hw_Port {
    /* Waits until post is called for the operation, or until `ms` have passed. Returns 1 after a
     * post, and 0 after a time-out. A post that precedes the wait is not lost. */
    int (*wait)(void* context, U32 operation, U32 ms);
    void (*post)(void* context, U32 operation);
    /* Returns milliseconds since an arbitrary time; the count wraps. */
    U32 (*nowMs)(void* context);
    /* Returns the number of bus errors so far: accesses to which no core has responded. If this
     * number increases during a read, the data of the read is not valid. */
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
    volatile U8 later[HW_OPERATIONS]; /* 1: the polling task must send the operation's reply */
    U32 deadline[HW_OPERATIONS];      /* times at which these operations time out, ms */
} Hw_Core;

/* Initialises a core: resets the core, and clears and enables its events. `id` is the expected
 * value of word ID; returns HW_WRONG_CORE if the word has another value. */
Hw_Status Hw_Core_init(Hw_Core* self, U32 slot, U32 id, const Hw_Port* port, void* context);
/* Handles all events of the slot until its interrupt line is low; called by the interrupt routine
 * or by a task. */
void Hw_Core_interrupt(Hw_Core* self);

/* Access a word on `page` of a slot with more than 16 words, and then restore the register PAGE, so
 * that an interrupted task finds its own page selected again. Tasks of equal priority that share
 * processor time must not use these functions. */
U32 Hw_Core_read(const Hw_Core* self, U32 word, U32 page);
void Hw_Core_write(const Hw_Core* self, U32 word, U32 page, U32 value);

/* Steps of an operation, for generated servants. ready: returns HW_OK if parameters may be written.
 * act: starts the operation. run: starts the operation and waits for its event, for at most
 * `ms`. */
Hw_Status Hw_Core_ready(const Hw_Core* self, U32 operation);
void Hw_Core_act(const Hw_Core* self, U32 operation);
/* Returns 1 if the core responds to a read; all earlier accesses are then complete. Returns 0 if
 * the clock of the core is stopped. */
int Hw_Core_answers(const Hw_Core* self);
Hw_Status Hw_Core_run(Hw_Core* self, U32 operation, U32 ms);

/* Steps of an operation with a reply that is sent later. begin: starts the operation and its
 * time-out. later: leaves the reply to the polling task. ended: returns 1 and sets the status if
 * the operation has ended; otherwise returns 0, and if less than `next` ms are left until the
 * time-out, reduces `next` to this time. */
void Hw_Core_begin(Hw_Core* self, U32 operation, U32 ms);
void Hw_Core_later(Hw_Core* self, U32 operation);
int Hw_Core_ended(Hw_Core* self, U32 operation, U32 nowMs, Hw_Status* status, U32* next);
/* Returns 1 if the core has raised the event since the previous call of this function for this
 * event. */
int Hw_Core_event(Hw_Core* self, U32 event);

/* Convert between numbers and their IEEE 754 bits in registers. */
U32 Hw_floatBits(float value);
float Hw_float(U32 bits);
U32 Hw_doubleBits(double value, int high);
double Hw_double(U32 low, U32 high);
