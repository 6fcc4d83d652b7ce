/* SPDX-License-Identifier: MIT
 *
 * hw_core: what the servants generated from [":hw"] interfaces share (docs/hw-mapping.md).
 *
 * A core has the registers of its interface in one slot. Each operation has a bit, 0..15. Calls of
 * different operations may come from different tasks; calls of one operation must not overlap.
 */
#pragma once

#include "base.h"

#define HW_OPERATIONS 16

typedef enum Hw_Status {
    HW_OK = 0,
    HW_WRONG_CORE, /* the slot's ID is another one */
    HW_BUSY,       /* the operation is still running */
    HW_REFUSED,    /* the core refused the operation */
    HW_TIMEOUT,    /* no event in time; the core was reset */
    HW_UNALIGNED   /* the buffers do not begin at a multiple of their size */
} Hw_Status;

/* Frames in DDR3, from the core that captures them to the core that processes them. The servant of
 * a camera core writes base, stride, width and height; the application sets the rest. */
typedef struct Hw_Frames {
    U32 base, stride;  /* byte address of the first of three buffers; bytes to the next */
    U32 width, height; /* pixels; width 0: no camera runs, the picture is the frame */
    U32 picture,
        pictureSize; /* byte addresses of a picture, and of its width and height: 32 bits each */
    void (*processed)(U32 findings); /* called for each frame that was processed */
} Hw_Frames;

/* Port of a core's servant to the system: functions that make its task wait, and the resources that
 * it shares with other servants. On uC/OS-II waiting uses a semaphore (OSSemPend, OSSemPost), one
 * per operation if several tasks call operations that take time. */
typedef struct Hw_Port {
    /* Waits until post is called for the operation (returns 1), or `ms` have passed (0). A post
     * since the last wait counts. */
    int (*wait)(void* context, U32 operation, U32 ms);
    void (*post)(void* context, U32 operation);
    U32 (*nowMs)(void* context); /* any origin; wraps */
    /* Returns the number of accesses so far without an answer; their data is not valid. */
    U32 (*busErrors)(void* context);
    Hw_Frames* frames; /* 0: no core of the program processes frames */
} Hw_Port;

#define HW_NEVER 0xFFFFFFFFU

typedef struct Hw_Core {
    U32 slot; /* 0..63 */
    U32 id;   /* expected value of word ID */
    const Hw_Port* port;
    void* context;
    volatile U8 done[HW_OPERATIONS];  /* set by the interrupt */
    U32 memory;                       /* DDR3 byte address of the buffers */
    volatile U8 later[HW_OPERATIONS]; /* to be answered by the polling task */
    U32 deadline[HW_OPERATIONS];      /* deadlines of these, ms */
} Hw_Core;

/* Initialises a core: resets it, clears its events, enables them. `id` is the expected value of
 * word ID; if it differs, returns HW_WRONG_CORE. */
Hw_Status Hw_Core_init(Hw_Core* self, U32 slot, U32 id, const Hw_Port* port, void* context);
/* Takes the slot's events while its interrupt line is high; for the interrupt routine or a task. */
void Hw_Core_interrupt(Hw_Core* self);

/* Access a word behind `page` of a slot with more than 16 words. PAGE is restored, so an
 * interrupted task continues as before. Tasks of equal priority must not alternate here. */
U32 Hw_Core_read(const Hw_Core* self, U32 word, U32 page);
void Hw_Core_write(const Hw_Core* self, U32 word, U32 page, U32 value);

/* Steps of an operation, for generated servants. ready: HW_OK if parameters may be written. act:
 * starts the operation. run: starts it and waits for its event, at most `ms`. */
Hw_Status Hw_Core_ready(const Hw_Core* self, U32 operation);
void Hw_Core_act(const Hw_Core* self, U32 operation);
/* Returns 1 if the core responds, so that earlier accesses are done; 0 if its clock is stopped. */
int Hw_Core_answers(const Hw_Core* self);
Hw_Status Hw_Core_run(Hw_Core* self, U32 operation, U32 ms);

/* Steps of an operation that is answered later. begin: starts it, and its time. later: leaves the
 * rest to the polling task. ended: returns 1 and the status if it has ended, else 0, and reduces
 * `next` to the time left. */
void Hw_Core_begin(Hw_Core* self, U32 operation, U32 ms);
void Hw_Core_later(Hw_Core* self, U32 operation);
int Hw_Core_ended(Hw_Core* self, U32 operation, U32 nowMs, Hw_Status* status, U32* next);
/* Returns 1 if the core has raised the event since the last call. */
int Hw_Core_event(Hw_Core* self, U32 event);

/* Convert between numbers and their IEEE 754 bits in registers. */
U32 Hw_floatBits(float value);
float Hw_float(U32 bits);
U32 Hw_doubleBits(double value, int high);
double Hw_double(U32 low, U32 high);
