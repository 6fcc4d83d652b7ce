/* SPDX-License-Identifier: MIT
 *
 * lines_modem: finds bad wires between FPGA and modem, without sending a command to the modem.
 *
 * An idle XBee drives DOUT (our RXD) high and CTS low, and has pull-ups at DIN (our TXD), RTS and
 * RESET. While RESET is low, the XBee drives no pin. The tester has a pull-down at RXD and a
 * pull-up at CTS (synth/ise/lines.ucf). After the tester has driven a pin and released it, the
 * level shows what is connected: a driver changes it at once, a pull-up or pull-down after a
 * microsecond, and an open pin keeps its level.
 */
#include "board_pins.h"
#include "bringup.h"
#include "console.h"
#include "lines.h"
#include "timing.h"

#define SETTLE_US 10U /* settling time of a line of 100 pF with a pull of 50 kOhm, us */
#define OUTPUT_CHECK \
    "the wire, the socket's contact and the pin's number (the modem's pull-ups, PR, must be on)"

typedef struct Levels {
    U8 rxd, txd, cts, rts, reset;
} Levels;

static Levels now, early;

static Levels levelsOf(const Pins* pins) {
    Levels l;
    l.rxd = (U8)Pins_get(pins, PIN_RXD);
    l.txd = (U8)Pins_get(pins, PIN_TXD);
    l.cts = (U8)Pins_get(pins, PIN_CTS);
    l.rts = (U8)Pins_get(pins, PIN_RTS);
    l.reset = (U8)Pins_get(pins, PIN_RESET);
    return l;
}

/* Sets the level with which the tester must drive a pin; level 2 releases the pin. */
static void set(U32 pin, U32 level) {
    Pins_set(&lines_enable, pin, level != 2U);
    Pins_set(&lines_value, pin, level == 1U);
}

/* Applies the settings, and reads the levels twice: shortly afterwards (early), and when they have
 * settled (now). */
static void look(void) {
    Answer answer;
    (void)Lines_exchange(&answer);
    Timing_wait(SETTLE_US);
    (void)Lines_exchange(&answer);
    now = levelsOf(&answer.pins);
    early = levelsOf(&answer.early);
}

static void fail(U32 pin, U32 second, const char* kind, const char* seen, const char* check) {
    Report_fail(Lines_name(pin), second ? Lines_name(second) : 0, kind, seen, check);
}

static void failStuck(U32 pin, U32 high) {
    if (high)
        fail(pin, 0, "stuck1", "high, although the FPGA drives it low",
             "a short to 3.3 V, or another part that drives it");
    else
        fail(pin, 0, "stuck0", "low, although the FPGA drives it high",
             "a short to ground, or another part that drives it");
}

static U32 levelOf(const Levels* levels, U32 pin) {
    return pin == PIN_RXD   ? levels->rxd
           : pin == PIN_TXD ? levels->txd
           : pin == PIN_CTS ? levels->cts
           : pin == PIN_RTS ? levels->rts
                            : levels->reset;
}

/* Drives a pin to both levels and reads the levels back. Returns 0 if the pin is stuck. */
static int follows(U32 pin) {
    U32 level;
    for (level = 0; level < 2U; ++level) {
        set(pin, level);
        look();
        if (levelOf(&now, pin) != level) {
            set(pin, 2);
            failStuck(pin, !level);
            return 0;
        }
    }
    set(pin, 2);
    return 1;
}

/* Tests a line to the modem. After the tester has driven the line low and released it, the modem's
 * pull-up must slowly raise it. */
static void testOutput(U32 pin) {
    if (!follows(pin))
        return;
    set(pin, 0);
    look();
    set(pin, 2);
    look();
    if (!levelOf(&now, pin))
        fail(pin, 0, "open", "stays low when the FPGA releases it: the modem's pull-up is missing",
             OUTPUT_CHECK);
}

static void failShort(U32 first, U32 second) {
    fail(first, second, "short", "one follows when the other is driven",
         "a solder bridge between them, at the socket and at the FPGA");
}

/* While the modem is in reset, nothing else drives these lines. */
static int testShorts(void) {
    static const U8 outputs[2] = {PIN_TXD, PIN_RTS};
    U32 i, found = Report_stepFailures();
    for (i = 0; i < 2U; ++i) {
        set(outputs[i], 1);
        look();
        if (now.rxd)
            failShort(PIN_RXD, outputs[i]);
        set(outputs[i], 0);
        look();
        if (!now.cts)
            failShort(outputs[i] < PIN_CTS ? outputs[i] : PIN_CTS,
                      outputs[i] < PIN_CTS ? PIN_CTS : outputs[i]);
        set(outputs[i], 2);
    }
    return Report_stepFailures() == found;
}

static void waitForModem(void) {
    U32 ms;
    set(PIN_RESET, 2);
    look();
    for (ms = 0; ms < bringup_limits.modemBootMs && !(now.rxd && !now.cts); ++ms) {
        Timing_wait(1000);
        look();
    }
}

/* RXD is low while the modem is idle. */
static void testSilentRxd(void) {
    set(PIN_TXD, 0);
    look();
    set(PIN_TXD, 2);
    look();
    if (early.txd) {
        fail(PIN_RXD, PIN_TXD, "swapped", "the modem drives TXD, and nothing drives RXD",
             "that the modem's DOUT (pin 2) goes to RXD and its DIN (pin 3) to TXD");
        return;
    }
    set(PIN_RXD, 1);
    look();
    set(PIN_RXD, 2);
    look();
    if (!early.rxd && now.cts)
        fail(PIN_RXD, PIN_CTS, "swapped", "something drives RXD low, and CTS high",
             "the two wires at the socket");
    else if (now.cts && !now.txd && !now.rts && !now.reset)
        Report_fail("MODEM", 0, "silent", "no line of the modem is driven or pulled",
                    "that a modem is in its socket, and its 3.3 V supply");
    else
        fail(PIN_RXD, 0, "open", "nothing drives it", "the wire, and the socket's contact (pin 2)");
}

static void testSilentCts(void) {
    set(PIN_RTS, 1);
    look();
    set(PIN_RTS, 2);
    look();
    if (!early.rts) {
        fail(PIN_CTS, PIN_RTS, "swapped", "the modem drives RTS, and nothing drives CTS",
             "the two wires at the socket: CTS is its pin 12, RTS its pin 16");
        return;
    }
    fail(PIN_CTS, 0, "open", "nothing drives it low",
         "the wire, the socket's contact (pin 12), and that the modem's D7 is 1");
}

/* Returns 1 if the modem reacts to RESET. */
static int testReset(void) {
    set(PIN_RESET, 1);
    look();
    if (!now.reset) {
        failStuck(PIN_RESET, 0);
        set(PIN_RESET, 2);
        return 0;
    }
    set(PIN_RESET, 0);
    look();
    if (now.reset)
        failStuck(PIN_RESET, 1);
    else if (now.rxd && !now.cts)
        fail(PIN_RESET, 0, "open", "the modem does not react to it",
             "the wire, and the socket's contact (pin 5)");
    else
        return 1;
    set(PIN_RESET, 2);
    return 0;
}

/* Returns 1 if the FPGA can drive at least one of its outputs to the modem high, which shows that
 * the bank of these pins has a supply. */
static int isBankPowered(void) {
    set(PIN_TXD, 1);
    set(PIN_RTS, 1);
    set(PIN_RESET, 1);
    look();
    set(PIN_TXD, 2);
    set(PIN_RTS, 2);
    set(PIN_RESET, 2);
    return now.txd || now.rts || now.reset;
}

void Lines_testModem(void) {
    static const Pins none;
    Report_step("modem-wires", "the modem answers to RESET, drives RXD and CTS, pulls TXD and RTS");
    lines_enable = lines_value = none;
    if (!isBankPowered()) {
        Report_fail("BANK" TEXT_OF(BOARD_BANK_MODEM_RESET), 0, "no-supply",
                    "all lines of the modem are low, although the FPGA drives them high",
                    "VCCO of this bank of the FPGA, 3.3 V");
        return;
    }
    look();
    if (!testReset())
        return;
    /* both lines can be tested, because the modem drives no pin during a reset */
    (void)follows(PIN_RXD);
    (void)follows(PIN_CTS);
    if (!Report_stepFailures() && testShorts()) {
        waitForModem();
        if (!now.rxd)
            testSilentRxd();
        else if (now.cts)
            testSilentCts();
        else {
            testOutput(PIN_TXD);
            testOutput(PIN_RTS);
        }
    }
    lines_enable = lines_value = none;
    look();
    if (Report_pass()) {
        Console_text("5 lines");
        Console_end();
    }
}
