/* SPDX-License-Identifier: MIT
 *
 * fsmc: sets up the FSMC, accesses registers, and copies memory through the DDR3 window. A copy
 * either uses NWAIT, or runs at the bridge's full speed without NWAIT. After a copy without NWAIT,
 * the driver checks whether an access was too early, and repeats the copy if necessary.
 */
#include "fsmc.h"

#include "map_regs.h"
#include "system_regs.h"

/* Registers of the FSMC (RM0033, 31.5.6); bank 0 is NE1. */
#define FSMC_REGISTERS 0xA0000000U
#define FSMC_BCR(bank) (FSMC_REGISTERS + 8U * (bank))
#define FSMC_BTR(bank) (FSMC_REGISTERS + 8U * (bank) + 0x004U)
#define FSMC_BWTR(bank) (FSMC_REGISTERS + 8U * (bank) + 0x104U)

#define BCR_MBKEN (1U << 0)
#define BCR_MUXEN (1U << 1)
#define BCR_MTYP_PSRAM (1U << 2)
#define BCR_MTYP_NOR (2U << 2)
#define BCR_MWID_16 (1U << 4)
#define BCR_FACCEN (1U << 6)
#define BCR_RESERVED (1U << 7) /* bit that reads as 1 and must be written as 1 */
#define BCR_WAITPOL (1U << 9)
#define BCR_WREN (1U << 12)
#define BCR_EXTMOD (1U << 14)
#define BCR_ASYNCWAIT (1U << 15)

/* Fields of BTR and BWTR; times in HCLK cycles. */
#define BTR_ADDSET(n) ((U32)(n))
#define BTR_ADDHLD(n) ((U32)(n) << 4)
#define BTR_DATAST(n) ((U32)(n) << 8)
#define BTR_BUSTURN(n) ((U32)(n) << 16)
#define BTR_ACCMOD(n) ((U32)(n) << 28)

/* Bits that are set in all modes: bank enabled, 16 bits wide, writes allowed. */
#define BCR_ALWAYS (BCR_MBKEN | BCR_MWID_16 | BCR_RESERVED | BCR_WREN)
/* Settings of FSMC_init: mode 1 with NWAIT, which is active low. NWAIT is valid less than 16 ns
 * after the pins change; with ADDSET 2, this is before the data phase begins. DATAST 4 is the
 * smallest value that NWAIT permits (docs/fsmc.md). */
#ifdef FSMC_MUXED
/* FSMC_MUXED: the data pins also carry the low half of the address (parameter MUXED of the bridge).
 * Type PSRAM, because the FSMC drives the byte lanes only for memories. DATAST 6: NOE falls after
 * the address phase, and NWAIT follows it within 16 ns. BUSTURN 2: the chip releases the data pins
 * before the FSMC drives the next address. Streams also use NWAIT. */
#define BCR_VALUE (BCR_ALWAYS | BCR_MUXEN | BCR_MTYP_PSRAM | BCR_ASYNCWAIT)
#define BTR_VALUE (BTR_ADDSET(2) | BTR_ADDHLD(2) | BTR_DATAST(6) | BTR_BUSTURN(2))
#elif !defined(FSMC_SYNC)
#define BCR_VALUE (BCR_ALWAYS | BCR_ASYNCWAIT)
#define BTR_VALUE (BTR_ADDSET(2) | BTR_DATAST(4) | BTR_BUSTURN(1))
#else
/* FSMC_SYNC: the FPGA has the bridge that samples its pins (fsmc_sync_bridge). Mode A: between two
 * accesses, NOE and NWE are high for ADDSET (6 HCLK). With this bridge, streams also use NWAIT. */
#define BCR_VALUE (BCR_ALWAYS | BCR_EXTMOD | BCR_ASYNCWAIT)
#define BTR_VALUE (BTR_ADDSET(6) | BTR_DATAST(5) | BTR_BUSTURN(1))
#endif

#define WINDOW_MASK ((1U << MAP_DDR_WINDOW_LOG2) - 1U)

static const FSMC_Port* fsmcPort;
static void* fsmcContext;
static U32 fsmcPage;

static U32 wordAddress(U32 slot, U32 word) {
    return MAP_CONTROL_WINDOW + ((slot & 63U) << 6 | (word & 15U) << 2);
}

/* Checks the ID of the system slot, which is the last step of the set-up. Returns FSMC_OK or
 * FSMC_NO_DEVICE. */
static FSMC_Status identify(void) {
    if (FSMC_read(MAP_SLOT_SYSTEM, SYSTEM_ID) >> 16 != SYSTEM_ID_VALUE >> 16)
        return FSMC_NO_DEVICE;
    fsmcPage = 0;
    FSMC_write(MAP_SLOT_SYSTEM, SYSTEM_PAGE, 0);
    return FSMC_OK;
}

FSMC_Status FSMC_init(const FSMC_Port* port, void* context) {
    U32 bank;
    fsmcPort = port;
    fsmcContext = context;
    for (bank = 0; bank < 2U; ++bank) {
        port->write32(context, FSMC_BTR(bank), BTR_VALUE);
#ifdef FSMC_SYNC
        port->write32(context, FSMC_BWTR(bank), BTR_VALUE);
#endif
        port->write32(context, FSMC_BCR(bank), BCR_VALUE);
    }
    return identify();
}

U32 FSMC_read(U32 slot, U32 word) {
    return fsmcPort->read32(fsmcContext, wordAddress(slot, word));
}

void FSMC_write(U32 slot, U32 word, U32 value) {
    fsmcPort->write32(fsmcContext, wordAddress(slot, word), value);
}

/* Returns the address in the window for a DDR3 address; moves the page register if necessary. */
static U32 windowAddress(U32 address) {
    U32 page = address >> MAP_DDR_WINDOW_LOG2;
    if (page != fsmcPage) {
        FSMC_write(MAP_SLOT_SYSTEM, SYSTEM_PAGE, page);
        fsmcPage = page;
    }
    return MAP_DDR_WINDOW + (address & WINDOW_MASK);
}

void FSMC_readMemory(U32 address, U8* data, U32 bytes) {
    while (bytes) {
        U32 at = windowAddress(address);
        if ((address & 1U) || bytes == 1U) {
            *data++ = fsmcPort->read8(fsmcContext, at);
            ++address;
            --bytes;
        } else {
            U16 half = fsmcPort->read16(fsmcContext, at);
            *data++ = (U8)half;
            *data++ = (U8)(half >> 8);
            address += 2U;
            bytes -= 2U;
        }
    }
}

void FSMC_writeMemory(U32 address, const U8* data, U32 bytes) {
    while (bytes) {
        U32 at = windowAddress(address);
        if ((address & 1U) || bytes == 1U) {
            fsmcPort->write8(fsmcContext, at, *data++);
            ++address;
            --bytes;
        } else {
            fsmcPort->write16(fsmcContext, at, (U16)(data[0] | (U32)data[1] << 8));
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

/* ---- streams ---- */

/* Settings for streams: mode A without NWAIT, in which an access takes ADDSET + DATAST + 1 HCLK.
 * Writes: the data phase takes 2 HCLK; BUSTURN is 0, because some FSMCs also insert it between two
 * writes. Reads: the access has only a data phase, so NOE falls when the address changes. */
#define STREAM_BCR (BCR_ALWAYS | BCR_EXTMOD)
#define WRITE_DATAST 2U
/* Highest access rates, per second (docs/fsmc.md). Writes: 33.3 ns between two edges of NWE. Reads:
 * the data is valid 15 ns after the HCLK edge that changes the address, and must be valid one HCLK
 * + 4 ns before the end of the access. */
#define WRITE_HZ 30000000UL
#define READ_HZ 25000000UL
/* size of an aligned region of memory, bytes; the bridge does not read ahead beyond the end of a
 * region */
#define REGION 4096U
#define BLOCK 64U

/* settings until FSMC_setHclk is called; they are slow, but safe at every HCLK */
static U8 writeAddset = 15, readDatast = 17;

/* Returns the number of HCLK cycles that an access must take, 4 to 18. */
static U32 cyclesFor(U32 hclkHz, U32 accessHz) {
    U32 cycles = (U32)((hclkHz + accessHz - 1U) / accessHz);
    return cycles < 4U ? 4U : cycles > 18U ? 18U : cycles;
}

void FSMC_setHclk(U32 hz) {
    writeAddset = (U8)(cyclesFor(hz, WRITE_HZ) - WRITE_DATAST - 1U);
    readDatast = (U8)(cyclesFor(hz, READ_HZ) - 1U);
}

static void setBank(int fast) {
#if defined(FSMC_SYNC) || defined(FSMC_MUXED)
    (void)fast;
#else
    if (fast) {
        fsmcPort->write32(fsmcContext, FSMC_BTR(0), BTR_DATAST(readDatast) | BTR_BUSTURN(1));
        fsmcPort->write32(fsmcContext, FSMC_BWTR(0),
                          BTR_DATAST(WRITE_DATAST) | BTR_ADDSET(writeAddset));
        fsmcPort->write32(fsmcContext, FSMC_BCR(0), STREAM_BCR);
    } else {
        fsmcPort->write32(fsmcContext, FSMC_BCR(0), BCR_VALUE);
        fsmcPort->write32(fsmcContext, FSMC_BTR(0), BTR_VALUE);
    }
#endif
}

/* Returns 1 if an access since the last call of this function was too early for the bridge. The
 * register read in this function first waits until posted writes are done. */
static int wasLate(void) {
    if (!(FSMC_read(MAP_SLOT_SYSTEM, SYSTEM_EVENT) & SYSTEM_EVENT_LATE_MASK))
        return 0;
    FSMC_write(MAP_SLOT_SYSTEM, SYSTEM_EVENT, SYSTEM_EVENT_LATE_MASK);
    return 1;
}

/* Returns the number of bytes from `address` to the next multiple of `size`, but at most
 * `bytes`. */
static U32 upTo(U32 address, U32 size, U32 bytes) {
    U32 left = size - (address & (size - 1U));
    return left < bytes ? left : bytes;
}

U32 FSMC_streamWrite(U32 address, const U16* data, U32 halfwords) {
    U32 repeated = 0;
    (void)wasLate();
    while (halfwords) {
        U32 i, part = upTo(address, 8U * REGION, 2U * halfwords) / 2U;
        U32 at = windowAddress(address);
        /* Reads a register, which waits until the posted register writes are done. After that, the
         * memory window works without NWAIT. */
        (void)FSMC_read(MAP_SLOT_SYSTEM, SYSTEM_ID);
        setBank(1);
        for (i = 0; i < part; ++i)
            fsmcPort->write16(fsmcContext, at + 2U * i, data[i]);
        setBank(0);
        if (wasLate()) {
            repeated += part;
            for (i = 0; i < part; ++i)
                fsmcPort->write16(fsmcContext, at + 2U * i, data[i]);
        }
        address += 2U * part;
        data += part;
        halfwords -= part;
    }
    return repeated;
}

/* Reads halfwords with the current timing of the bank. */
static void readHalfwords(U32 at, U16* data, U32 halfwords) {
    U32 i;
    for (i = 0; i < halfwords; ++i)
        data[i] = fsmcPort->read16(fsmcContext, at + 2U * i);
}

U32 FSMC_streamRead(U32 address, U16* data, U32 halfwords) {
    U32 repeated = 0;
    (void)wasLate();
    while (halfwords) {
        U32 part = upTo(address, REGION, 2U * halfwords) / 2U;
        U32 at = windowAddress(address);
        if (address & (BLOCK - 1U)) {
            /* Each block is read from its first halfword, because only then has the bridge enough
             * time to fetch the next block. */
            part = upTo(address, BLOCK, 2U * part) / 2U;
            readHalfwords(at, data, part);
        } else {
            /* Two reads in a block make the bridge fetch the block. A read at the end of the block
             * waits until the whole block has arrived. */
            (void)fsmcPort->read16(fsmcContext, at);
            (void)fsmcPort->read16(fsmcContext, at + BLOCK - 2U);
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

/* ---- other modes ---- */

#define BWTR_RESET 0x0FFFFFFFU

typedef struct Values {
    U32 bcr, btr, bwtr;
} Values;

static int isExtended(FSMC_Mode mode) {
    return mode >= FSMC_MODE_A && mode <= FSMC_MODE_D;
}

static int timingIsBad(const FSMC_Bank* bank, const FSMC_Timing* time, FSMC_Mode mode) {
    int holds = bank->muxed || mode == FSMC_MODE_D;
    return time->addset > 15U || time->addhld > 15U || (holds && time->addhld == 0U) ||
           time->datast < (bank->wait ? 4U : 1U);
}

static int isBad(const FSMC_Bank* bank) {
    if (bank->mode > FSMC_MODE_D || bank->busturn == 0U || bank->busturn > 15U ||
        timingIsBad(bank, &bank->read, bank->mode))
        return 1;
    return isExtended(bank->mode) &&
           (!isExtended(bank->writeMode) || timingIsBad(bank, &bank->write, bank->writeMode));
}

/* Returns a value for BTR or BWTR. Mode A is 0 in the field ACCMOD, mode D is 3. */
static U32 timing(const FSMC_Timing* time, U32 busturn, FSMC_Mode mode) {
    U32 accmod = isExtended(mode) ? (U32)mode - (U32)FSMC_MODE_A : 0U;
    return BTR_ADDSET(time->addset) | BTR_ADDHLD(time->addhld) | BTR_DATAST(time->datast) |
           BTR_BUSTURN(busturn) | BTR_ACCMOD(accmod);
}

static Values valuesOf(const FSMC_Bank* bank) {
    Values v;
    v.bcr = BCR_ALWAYS;
    if (bank->muxed)
        v.bcr |= BCR_MUXEN;
    if (bank->waitHigh)
        v.bcr |= BCR_WAITPOL;
    v.bwtr = BWTR_RESET;
    v.btr = timing(&bank->read, bank->busturn, bank->mode);
    if (bank->wait)
        v.bcr |= BCR_ASYNCWAIT;
    if (bank->mode == FSMC_MODE_1 || bank->mode == FSMC_MODE_A)
        v.bcr |= bank->psram ? BCR_MTYP_PSRAM : 0U;
    else
        v.bcr |= BCR_MTYP_NOR | BCR_FACCEN;
    if (isExtended(bank->mode)) {
        v.bcr |= BCR_EXTMOD;
        v.bwtr = timing(&bank->write, bank->busturn, bank->writeMode);
    }
    return v;
}

FSMC_Status FSMC_initBanks(const FSMC_Port* port, void* context, const FSMC_Bank banks[2]) {
    U32 i;
    if (isBad(&banks[0]) || isBad(&banks[1]))
        return FSMC_BAD_SETTING;
    fsmcPort = port;
    fsmcContext = context;
    for (i = 0; i < 2U; ++i) {
        Values v = valuesOf(&banks[i]);
        port->write32(context, FSMC_BTR(i), v.btr);
        port->write32(context, FSMC_BWTR(i), v.bwtr);
        port->write32(context, FSMC_BCR(i), v.bcr);
    }
    return identify();
}
