/* SPDX-License-Identifier: MIT
 *
 * fsmc_stream: copies blocks to and from DDR3 at the bridge's full speed, without NWAIT, checks
 * them, and repeats parts where needed.
 */
#include "fsmc_private.h"
#include "map_regs.h"
#include "system_regs.h"

/* Mode A without NWAIT: an access takes ADDSET + DATAST + 1 HCLK. A write's data phase is 2 HCLK.
 * Its BUSTURN is 0, since some FSMCs insert it between two writes, too. A read is all data phase,
 * so that NOE falls with the address. */
#define STREAM_BCR (BCR_ALWAYS | BCR_EXTMOD)
#define WRITE_DATAST 2U
/* Accesses/s at most (docs/fsmc.md): 33.3 ns between edges of NWE; a read has its data 15 ns after
 * HCLK's edge that moves its address, and the FSMC wants it HCLK + 4 ns before the end. */
#define WRITE_HZ 30000000UL
#define READ_HZ 25000000UL
#define REGION 4096U /* bytes: the bridge does not read ahead beyond their multiples */
#define BLOCK 64U

static U8 writeAddset = 15, readDatast = 17; /* until FSMC_setHclk: slow, but right */

/* HCLK cycles of an access, 4 at least. */
static U32 cyclesFor(U32 hclkHz, U32 accessHz) {
    U32 cycles = (U32)((hclkHz + accessHz - 1U) / accessHz);
    return cycles < 4U ? 4U : cycles > 18U ? 18U : cycles;
}

void FSMC_setHclk(U32 hz) {
    writeAddset = (U8)(cyclesFor(hz, WRITE_HZ) - WRITE_DATAST - 1U);
    readDatast = (U8)(cyclesFor(hz, READ_HZ) - 1U);
}

static void setBank(int fast) {
    if (fast) {
        fsmc_port->write32(fsmc_context, FSMC_BTR(0), BTR_DATAST(readDatast) | BTR_BUSTURN(1));
        fsmc_port->write32(fsmc_context, FSMC_BWTR(0),
                           BTR_DATAST(WRITE_DATAST) | BTR_ADDSET(writeAddset));
        fsmc_port->write32(fsmc_context, FSMC_BCR(0), STREAM_BCR);
    } else {
        fsmc_port->write32(fsmc_context, FSMC_BCR(0), BCR_VALUE);
        fsmc_port->write32(fsmc_context, FSMC_BTR(0), BTR_VALUE);
    }
}

/* Returns 1 if an access was too early since the last call. The register access also flushes posted
 * writes.
 */
static int wasLate(void) {
    if (!(FSMC_read(MAP_SLOT_SYSTEM, SYSTEM_EVENT) & SYSTEM_EVENT_LATE_MASK))
        return 0;
    FSMC_write(MAP_SLOT_SYSTEM, SYSTEM_EVENT, SYSTEM_EVENT_LATE_MASK);
    return 1;
}

/* Returns the bytes up to the next multiple of `size`, at most `bytes`. */
static U32 upTo(U32 address, U32 size, U32 bytes) {
    U32 left = size - (address & (size - 1U));
    return left < bytes ? left : bytes;
}

U32 FSMC_streamWrite(U32 address, const U16* data, U32 halfwords) {
    U32 repeated = 0;
    (void)wasLate();
    while (halfwords) {
        U32 i, part = upTo(address, 8U * REGION, 2U * halfwords) / 2U;
        U32 at = fsmc_windowAddress(address);
        (void)FSMC_read(MAP_SLOT_SYSTEM,
                        SYSTEM_ID); /* register writes are posted, and NWAIT is off now */
        setBank(1);
        for (i = 0; i < part; ++i)
            fsmc_port->write16(fsmc_context, at + 2U * i, data[i]);
        setBank(0);
        if (wasLate()) {
            repeated += part;
            for (i = 0; i < part; ++i)
                fsmc_port->write16(fsmc_context, at + 2U * i, data[i]);
        }
        address += 2U * part;
        data += part;
        halfwords -= part;
    }
    return repeated;
}

/* Reads with the bank's present timing. */
static void readHalfwords(U32 at, U16* data, U32 halfwords) {
    U32 i;
    for (i = 0; i < halfwords; ++i)
        data[i] = fsmc_port->read16(fsmc_context, at + 2U * i);
}

U32 FSMC_streamRead(U32 address, U16* data, U32 halfwords) {
    U32 repeated = 0;
    (void)wasLate();
    while (halfwords) {
        U32 part = upTo(address, REGION, 2U * halfwords) / 2U;
        U32 at = fsmc_windowAddress(address);
        if (address & (BLOCK - 1U)) {
            /* A block is read from its beginning: only then the bridge has time to fetch the next
             * one. */
            part = upTo(address, BLOCK, 2U * part) / 2U;
            readHalfwords(at, data, part);
        } else {
            /* Two reads in a block make the bridge fetch it; the one at its end waits until all of
             * it is there. */
            (void)fsmc_port->read16(fsmc_context, at);
            (void)fsmc_port->read16(fsmc_context, at + BLOCK - 2U);
            setBank(1);
            readHalfwords(at, data, part);
            setBank(0);
            if (wasLate()) {
                repeated += part;
                readHalfwords(at, data, part);
            }
        }
        address += 2U * part;
        data += part;
        halfwords -= part;
    }
    return repeated;
}
