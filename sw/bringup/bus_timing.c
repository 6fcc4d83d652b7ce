/* SPDX-License-Identifier: MIT
 *
 * bus_timing: measures how late NOE, NE1, NE2 and NWAIT arrive, by shortening accesses until they
 * fail.
 *
 * Read path: the chip answers a read of a fetched block combinationally. In an access of mode A
 * with ADDSET 0, the delays of NE1, NOE, address and data together may be (DATAST - 1) HCLK - 4 ns.
 * With ADDSET 3, the limit for NOE is the same; NE1 and the address have 3 HCLK more. NWAIT: in
 * mode 1, NWAIT must be valid ADDSET HCLK after the start of an access.
 *
 * Multiplexed board: the chip stores the address when NADV rises, ADDSET HCLK after the start of an
 * access. The data pins carry the address for ADDHLD HCLK more; NADV may be late by this time.
 * NWAIT follows NOE, and must be valid (DATAST - 4) HCLK after it.
 */
#include "board_pins.h"
#include "bringup.h"
#include "bus.h"
#include "console.h"
#include "lines.h"
#include "map_regs.h"
#include "system_regs.h"
#include "timing.h"

#define BLOCK_HALFWORDS 32U
#define READ_SETUP 40U /* read set-up time of the FSMC minus one HCLK period, in 0.1 ns */
#define DRIVER_ADDSET 2U
#define DRIVER_ADDHLD 2U
#define MOST_ADDHLD 15U
#if BOARD_MUXED
#define LEAST_ADDSET DRIVER_ADDSET /* ADDSET of the fastest reads */
/* values of DATAST for the test of NWAIT, in HCLK cycles */
#define WAIT_FIELD "DATAST"
#define WAIT_SETTING "DATAST 6"
#define WAIT_FIRST 4U
#define WAIT_DRIVER 6U
#define WAIT_MOST 16U
#else
#define LEAST_ADDSET 0U
/* values of ADDSET for the test of NWAIT, in HCLK cycles */
#define WAIT_FIELD "ADDSET"
#define WAIT_SETTING "ADDSET 2"
#define WAIT_FIRST 0U
#define WAIT_DRIVER DRIVER_ADDSET
#define WAIT_MOST 12U
#endif

typedef struct Point {
    U8 datast, mhz;
} Point;

/* Timings to test, from the shortest read to the longest. */
static const Point points[] = {{3, 120}, {3, 110}, {3, 100}, {3, 90}, {4, 120}, {4, 110}, {4, 100},
                               {4, 90},  {4, 80},  {4, 70},  {4, 60}, {5, 60},  {6, 60}};
#define POINTS (sizeof points / sizeof points[0])
/* index of the timing with the longest read path that the driver allows; on a multiplexed board,
 * NWAIT limits the path */
#define DRIVER_POINT (BOARD_MUXED ? 2U : 4U)

static U32 budget(const Point* p) { /* in units of 0.1 ns */
    return (p->datast - 1U) * 10000UL / p->mhz - READ_SETUP;
}

static U16 pattern(U32 i) {
    return (U16)(i & 1U ? ~(0x0101UL * i) : 0x0101UL * i);
}

/* Makes the chip fetch a block from the memory, reads the block with this timing, and returns the
 * bits that were wrong in any of the reads. */
static U32 readErrors(U32 addset, U32 datast) {
    static const Bus_Timing patient = {15, 60, 0, 0, 15};
    Bus_Timing fast;
    U32 i, wrong = 0, round;
    fast.addset = addset;
    fast.datast = datast;
    fast.isModeA = 1;
    fast.waits = 0;
    fast.addhld = DRIVER_ADDHLD;
    for (round = 0; round < 4U; ++round) {
        Bus_set(0, &patient);
        (void)Bus_load(0);
        (void)Bus_load(2U * BLOCK_HALFWORDS - 2U);
        (void)Bus_load(0);
        Bus_set(0, &fast);
        for (i = 0; i < BLOCK_HALFWORDS; ++i)
            wrong |= (U32)(Bus_load(2U * i) ^ pattern(i));
    }
    Bus_setSlow();
    return wrong;
}

static U32 fastestRead(U32 addset, U32* bits) {
    U32 i;
    *bits = 0;
    for (i = 0; i < POINTS; ++i) {
        U32 wrong;
        Timing_setHclk(points[i].mhz * 1000000UL);
        wrong = readErrors(addset, points[i].datast);
        if (!wrong)
            break;
        *bits = wrong;
    }
    return i;
}

static int testReads(void) {
    U32 i, bits, later, unused;
    for (i = 0; i < BLOCK_HALFWORDS; ++i)
        Bus_store(2U * i, pattern(i));
    (void)Bus_read(MAP_SLOT_SYSTEM, SYSTEM_ID);
    i = fastestRead(LEAST_ADDSET, &bits);
    if (i > DRIVER_POINT) {
        later = fastestRead(LEAST_ADDSET + 3U, &unused);
        Timing_setHclk(120000000UL);
        Report_fail(later > DRIVER_POINT ? "NOE" : "NE1", 0, "late",
                    "reads at the driver's fastest timing return wrong data",
                    "the resistor, length and load of the wire; a buffer in it; for NE1 also those"
                    " of the address lines");
    }
    Timing_setHclk(120000000UL);
    if (i < POINTS) {
        Console_text("INFO read path ns: ");
        Console_fixed(i ? budget(&points[i - 1U]) : 0, 1);
        Console_text(" to ");
        Console_fixed(budget(&points[i]), 1);
        Console_text(", allowed ");
        Console_fixed(budget(&points[DRIVER_POINT]), 1);
        Console_text("; bits that fail first: ");
        Console_hex(bits, 4);
        Console_end();
    }
    return i <= DRIVER_POINT;
}

static int registersAreRight(void) {
    U32 i;
    for (i = 0; i < 12U; ++i) {
        if (Bus_read(MAP_SLOT_SYSTEM, SYSTEM_ID) != SYSTEM_ID_VALUE)
            return 0;
        if (Bus_read(MAP_SLOT_SYSTEM, SYSTEM_SCRATCH) != 0x2B6C9E51UL)
            return 0;
        Timing_pause(i);
    }
    return 1;
}

#define FAR_STEP 0x10000UL

static int memoryIsRight(void) {
    U32 i;
    for (i = 0; i < 12U; ++i)
        if (Bus_load(FAR_STEP * (i + 1U)) != pattern(3U * i + 1U))
            return 0;
    return 1;
}

/* Returns the smallest value of WAIT_FIELD with which accesses to a bank still wait for NWAIT. */
static U32 leastWait(U32 bank) {
    Bus_Timing t = {DRIVER_ADDSET, 4, 0, 1, DRIVER_ADDHLD};
    U32 n;
    int isRight = 0;
    for (n = WAIT_FIRST; n < WAIT_MOST; ++n) {
        if (BOARD_MUXED)
            t.datast = n;
        else
            t.addset = n;
        Bus_set(bank, &t);
        isRight = bank ? registersAreRight() : memoryIsRight();
        Bus_setSlow();
        (void)Bus_read(MAP_SLOT_SYSTEM, SYSTEM_ID);
        if (isRight)
            break;
    }
    return n;
}

static void storeFar(void) {
    U32 i;
    for (i = 0; i < 12U; ++i)
        Bus_store(FAR_STEP * (i + 1U), pattern(3U * i + 1U));
    (void)Bus_read(MAP_SLOT_SYSTEM, SYSTEM_ID);
}

#if BOARD_MUXED
/* Finds the smallest ADDHLD with which the chip stores the right addresses. */
static int testNadv(void) {
    Bus_Timing t = {15, 60, 0, 0, 1};
    int isRight = 0;
    storeFar();
    for (; t.addhld < MOST_ADDHLD && !isRight; t.addhld += !isRight) {
        Bus_set(0, &t);
        isRight = memoryIsRight();
        Bus_setSlow();
    }
    Console_text("INFO least ADDHLD for NADV: ");
    Console_number(t.addhld);
    Console_text(", driver 2");
    Console_end();
    if (t.addhld > DRIVER_ADDHLD)
        Report_fail("NADV", 0, "late", "the chip stores the address too late with ADDHLD 2",
                    "the resistor, length and load of the wire; a buffer in it");
    return t.addhld <= DRIVER_ADDHLD;
}
#else
static int testNadv(void) {
    return 1;
}
#endif

static void testNwait(void) {
    U32 memory, registers;
    const char* wire = 0;
    if (!Lines_idleNwait()) {
        Report_fail("NWAIT", 0, "stuck0", "low without an access",
                    "this line with line_tester; WAITPOL and WAIT_HIGH");
        return;
    }
    Bus_write(MAP_SLOT_SYSTEM, SYSTEM_SCRATCH, 0x2B6C9E51UL);
    storeFar();
    memory = leastWait(0);
    registers = leastWait(1);
    if (memory > WAIT_DRIVER && registers > WAIT_DRIVER)
        wire = "NWAIT";
    else if (registers > WAIT_DRIVER)
        wire = "NE2";
    else if (memory > WAIT_DRIVER)
        wire = "NE1";
    if (wire)
        Report_fail(wire, 0, "late", "the microcontroller sees NWAIT too late with " WAIT_SETTING,
                    "the resistor, length and load of the wire; a buffer in it");
    Console_text("INFO least " WAIT_FIELD " for NWAIT: memory ");
    Console_number(memory);
    Console_text(", registers ");
    Console_number(registers);
    Console_text(", driver ");
    Console_number(WAIT_DRIVER);
    Console_end();
}

void Bus_testTiming(void) {
    Report_step("timing", "the driver's fastest reads and its NWAIT are right at 120 MHz");
    if (testNadv() && testReads())
        testNwait();
    if (Report_pass()) {
        Console_text("reads and NWAIT");
        Console_end();
    }
}
