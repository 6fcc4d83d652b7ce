/* SPDX-License-Identifier: MIT
 *
 * bringup: a self-test for the first power-on of a board. It runs from RAM, without a kernel, and
 * reports on the UART of the console (console.h).
 *
 * Each step relies on the earlier steps. The wires are tested while the FPGA is loaded with
 * line_tester. For all other tests, the FPGA is loaded with the chip.
 */
#include "bringup.h"
#include "board_pins.h"
#include "bus.h"
#include "console.h"
#include "lines.h"
#include "program_memory.h"
#include "stm32f2.h"
#include "timing.h"
#include "watchdog.h"

Bringup_Limits bringup_limits = {BRINGUP_ALL, 1000, 1100, 0, 500, 16000};

int main(void);
void Reset_Handler(void);

static void testClock(const Timing_Clock* clock) {
    Report_step("supply", "the microcontroller runs from its crystal at 120 MHz");
    if (!clock->isCrystal)
        Report_fail("HSE", 0, "no-clock", "the crystal does not oscillate",
                    "the crystal and its capacitors, or the clock of the ST-LINK and its solder"
                    " bridges; later figures are within 1 % only");
    if (Report_pass()) {
        Console_number(clock->hclkHz / 1000000UL);
        Console_text(" MHz");
        Console_end();
    }
}

/* Returns the channels on which line_tester answers, one bit each. */
static U32 testContact(void) {
    U32 found = Lines_find();
    Report_step("contact", "the FPGA answers with line_tester or with the chip");
    if (found && Report_pass()) {
        Console_text("line_tester");
        Console_end();
    }
    return found;
}

static void testWires(U32 found) {
    if (bringup_limits.steps & BRINGUP_WIRES) {
        if (!Lines_testAlone(found))
            return;
        Lines_testThrough(found);
    }
    if (bringup_limits.steps & BRINGUP_CLOCK)
        Lines_testClock();
    if (bringup_limits.steps & BRINGUP_MODEM_WIRES)
        Lines_testModem();
}

static void testChip(void) {
    U32 steps = bringup_limits.steps;
    if (steps & BRINGUP_BUS) {
        Bus_testWrites();
        Bus_testData();
    }
    if (steps & BRINGUP_MEMORY && Bus_testMemory() && steps & BRINGUP_TIMING)
        Bus_testTiming();
    if (steps & BRINGUP_BUS)
        Bus_testInterrupt();
    if (steps & BRINGUP_MODEM)
        Bus_testModem();
}

static void end(void) {
    Console_text("END ");
    Console_number(Report_failures());
    Console_end();
}

int main(void) {
    const Timing_Clock* clock = Timing_start();
    const char* hung = Watchdog_hungStep();
    U32 found;
    Console_start(clock->hclkHz / 2U);
    Console_text("BOARD " BOARD_NAME);
    Console_end();
    if (hung) {
        Report_step(hung, "the step ends");
        Report_fail("MCU", 0, "hung", "the watchdog has ended the step",
                    "NWAIT: an access waits as long as it is low; the supply of the FPGA");
        end();
        return 0;
    }
    Watchdog_start(bringup_limits.watchdogMs);
    testClock(clock);
    found = testContact();
    if (found) {
        testWires(found);
        Console_text("NEXT load the chip's bitstream, and start the self-test again");
        Console_end();
    } else if (Bus_start()) {
        if (Report_pass()) {
            Console_text("chip");
            Console_end();
        }
        testChip();
    } else if (Bus_isShifted()) {
        Report_fail("D", 0, "shifted", "each read returns the halfword of the previous read",
                    "the bitstream: no register may delay the data; the FSMC's mode is asynchronous"
                    " (CBURSTRW, BURSTEN and FACCEN as in sw/fsmc)");
    } else {
        Report_fail("FPGA", 0, "silent", "neither line_tester nor the chip answers",
                    "that a bitstream is loaded (DONE is high), 1.2 V of the FPGA, and VCCO of"
                    " bank " TEXT_OF(BOARD_BANK_NE1) ", 3.3 V");
        (void)Lines_testAlone(0);
    }
    end();
    return 0;
}

/* ---- start ---- */

static void halt(void) {
    for (;;)
        Watchdog_feed();
}

static void fault(void) {
    Console_text("FAIL program CPU fault: the program has stopped; check: the supply of the"
                 " microcontroller");
    Console_end();
    halt();
}

__attribute__((section(".vectors"), used)) static const Vector vectors[16] = {
    stack_top, /* initial stack pointer, not a function */
    Reset_Handler, fault, fault, fault, fault, fault, 0, 0, 0, 0, fault, fault, 0, fault, fault};

void Reset_Handler(void) {
    SCB_VTOR = (U32)vectors;
    startMemory();
    (void)main();
    halt();
}
