/* SPDX-License-Identifier: MIT
 *
 * hw_registers: the servant of Hw::Registers. It finds a register in the table by its name, and
 * accesses its word through the FSMC driver. The polling task sends the replies to calls of `wait`.
 */
#include "hw_registers.h"
#include "fsmc.h"
#include "map_regs.h"
#include "system_regs.h"

#include <string.h>

enum { ID, EVENT, MASK, PAGE };
#define ALL 0xFFFFFFFFU
/* first word of the window; PAGE contains the byte address in the core that this word shows */
#define WINDOW 8U
#define WINDOW_BYTES 32U /* size of the window, bytes: words 8..15 show this part of the core */
#define WAIT_MAX 600000  /* ms */

Hw_Status Hw_Registers_Core_init(Hw_Registers_Core* self, U32 slot, U32 id,
                                 const Hw_Register* table, Ice_Int count, const Hw_Port* port,
                                 void* context) {
    memset(self, 0, sizeof *self);
    Hw_Registers_init(&self->servant);
    self->slot = slot;
    self->port = port;
    self->context = context;
    self->table = table;
    self->count = count;
    if (FSMC_read(slot, ID) != id)
        return HW_WRONG_CORE;
    FSMC_write(slot, MASK, 0);
    FSMC_write(slot, EVENT, ALL);
    return HW_OK;
}

void Hw_Registers_Core_interrupt(Hw_Registers_Core* self) {
    /* Masks all events until `wait` is called. Otherwise an event line that stays high would cause
     * interrupts without end. */
    FSMC_write(self->slot, MASK, 0);
    self->came = 1;
    self->port->post(self->context, 0);
}

/* Appends text to the reason of an exception; if the text does not fit, its end is replaced by
 * three dots. */
static void say(Hw_Registers_Core* self, Ice_String text) {
    static const char dots[] = "...";
    U32 used = (U32)strlen(self->reason), left = sizeof self->reason - sizeof dots - used;
    if (used + sizeof dots > sizeof self->reason - 1U)
        return;
    if ((U32)text.size <= left) {
        memcpy(self->reason + used, text.data, (size_t)text.size);
        self->reason[used + (U32)text.size] = 0;
    } else {
        memcpy(self->reason + used, text.data, left);
        memcpy(self->reason + used + left, dots, sizeof dots);
    }
}

static void sayText(Hw_Registers_Core* self, const char* text) {
    say(self, Ice_String_from(text));
}

static void sayNumber(Hw_Registers_Core* self, U32 value) {
    char digits[11];
    Ice_String s;
    s.data = digits + sizeof digits;
    do {
        *(char*)--s.data = (char)('0' + value % 10U);
        value /= 10U;
    } while (value);
    s.size = (Ice_Int)(digits + sizeof digits - s.data);
    say(self, s);
}

static U32 largest(U32 width) {
    return width < 32U ? (1U << width) - 1U : ALL;
}

static const Hw_Register* find(const Hw_Registers_Core* self, Ice_String name) {
    Ice_Int i;
    for (i = 0; i < self->count; ++i)
        if (Ice_String_same(&self->table[i].name, &name))
            return &self->table[i];
    return 0;
}

/* Reads "0x" and hexadecimal digits. Returns 0 if `name` is anything else. */
static int number(Ice_String name, U32* value) {
    Ice_Int i;
    *value = 0;
    if (name.size < 3 || name.size > 10 || name.data[0] != '0' || name.data[1] != 'x')
        return 0;
    for (i = 2; i < name.size; ++i) {
        static const char digits[] = "0123456789abcdefABCDEF";
        const char* at = memchr(digits, name.data[i], sizeof digits - 1U);
        if (!at)
            return 0;
        *value = *value << 4 | (U32)(at - digits < 16 ? at - digits : at - digits - 6);
    }
    return 1;
}

/* Finds a register by its name, or by its byte address in the core; in the second case fills
 * `place`. Returns 0 and sets the reason if no such register exists. */
static const Hw_Register* lookUp(Hw_Registers_Core* self, Ice_String name, Hw_Register* place) {
    const Hw_Register* r = find(self, name);
    const Hw_Register* page = find(self, Ice_String_from("PAGE.ADDRESS"));
    U32 address;
    Ice_Int i;
    self->reason[0] = 0;
    if (r)
        return r;
    if (page && number(name, &address) && address <= largest(page->width) && address % 4U == 0U) {
        place->name = name;
        place->access = Hw_rw;
        place->word = (Ice_Byte)(WINDOW + address % WINDOW_BYTES / 4U);
        place->lsb = 0;
        place->width = 32;
        place->page = (Ice_Int)(address - address % WINDOW_BYTES);
        return place;
    }
    sayText(self, "unknown name '");
    say(self, name);
    sayText(self, "'; expected ");
    if (page) {
        sayText(self, "the byte address of a word of the core, 0x0 to ");
        sayNumber(self, largest(page->width) - 3U);
        sayText(self, " in hexadecimal, or ");
    }
    for (i = 0; i < self->count; ++i) {
        if (i)
            sayText(self, ", ");
        say(self, self->table[i].name);
    }
    return 0;
}

/* Reads or writes a word once. Returns 0 and sets the reason if the core does not respond. */
static int transfer(Hw_Registers_Core* self, const Hw_Register* r, int isWrite, U32* value) {
    U32 before = self->port->busErrors(self->context);
    if (r->page >= 0)
        FSMC_write(self->slot, PAGE, (U32)r->page);
    if (isWrite)
        FSMC_write(self->slot, r->word, *value);
    else
        *value = FSMC_read(self->slot, r->word);
    /* A write may be posted, so a read follows. When this read has ended, an error of the write has
     * been counted. */
    (void)FSMC_read(self->slot, ID);
    if (self->port->busErrors(self->context) == before)
        return 1;
    say(self, r->name);
    sayText(self, ": the core does not answer, or refuses the address");
    return 0;
}

/* Returns the exception RegisterError, with the current reason. */
static Hw_RegisterError thrown(const Hw_Registers_Core* self) {
    Hw_RegisterError e;
    e.reason = Ice_String_from(self->reason);
    return e;
}

Ice_Status Hw_Registers_list(Hw_RegistersPtr servant, Hw_RegisterSeq* result,
                             const Ice_Current* current) {
    const Hw_Registers_Core* self = (const Hw_Registers_Core*)servant;
    (void)current;
    result->size = self->count;
    result->data = (Hw_Register*)self->table; /* read only */
    return ICE_OK;
}

static int read(Hw_Registers_Core* self, Ice_String name, U32* value) {
    Hw_Register place;
    const Hw_Register* r = lookUp(self, name, &place);
    if (!r)
        return 0;
    if (r->access == Hw_ws) {
        say(self, name);
        sayText(self, " is ws: a write acts, and there is nothing to read");
        return 0;
    }
    if (!transfer(self, r, 0, value))
        return 0;
    *value = *value >> r->lsb & largest(r->width);
    return 1;
}

Ice_Status Hw_Registers_get(Hw_RegistersPtr servant, Ice_String name, Ice_Long* result,
                            Hw_Registers_get_Exception* ex, const Ice_Current* current) {
    Hw_Registers_Core* self = (Hw_Registers_Core*)servant;
    (void)current;
    result->high = 0;
    if (read(self, name, &result->low))
        return ICE_OK;
    ex->type = Hw_Registers_get_RegisterError;
    ex->u.RegisterError = thrown(self);
    return ICE_USER_EXCEPTION;
}

static int write(Hw_Registers_Core* self, Ice_String name, Ice_Long value) {
    Hw_Register place;
    const Hw_Register* r = lookUp(self, name, &place);
    U32 others = 0, bits;
    if (!r)
        return 0;
    if (r->access == Hw_ro) {
        say(self, name);
        sayText(self, " is ro: it can be read only");
        return 0;
    }
    bits = largest(r->width);
    if (value.high || value.low > bits) {
        say(self, name);
        sayText(self, " takes 0 to ");
        sayNumber(self, bits);
        return 0;
    }
    /* A write to a field of a register of access rw keeps the values of the other fields. In
     * registers of access w1c, w1s and ws, 0 in the other fields has no effect. */
    if (r->access == Hw_rw && memchr(name.data, '.', (size_t)name.size)) {
        if (!transfer(self, r, 0, &others))
            return 0;
        others &= ~(bits << r->lsb);
    }
    others |= value.low << r->lsb;
    return transfer(self, r, 1, &others);
}

Ice_Status Hw_Registers_set(Hw_RegistersPtr servant, Ice_String name, Ice_Long value,
                            Hw_Registers_set_Exception* ex, const Ice_Current* current) {
    Hw_Registers_Core* self = (Hw_Registers_Core*)servant;
    (void)current;
    if (write(self, name, value))
        return ICE_OK;
    ex->type = Hw_Registers_set_RegisterError;
    ex->u.RegisterError = thrown(self);
    return ICE_USER_EXCEPTION;
}

Ice_Status Hw_Registers_wait(Hw_RegistersPtr servant, Ice_Int ms, const Ice_Current* current) {
    Hw_Registers_Core* self = (Hw_Registers_Core*)servant;
    Ice_Reply refusal;
    self->reason[0] = 0;
    if (ms < 0 || ms > WAIT_MAX) {
        sayText(self, "wait takes 0 to ");
        sayNumber(self, WAIT_MAX);
        sayText(self, " ms");
    } else if (self->waits) {
        sayText(self, "another call waits already");
    }
    if (self->reason[0]) {
        Hw_Registers_wait_Exception ex;
        ex.type = Hw_Registers_wait_RegisterError;
        ex.u.RegisterError = thrown(self);
        Ice_Current_later(current, &refusal);
        (void)Hw_Registers_wait_exception(&refusal, &ex);
        return ICE_LATER;
    }
    Ice_Current_later(current, &self->reply);
    self->came = 0;
    self->deadline = self->port->nowMs(self->context) + (U32)ms;
    self->waits = 1;
    FSMC_write(self->slot, MASK, ALL);
    /* wakes the polling task, which must wait for the new deadline */
    self->port->post(self->context, 0);
    return ICE_LATER;
}

/* Reads and clears the slot's events, and stores their names, which are the fields of EVENT in the
 * table. Returns the number of events. */
static Ice_Int takeEvents(Hw_Registers_Core* self) {
    static const char prefix[] = "EVENT.";
    const Ice_Int skipped = sizeof prefix - 1;
    U32 bits = FSMC_read(self->slot, EVENT);
    Ice_Int i, n = 0;
    FSMC_write(self->slot, EVENT, bits);
    for (i = 0; i < self->count && n < HW_REGISTERS_EVENTS; ++i) {
        const Hw_Register* r = &self->table[i];
        if (r->word == EVENT && r->name.size > skipped && (bits >> r->lsb & 1U)) {
            self->events[n].data = r->name.data + skipped;
            self->events[n++].size = r->name.size - skipped;
        }
    }
    return n;
}

U32 Hw_Registers_Core_poll(Hw_Registers_Core* self, U32 nowMs) {
    U32 left = self->deadline - nowMs;
    Ice_Reply reply = self->reply;
    Hw_NameSeq events;
    if (!self->waits)
        return HW_NEVER;
    if (!self->came && left - 1U < 0x7FFFFFFFU)
        return left;
    FSMC_write(self->slot, MASK, 0);
    events.size = takeEvents(self);
    events.data = self->events;
    /* cleared before the reply is sent, because the caller may call again at once */
    self->waits = 0;
    (void)Hw_Registers_wait_response(&reply, &events);
    return HW_NEVER;
}

void Hw_Contracts_read(Hw_Contract* found, const Hw_Contract* built, U32 count) {
    U32 i;
    for (i = 0; i < count; ++i) {
        found[i] = built[i];
        FSMC_write(MAP_SLOT_SYSTEM, SYSTEM_CONTRACT, built[i].slot);
        found[i].chip = (Ice_Int)FSMC_read(MAP_SLOT_SYSTEM, SYSTEM_CONTRACT);
    }
}

int Hw_Contracts_hold(const Hw_Contract* found, U32 count, U32 slot) {
    U32 i;
    for (i = 0; i < count; ++i)
        if (found[i].slot == slot)
            return found[i].chip == found[i].firmware;
    return 0;
}
