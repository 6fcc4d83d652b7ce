/* SPDX-License-Identifier: MIT
 *
 * spi_nor: implements a Slots_Port for a serial NOR flash. Each function call is one transaction;
 * afterwards the bus is free.
 */
#include "spi_nor.h"

#define PAGE_PROGRAM 0x02U
#define READ 0x03U
#define READ_STATUS 0x05U
#define WRITE_ENABLE 0x06U
#define IDENTIFY 0x9FU
#define BLOCK_ERASE 0xD8U
#define BUSY 1U
#define PAUSES 10000U /* limit of the number of pauses in a wait; an erase needs far fewer */

/* Starts a transaction: sends an instruction and, if `hasOffset`, an address. */
static const SpiNor_Bus* begin(void* context, U32 instruction, U32 offset, int hasOffset) {
    const SpiNor_Bus* bus = (const SpiNor_Bus*)context;
    int shift;
    bus->select(1);
    (void)bus->transfer((U8)instruction);
    for (shift = 16; hasOffset && shift >= 0; shift -= 8)
        (void)bus->transfer((U8)(offset >> shift));
    return bus;
}

static int wait(void* context) {
    U32 i;
    for (i = 0; i < PAUSES; ++i) {
        const SpiNor_Bus* bus = begin(context, READ_STATUS, 0, 0);
        const U32 status = bus->transfer(0xFFU);
        bus->select(0);
        if (!(status & BUSY))
            return 1;
        bus->pause();
    }
    return 0;
}

int SpiNor_isThere(void* context) {
    const SpiNor_Bus* bus = begin(context, IDENTIFY, 0, 0);
    const U32 maker = bus->transfer(0xFFU);
    bus->select(0);
    return maker != 0U && maker != 0xFFU;
}

void SpiNor_read(void* context, U32 offset, U8* bytes, U32 count) {
    const SpiNor_Bus* bus = begin(context, READ, offset, 1);
    while (count--)
        *bytes++ = bus->transfer(0xFFU);
    bus->select(0);
}

static const SpiNor_Bus* beginChange(void* context, U32 instruction, U32 offset) {
    begin(context, WRITE_ENABLE, 0, 0)->select(0);
    return begin(context, instruction, offset, 1);
}

int SpiNor_erase(void* context, U32 offset) {
    beginChange(context, BLOCK_ERASE, offset)->select(0);
    return wait(context);
}

int SpiNor_program(void* context, U32 offset, const U8* bytes, U32 count) {
    const SpiNor_Bus* bus = beginChange(context, PAGE_PROGRAM, offset);
    while (count--)
        (void)bus->transfer(*bytes++);
    bus->select(0);
    return wait(context);
}
