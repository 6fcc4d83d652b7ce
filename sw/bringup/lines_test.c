/* SPDX-License-Identifier: MIT
 *
 * lines_test: finds stuck, shorted, open, swapped and inverted lines, and names them.
 *
 * Without the FPGA, the microcontroller drives one line at a time and holds all others by weak
 * pull-ups or pull-downs: a line that follows is shorted to the driven line. With the FPGA, each
 * line transmits a different number, bit by bit and then inverted. The received number identifies
 * the line at the other end.
 */
#include "board_pins.h"
#include "bringup.h"
#include "console.h"
#include "lines.h"
#include "timing.h"

#define SETTLE_US 20U /* settling time: an open line of 100 pF with a pull of 40 kOhm */
/* size of the code that represents a line, bits: one more than the numbers of the lines need, so
 * that no code is the inverse of another code */
#define CODE_BITS 7U
#define CODE_MASK 127U
#define NONE 255U

typedef enum Fate {
    GOOD,
    STUCK,
    PULLED,
    DRIVEN_LOW,
    DRIVEN_HIGH,
    SHORTED,
    OPEN,
    MOVED,
    INVERTED
} Fate;

static U8 fate[LINES];
/* arrives[i]: number of the line; its code has arrived at the FPGA pin for line i */
static U8 arrives[LINES];

/* Returns whether only the FPGA drives this line in operation. Such a line may contain a buffer. */
static int isOutput(U32 line) {
    return line == LINE_NWAIT || line == LINE_IRQ;
}

/* Returns 1 if the line does not follow the pulls of the microcontroller, because another part
 * holds its level. */
static int isHeld(U32 line) {
    return fate[line] == STUCK || fate[line] == PULLED || fate[line] == DRIVEN_LOW ||
           fate[line] == DRIVEN_HIGH;
}

static int isTestable(U32 line) {
    return Lines_isWired(line) && fate[line] != STUCK && fate[line] != SHORTED;
}

static U32 codeOf(U32 line) {
    return line + 1U;
}

static U32 lineOf(U32 code) {
    return code >= 1U && code <= LINES ? code - 1U : NONE;
}

/* ---- alone ---- */

static void readAll(U8* levels) {
    U32 i;
    Timing_wait(SETTLE_US);
    for (i = 0; i < LINES; ++i)
        levels[i] = (U8)Lines_read(i);
}

static void reportStuck(U32 line, int high) {
    fate[line] = STUCK;
    if (high)
        Report_fail(Lines_name(line), 0, "stuck1", "high, although a pull-down is switched on",
                    "a short to 3.3 V, or another part that drives it");
    else
        Report_fail(Lines_name(line), 0, "stuck0", "low, although a pull-up is switched on",
                    "a short to ground, or another part that drives it");
}

/* Tests a line if its level does not depend on the pull: drives the line to the opposite level
 * `high`. Returns 1 if the line follows. */
static int follows(U32 line, int high) {
    int now;
    Lines_drive(line, high);
    Timing_wait(SETTLE_US);
    now = Lines_read(line);
    Lines_input(line, PULL_UP);
    return now == high;
}

static void reportPulled(U32 line, int high) {
    fate[line] = PULLED;
    Report_fail(Lines_name(line), 0, high ? "pulled1" : "pulled0",
                "it follows a driver, but not the pulls of the microcontroller",
                "another part on the line: an LED, a resistor, a solder bridge that is not open");
}

/* `found` is not 0 if the tester answers. In this case, a held line that the FPGA drives is not
 * reported here, because a later step with the tester can distinguish it from an inverted line. */
static void testStuck(U32 found) {
    U8 down[LINES], up[LINES];
    U32 i;
    Lines_release(PULL_DOWN);
    readAll(down);
    Lines_release(PULL_UP);
    readAll(up);
    for (i = 0; i < LINES; ++i) {
        if (!Lines_isWired(i) || down[i] != up[i])
            continue;
        if (follows(i, !up[i]))
            reportPulled(i, up[i]);
        else if (found && isOutput(i))
            fate[i] = up[i] ? DRIVEN_HIGH : DRIVEN_LOW;
        else
            reportStuck(i, up[i]);
    }
}

static void reportShort(U32 i, U32 k) {
    if (fate[i] == SHORTED && fate[k] == SHORTED)
        return;
    fate[i] = fate[k] = SHORTED;
    Report_fail(Lines_name(i < k ? i : k), Lines_name(i < k ? k : i), "short",
                "one follows when the other is driven",
                "a solder bridge between them, at the connectors and at both chips");
}

static void testShorts(void) {
    U8 levels[LINES];
    U32 i, k;
    Lines_release(PULL_DOWN);
    for (i = 0; i < LINES; ++i) {
        if (!Lines_isWired(i) || isHeld(i))
            continue;
        Lines_drive(i, 1);
        readAll(levels);
        Lines_input(i, PULL_DOWN);
        for (k = 0; k < LINES; ++k)
            if (k != i && levels[k] && !isHeld(k))
                reportShort(i, k);
    }
    Timing_wait(SETTLE_US);
}

/* Least number of driven data lines that indicates another chip. Fewer driven lines may be shorts
 * to NE1 or NOE. */
#define LEAST_DRIVEN 4U

/* Returns the number of data lines that another chip drives while NE1 and NOE are low. */
static U32 drivenWhenSelected(void) {
    U8 apart[LINES], selected[LINES];
    U32 i, driven = 0, pull;
    Lines_release(PULL_UP); /* NE2, NWE and NBL1 stay high, so that the tester sees no frame */
    for (pull = (U32)PULL_UP; pull <= (U32)PULL_DOWN; ++pull) {
        for (i = LINE_D0; i < LINE_D0 + 16U; ++i)
            Lines_input(i, (Pull)pull);
        Lines_drive(LINE_NE1, 1);
        Lines_drive(LINE_NOE, 1);
        readAll(apart);
        Lines_drive(LINE_NE1, 0);
        Lines_drive(LINE_NOE, 0);
        readAll(selected);
        for (i = 0; i < 16U; ++i)
            driven += (U32)(apart[i] == (pull == (U32)PULL_UP) && selected[i] != apart[i]);
    }
    Lines_release(PULL_UP);
    return driven;
}

int Lines_testAlone(U32 found) {
    U32 i, count = 0;
    for (i = 0; i < LINES; ++i) {
        fate[i] = GOOD;
        count += (U32)Lines_isWired(i);
    }
    Report_step("shorts", "no line is stuck, and none follows another one");
    if (found && drivenWhenSelected() >= LEAST_DRIVEN) {
        Report_fail("D", 0, "second-driver",
                    "another chip drives the data lines while NE1 and NOE are low",
                    "a memory of the evaluation board on NE1: remove its jumper or solder bridge,"
                    " or disable it");
        return 0;
    }
    testStuck(found);
    testShorts();
    if (Report_pass()) {
        Console_number(count);
        Console_text(" lines follow their pulls and no other line");
        Console_end();
    }
    return 1;
}

/* ---- through the FPGA ---- */

static int bitOf(U32 code, U32 pass) {
    return (int)(pass < CODE_BITS ? code >> pass & 1U : ~code >> (pass - CODE_BITS) & 1U);
}

static int failExchange(void) {
    Report_fail("FPGA", 0, "silent", "the tester no longer answers",
                "the supply of the FPGA, and whether its configuration is lost");
    return 0;
}

/* Sends the number of each line from the microcontroller: first normal, then inverted. Fills
 * `first` and `second` with the numbers that the pins of the FPGA have received. */
static int sendCodes(U8* first, U8* second) {
    Answer answer;
    U32 i, pass;
    for (i = 0; i < LINES; ++i)
        first[i] = second[i] = 0;
    Lines_release(PULL_DOWN);
    for (pass = 0; pass < 2U * CODE_BITS; ++pass) {
        for (i = 0; i < LINES; ++i)
            if (isTestable(i) && !Lines_isChannels(i) && !isOutput(i))
                Lines_drive(i, bitOf(codeOf(i), pass));
        if (!Lines_exchange(&answer))
            return failExchange();
        for (i = 0; i < LINES; ++i)
            if (Pins_get(&answer.pins, i)) {
                U8* seen = pass < CODE_BITS ? first : second;
                seen[i] = (U8)(seen[i] | 1U << pass % CODE_BITS);
            }
    }
    Lines_release(PULL_DOWN);
    return 1;
}

/* Makes the FPGA send the numbers of the lines that it drives in operation. The microcontroller
 * reads all lines. */
static int receiveCodes(U8* first, U8* second) {
    Answer answer;
    U32 i, pass;
    for (i = 0; i < LINES; ++i)
        first[i] = second[i] = 0;
    for (pass = 0; pass <= 2U * CODE_BITS; ++pass) {
        Lines_release(pass & 1U ? PULL_DOWN : PULL_UP);
        for (i = 0; i < LINES; ++i) {
            int sends = isTestable(i) && !Lines_isChannels(i) && (i < LINE_A0 || isOutput(i)) &&
                        pass < 2U * CODE_BITS;
            Pins_set(&lines_enable, i, sends);
            Pins_set(&lines_value, i, sends && bitOf(codeOf(i), pass));
        }
        if (!Lines_exchange(&answer))
            return failExchange();
        if (pass == 2U * CODE_BITS)
            break;
        Timing_wait(SETTLE_US);
        for (i = 0; i < LINES; ++i)
            if (!Lines_isChannels(i) && Lines_read(i)) {
                U8* seen = pass < CODE_BITS ? first : second;
                seen[i] = (U8)(seen[i] | 1U << pass % CODE_BITS);
            }
    }
    Lines_release(PULL_DOWN);
    return 1;
}

static void reportOpen(U32 line, const char* seen) {
    fate[line] = OPEN;
    Report_fail(Lines_name(line), 0, "open", seen,
                "the wire, both solder joints, the contact of the connector, and the pin's number");
}

static void reportInverted(U32 line) {
    fate[line] = INVERTED;
    Report_fail(Lines_name(line), 0, "inverted", "arrives with the opposite level",
                "an inverting buffer or transistor in the line; the wire must go straight");
}

static void reportMoved(U32 pin, U32 line) {
    fate[pin] = fate[line] = MOVED;
    Report_fail(Lines_name(pin < line ? pin : line), Lines_name(pin < line ? line : pin), "swapped",
                "the level of one arrives at the other",
                "the two wires at both connectors, and the numbers of the pins");
}

static void judgeSent(const U8* first, const U8* second) {
    U32 i;
    for (i = 0; i < LINES; ++i) {
        arrives[i] = NONE;
        if (!isTestable(i) || Lines_isChannels(i) || isOutput(i))
            continue;
        if (first[i] == codeOf(i) && (second[i] ^ first[i]) == CODE_MASK)
            continue;
        if (second[i] == codeOf(i) && (second[i] ^ first[i]) == CODE_MASK)
            reportInverted(i);
        else if ((second[i] ^ first[i]) == CODE_MASK)
            arrives[i] = (U8)lineOf(first[i]);
        if (fate[i] == GOOD && arrives[i] == NONE)
            fate[i] = OPEN;
    }
}

#define ADDRESS_LINES 25U
#define LEAST_SHIFTED 4U

/* Detects address lines that are shifted: each line is wired to the next address pin, for example
 * A0 to A1. */
static void testShift(void) {
    U32 i, count = 0;
    for (i = LINE_A0 + 1U; i < LINE_A0 + ADDRESS_LINES; ++i)
        count += (U32)(arrives[i] == i - 1U);
    if (count < LEAST_SHIFTED)
        return;
    for (i = LINE_A0; i < LINE_A0 + ADDRESS_LINES; ++i) {
        fate[i] = MOVED;
        arrives[i] = NONE;
    }
    Report_fail(BOARD_MUXED ? "A16" : "A0", "A24", "shifted",
                "each address line arrives at the next number",
                BOARD_MUXED ? "that A16 goes to A16"
                            : "that A0 goes to A0: with 16 bits of data, A0 is the address of a"
                              " halfword");
}

/* Finds lines that the FPGA drives and that arrive at the microcontroller's pin of another line. */
static void judgeReceived(const U8* first, const U8* second) {
    U32 i, from;
    for (i = 0; i < LINES; ++i) {
        if (!Lines_isWired(i) || Lines_isChannels(i) || (second[i] ^ first[i]) != CODE_MASK)
            continue;
        from = lineOf(first[i]);
        if (isOutput(i) && second[i] == codeOf(i))
            reportInverted(i);
        else if (from != NONE && from != i && isTestable(from) && isTestable(i) &&
                 fate[i] != MOVED && (from < LINE_A0 || isOutput(from)))
            reportMoved(i, from);
    }
    for (i = 0; i < LINES; ++i)
        if (fate[i] == DRIVEN_LOW || fate[i] == DRIVEN_HIGH)
            reportStuck(i, fate[i] == DRIVEN_HIGH);
        else if (isOutput(i) && fate[i] == GOOD && !Lines_isChannels(i) && first[i] != codeOf(i))
            reportOpen(i, "driven by the FPGA, and the microcontroller's pin does not follow");
        else if (i < LINE_A0 && fate[i] == GOOD && !Lines_isChannels(i) && first[i] != codeOf(i))
            reportOpen(i, "driven by the FPGA, and the microcontroller's pin does not follow;"
                          " the other direction works");
}

void Lines_testThrough(U32 found) {
    U8 first[LINES], second[LINES];
    U32 i, count = 0;
    Report_step("wires",
                "each line carries its number to the FPGA, and back if the FPGA drives it");
    if (!sendCodes(first, second))
        return;
    judgeSent(first, second);
    testShift();
    if (!receiveCodes(first, second))
        return;
    for (i = 0; i < LINES; ++i)
        if (arrives[i] != NONE && fate[i] != MOVED && fate[i] != INVERTED)
            reportMoved(i, arrives[i]);
    judgeReceived(first, second);
    for (i = 0; i < LINES; ++i) {
        if (fate[i] == OPEN && !isOutput(i) && arrives[i] == NONE)
            reportOpen(i, "driven by the microcontroller, and the FPGA's pin does not follow");
        count += (U32)(Lines_isWired(i) && fate[i] == GOOD);
    }
    if (Report_pass()) {
        Console_number(count);
        Console_text(" lines; the tester answers on ");
        Console_number((found & 1U) + (found >> 1 & 1U) + (found >> 2));
        Console_text(" of 3 channels");
        Console_end();
    }
}

/* ---- the FPGA's clock ---- */

#define BANK_OF_CLOCK TEXT_OF(BOARD_BANK_CLOCK)
#define MEASURED_US 1000U
#define PULSES 10U

static void testEdges(void) {
    Answer before, after;
    U32 i;
    if (Lines_isChannels(LINE_NWE) || fate[LINE_NWE] != GOOD)
        return;
    Lines_drive(LINE_NWE, 1);
    (void)Lines_exchange(&before);
    for (i = 0; i < PULSES; ++i) {
        Lines_drive(LINE_NWE, 0);
        Timing_wait(1);
        Lines_drive(LINE_NWE, 1);
        Timing_wait(1);
    }
    (void)Lines_exchange(&after);
    if (((after.edges - before.edges) & 0xFFU) != PULSES)
        Report_fail("NWE", 0, "ringing", "the FPGA sees more rising edges than were sent",
                    "a resistor of 33 to 100 ohm in the line at the microcontroller, the length of"
                    " the wire, and ground wires next to it");
}

void Lines_testClock(void) {
    Answer before, after;
    U32 from, us, khz;
    Report_step("clock", "the FPGA's clock is within 0.5 % of its rate, and NWE has clean edges");
    Lines_release(PULL_UP);
    from = Timing_cycles();
    (void)Lines_exchange(&before);
    Timing_wait(MEASURED_US);
    us = Timing_cycles();
    (void)Lines_exchange(&after);
    us = ((us - from) & 0xFFFFFFU) / Timing_mhz();
    khz = ((after.clocks - before.clocks) & 0xFFFFU) * 64000UL / us;
    if (khz == 0)
        Report_fail("CLK", 0, "no-clock", "the FPGA's clock input does not move",
                    "the oscillator, its supply and enable pin, the supply of bank " BANK_OF_CLOCK
                    " of the FPGA, and the pin's number in the UCF");
    else if (khz < BOARD_FPGA_HZ / 1000UL * 995UL / 1000UL ||
             khz > BOARD_FPGA_HZ / 1000UL * 1005UL / 1000UL) {
        Report_fail("CLK", 0, "wrong-rate", "the FPGA's clock has another rate",
                    "the oscillator's marking; the microcontroller's crystal");
        Console_text("INFO FPGA clock MHz: ");
        Console_fixed(khz, 3);
        Console_end();
    }
    testEdges();
    if (Report_pass()) {
        Console_fixed(khz, 3);
        Console_text(" MHz, expected ");
        Console_fixed(BOARD_FPGA_HZ / 1000UL, 3);
        Console_end();
    }
}
