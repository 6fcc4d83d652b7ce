/* SPDX-License-Identifier: MIT
 *
 * memory: tests DDR3, and names faulty lines. A faulty data line shows as a bit that is wrong in
 * all beats of a burst. A faulty address line shows as two addresses that reach the same place.
 *
 * A halfword is a beat on DQ15..DQ0. In a byte address, bits 10..1 are the column, 13..11 the bank,
 * 26..14 the row (MIG's ROW_BANK_COLUMN). Row and column share the lines A9..A0.
 */
#include "bringup.h"
#include "bus.h"
#include "console.h"
#include "map_regs.h"
#include "system_regs.h"
#include "timing.h"

#define ROW_AT 14U
#define ROW_LINES 13U
#define BANK_AT 11U
#define BANK_LINES 3U
#define TOP_BIT 27U
#define BURST_BYTES 16U
#define BEATS 8U
#define CHECK_MODULE "the solder joints of FPGA and DDR3; on a module on sale: another module"

static char name[12];

static const char* numbered(const char* text, U32 number) {
    U32 at = 0;
    for (; text[at]; ++at)
        name[at] = text[at];
    if (number >= 10U)
        name[at++] = (char)('0' + number / 10U);
    name[at++] = (char)('0' + number % 10U);
    name[at] = 0;
    return name;
}

/* Reads once with NWAIT. If the memory never answers, this read ends with an error. */
static int isCalibrated(void) {
    static const Bus_Timing patient = {15, 60, 0, 1, 15};
    U32 event;
    Bus_write(MAP_SLOT_SYSTEM, SYSTEM_EVENT, SYSTEM_EVENT_BUS_ERROR_MASK);
    (void)Bus_read(MAP_SLOT_SYSTEM, SYSTEM_EVENT);
    Bus_set(0, &patient);
    (void)Bus_load(0);
    Bus_setSlow();
    event = Bus_read(MAP_SLOT_SYSTEM, SYSTEM_EVENT);
    Bus_write(MAP_SLOT_SYSTEM, SYSTEM_EVENT, SYSTEM_EVENT_BUS_ERROR_MASK);
    return !(event & SYSTEM_EVENT_BUS_ERROR_MASK);
}

/* Writes back buffered data, and discards data that was read ahead. */
static void flush(void) {
    (void)Bus_read(MAP_SLOT_SYSTEM, SYSTEM_ID);
}

/* Writes a burst in which `pattern` and its inverse alternate, and reads it back. Returns the bits
 * that were wrong in at least one beat. */
static U32 dataErrors(U16 pattern, U32* ones, U32* zeros) {
    U32 beat, seen, wrong = 0;
    for (beat = 0; beat < BEATS; ++beat)
        Bus_store(2U * beat, (U16)(beat & 1U ? ~pattern : pattern));
    flush();
    for (beat = 0; beat < BEATS; ++beat) {
        seen = Bus_load(2U * beat);
        wrong |= seen ^ (U16)(beat & 1U ? ~pattern : pattern);
        *ones &= seen;
        *zeros &= ~seen;
    }
    return wrong & 0xFFFFU;
}

static void reportPair(const char* text, U32 i, U32 k, const char* seen) {
    char first[sizeof name];
    U32 at;
    (void)numbered(text, i);
    for (at = 0; at < sizeof name; ++at)
        first[at] = name[at];
    Report_fail(first, numbered(text, k), "short", seen, CHECK_MODULE);
}

static void testData(void) {
    U32 bit, k, wrong = 0, ones = 0xFFFFU, zeros = 0xFFFFU, pairs = 0;
    for (bit = 0; bit < 16U; ++bit)
        wrong |= dataErrors((U16)(1U << bit), &ones, &zeros);
    if ((wrong & 0xFFU) == 0xFFU || wrong >> 8 == 0xFFU) {
        for (k = 0; k < 2U; ++k)
            if ((wrong >> 8U * k & 0xFFU) != 0xFFU)
                continue;
            else if (((ones | zeros) >> 8U * k & 0xFFU) == 0xFFU)
                Report_fail(k ? "DDR_UDM" : "DDR_LDM", 0, "stuck1", "this byte is never written",
                            CHECK_MODULE);
            else
                Report_fail(k ? "DDR_UDQS" : "DDR_LDQS", 0, "open",
                            "all bits of this byte are wrong", CHECK_MODULE);
        return;
    }
    for (bit = 0; bit < 16U; ++bit) {
        if (!(wrong >> bit & 1U))
            continue;
        if ((ones | zeros) >> bit & 1U) {
            Report_fail(numbered("DDR_DQ", bit), 0, ones >> bit & 1U ? "stuck1" : "stuck0",
                        "the bit never changes", CHECK_MODULE);
            continue;
        }
        for (k = bit + 1U; k < 16U; ++k)
            if (wrong >> k & 1U && !((ones | zeros) >> k & 1U) && !(pairs >> k & 1U)) {
                reportPair("DDR_DQ", bit, k, "both bits are only high together");
                pairs |= 1UL << bit | 1UL << k;
                break;
            }
        if (!(pairs >> bit & 1U))
            Report_fail(numbered("DDR_DQ", bit), 0, "wrong", "the bit is sometimes wrong",
                        CHECK_MODULE);
    }
}

/* Tests the data masks: bytes that are not written must keep their values. */
static void testMasks(void) {
    U32 lane, seen;
    for (lane = 0; lane < 2U; ++lane) {
        Bus_store(0, 0xA5C3U);
        Bus_store(8, 0x1188U); /* the chip's buffer keeps its last bytes */
        flush();
        Bus_storeByte(lane, 0x3CU);
        flush();
        seen = Bus_load(0);
        if ((seen >> 8U * lane & 0xFFU) != 0x3CU)
            Report_fail(lane ? "DDR_UDM" : "DDR_LDM", 0, "stuck1", "this byte is never written",
                        CHECK_MODULE);
        else if (seen != (lane ? 0x3CC3U : 0xA53CU))
            Report_fail(lane ? "DDR_LDM" : "DDR_UDM", 0, "stuck0",
                        "this byte is written although only the other one should be", CHECK_MODULE);
    }
}

/* Returns 1 if `address` and address 0 are the same place in memory. */
static int isAlias(U32 address) {
    Bus_store(0, 0x1234U);
    flush();
    Bus_store(address, 0xEDCBU);
    flush();
    return Bus_load(0) != 0x1234U;
}

static void reportAddress(const char* text, U32 lines, U32 at, U32 same) {
    U32 i, k, paired = 0;
    for (i = 0; i < lines; ++i) {
        if (!(same >> i & 1U) || paired >> i & 1U)
            continue;
        for (k = i + 1U; k < lines; ++k)
            if (same >> k & 1U && !isAlias(1UL << (at + i) | 1UL << (at + k)))
                break;
        if (k == lines) {
            Report_fail(numbered(text, i), 0, "stuck",
                        "addresses that differ in it reach the same place", CHECK_MODULE);
            continue;
        }
        paired |= 1UL << k;
        reportPair(text, i, k, "only both together have an effect");
    }
}

static void testAddress(void) {
    U32 bit, same = 0;
    for (bit = 4; bit < TOP_BIT; ++bit)
        if (isAlias(1UL << bit))
            same |= 1UL << bit;
    reportAddress("DDR_A", ROW_LINES, ROW_AT, same >> ROW_AT);
    reportAddress("DDR_BA", BANK_LINES, BANK_AT, same >> BANK_AT & 7U);
    if (same && !Report_stepFailures())
        Report_fail("DDR", 0, "addresses", "columns of the same row are mixed up",
                    "the memory controller's settings in MIG: part, row and column bits");
}

/* Fills the memory with a function of the address, waits, and compares. Returns the number of
 * errors. */
static U32 testCells(U32 bytes, U32 step) {
    U32 at, wrong = 0;
    for (at = 0; at < bytes; at += step)
        Bus_store(at, (U16)(at >> 1 ^ at >> 12 ^ 0x5A5AU));
    flush();
    Timing_wait(bringup_limits.retentionMs * 1000UL);
    for (at = 0; at < bytes; at += step)
        wrong += Bus_load(at) != (U16)(at >> 1 ^ at >> 12 ^ 0x5A5AU);
    return wrong;
}

int Bus_testMemory(void) {
    U32 wrong, bytes = bringup_limits.patternKib ? bringup_limits.patternKib << 10
                                                 : 1UL << MAP_DDR_BYTES_LOG2;
    Report_step("memory", "DDR3: every data, mask, bank and address line; cells keep their values");
    if (!isCalibrated()) {
        Report_fail(
            "DDR", 0, "no-calibration", "the memory controller does not finish its calibration",
            "1.5 V and VREF of the memory; CK, CKE, RAS, CAS, WE, RESET, ODT; RZQ and ZIO as"
            " in MIG");
        return 0;
    }
    testData();
    if (!Report_stepFailures())
        testMasks();
    if (!Report_stepFailures())
        testAddress();
    wrong = Report_stepFailures() ? 0 : testCells(bytes, 2);
    if (wrong)
        Report_fail("DDR", 0, "cells", "cells have lost their values",
                    "refresh, supply, and the temperature of the memory");
    if (Report_pass()) {
        Console_number(bytes >> 10);
        Console_text(" KiB, kept for ms: ");
        Console_number(bringup_limits.retentionMs);
        Console_end();
    }
    return !Report_stepFailures();
}
