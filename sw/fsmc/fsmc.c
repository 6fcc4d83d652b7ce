/* SPDX-License-Identifier: MIT
 *
 * fsmc: set-up of the FSMC, register words, and memory copies through the DDR3 window.
 */
#include "fsmc_private.h"
#include "map_regs.h"
#include "system_regs.h"

#define WINDOW_MASK ((1U << MAP_DDR_WINDOW_LOG2) - 1U)

const FSMC_Port* fsmc_port;
void* fsmc_context;
static U32 fsmcPage;

static U32 wordAddress(U32 slot, U32 word) {
    return MAP_CONTROL_WINDOW + ((slot & 63U) << 6 | (word & 15U) << 2);
}

FSMC_Status fsmc_identify(void) {
    if (FSMC_read(MAP_SLOT_SYSTEM, SYSTEM_ID) >> 16 != SYSTEM_ID_VALUE >> 16)
        return FSMC_NO_DEVICE;
    fsmcPage = 0;
    FSMC_write(MAP_SLOT_SYSTEM, SYSTEM_PAGE, 0);
    return FSMC_OK;
}

FSMC_Status FSMC_init(const FSMC_Port* port, void* context) {
    U32 bank;
    fsmc_port = port;
    fsmc_context = context;
    for (bank = 0; bank < 2U; ++bank) {
        port->write32(context, FSMC_BTR(bank), BTR_VALUE);
        port->write32(context, FSMC_BCR(bank), BCR_VALUE);
    }
    return fsmc_identify();
}

U32 FSMC_read(U32 slot, U32 word) {
    return fsmc_port->read32(fsmc_context, wordAddress(slot, word));
}

void FSMC_write(U32 slot, U32 word, U32 value) {
    fsmc_port->write32(fsmc_context, wordAddress(slot, word), value);
}

U32 fsmc_windowAddress(U32 address) {
    U32 page = address >> MAP_DDR_WINDOW_LOG2;
    if (page != fsmcPage) {
        FSMC_write(MAP_SLOT_SYSTEM, SYSTEM_PAGE, page);
        fsmcPage = page;
    }
    return MAP_DDR_WINDOW + (address & WINDOW_MASK);
}

void FSMC_readMemory(U32 address, U8* data, U32 bytes) {
    while (bytes) {
        U32 at = fsmc_windowAddress(address);
        if ((address & 1U) || bytes == 1U) {
            *data++ = fsmc_port->read8(fsmc_context, at);
            ++address;
            --bytes;
        } else {
            U16 half = fsmc_port->read16(fsmc_context, at);
            *data++ = (U8)half;
            *data++ = (U8)(half >> 8);
            address += 2U;
            bytes -= 2U;
        }
    }
}

void FSMC_writeMemory(U32 address, const U8* data, U32 bytes) {
    while (bytes) {
        U32 at = fsmc_windowAddress(address);
        if ((address & 1U) || bytes == 1U) {
            fsmc_port->write8(fsmc_context, at, *data++);
            ++address;
            --bytes;
        } else {
            fsmc_port->write16(fsmc_context, at, (U16)(data[0] | (U32)data[1] << 8));
            data += 2;
            address += 2U;
            bytes -= 2U;
        }
    }
}

FSMC_Status FSMC_checkError(U32* where) {
    if (!(FSMC_read(MAP_SLOT_SYSTEM, SYSTEM_EVENT) & SYSTEM_EVENT_BUS_ERROR_MASK))
        return FSMC_OK;
    if (where)
        *where = FSMC_read(MAP_SLOT_SYSTEM, SYSTEM_ERROR_ADDR);
    FSMC_write(MAP_SLOT_SYSTEM, SYSTEM_EVENT, SYSTEM_EVENT_BUS_ERROR_MASK);
    return FSMC_BUS_ERROR;
}
