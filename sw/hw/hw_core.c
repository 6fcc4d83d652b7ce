/* SPDX-License-Identifier: MIT
 *
 * hw_core: starts the operations of a core, and waits for their events.
 */
#include "hw_core.h"
#include "fsmc.h"

#include <string.h>

enum { ID, EVENT, MASK, CONTROL, STATUS, PAGE };
#define RESET (1U << 31)
#define REFUSED_LSB 16U

typedef char hw_check_double[sizeof(double) == 8 ? 1 : -1];

Hw_Status Hw_Core_init(Hw_Core* self, U32 slot, U32 id, const Hw_Port* port, void* context) {
    U32 i;
    self->slot = slot;
    self->id = id;
    self->port = port;
    self->context = context;
    for (i = 0; i < HW_OPERATIONS; ++i)
        self->done[i] = self->later[i] = 0;
    if (!Hw_Core_answers(self))
        return HW_WRONG_CORE;
    FSMC_write(slot, CONTROL, RESET);
    FSMC_write(slot, EVENT, 0xFFFFFFFFU);
    FSMC_write(slot, MASK, 0xFFFFFFFFU);
    return HW_OK;
}

void Hw_Core_interrupt(Hw_Core* self) {
    U32 events = FSMC_read(self->slot, EVENT);
    U32 i;
    FSMC_write(self->slot, EVENT, events);
    for (i = 0; i < HW_OPERATIONS; ++i)
        if (events & 1U << i) {
            self->done[i] = 1;
            self->port->post(self->context, i);
        }
}

U32 Hw_Core_read(const Hw_Core* self, U32 word, U32 page) {
    U32 before = FSMC_read(self->slot, PAGE), value;
    FSMC_write(self->slot, PAGE, page);
    value = FSMC_read(self->slot, word);
    FSMC_write(self->slot, PAGE, before);
    return value;
}

void Hw_Core_write(const Hw_Core* self, U32 word, U32 page, U32 value) {
    U32 before = FSMC_read(self->slot, PAGE);
    FSMC_write(self->slot, PAGE, page);
    FSMC_write(self->slot, word, value);
    FSMC_write(self->slot, PAGE, before);
}

Hw_Status Hw_Core_ready(const Hw_Core* self, U32 operation) {
    return FSMC_read(self->slot, STATUS) & 1U << operation ? HW_BUSY : HW_OK;
}

void Hw_Core_act(const Hw_Core* self, U32 operation) {
    FSMC_write(self->slot, CONTROL, 1U << operation);
}

int Hw_Core_answers(const Hw_Core* self) {
    return FSMC_read(self->slot, ID) == self->id;
}

Hw_Status Hw_Core_run(Hw_Core* self, U32 operation, U32 ms) {
    self->done[operation] = 0;
    Hw_Core_act(self, operation);
    /* A call that timed out may have left a post, which ends a later wait too early. Therefore only
     * `done` shows whether the operation has ended. */
    while (!self->done[operation])
        if (!self->port->wait(self->context, operation, ms) && !self->done[operation]) {
            FSMC_write(self->slot, CONTROL, RESET);
            return HW_TIMEOUT;
        }
    return FSMC_read(self->slot, STATUS) & 1U << (REFUSED_LSB + operation) ? HW_REFUSED : HW_OK;
}

void Hw_Core_begin(Hw_Core* self, U32 operation, U32 ms) {
    self->done[operation] = 0;
    self->deadline[operation] = self->port->nowMs(self->context) + ms;
    Hw_Core_act(self, operation);
}

void Hw_Core_later(Hw_Core* self, U32 operation) {
    self->later[operation] = 1;
    /* Wakes the polling task, which must check this operation now: its event may already have
     * occurred, or its deadline may be earlier than all others. */
    self->port->post(self->context, operation);
}

int Hw_Core_ended(Hw_Core* self, U32 operation, U32 nowMs, Hw_Status* status, U32* next) {
    U32 left = self->deadline[operation] - nowMs;
    if (!self->later[operation])
        return 0;
    if (self->done[operation]) {
        *status =
            FSMC_read(self->slot, STATUS) & 1U << (REFUSED_LSB + operation) ? HW_REFUSED : HW_OK;
        return 1;
    }
    if (left - 1U >= 0x7FFFFFFFU) {
        FSMC_write(self->slot, CONTROL, RESET);
        *status = HW_TIMEOUT;
        return 1;
    }
    if (left < *next)
        *next = left;
    return 0;
}

int Hw_Core_event(Hw_Core* self, U32 event) {
    int has = self->done[event];
    if (has)
        self->done[event] = 0;
    return has;
}

U32 Hw_floatBits(float value) {
    U32 bits;
    memcpy(&bits, &value, sizeof bits);
    return bits;
}

float Hw_float(U32 bits) {
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Returns one half of a double. On the Cortex-M3 and on the host, the low word is stored first. */
U32 Hw_doubleBits(double value, int high) {
    U32 words[2];
    memcpy(words, &value, sizeof words);
    return words[high];
}

double Hw_double(U32 low, U32 high) {
    U32 words[2];
    double value;
    words[0] = low;
    words[1] = high;
    memcpy(&value, words, sizeof value);
    return value;
}
