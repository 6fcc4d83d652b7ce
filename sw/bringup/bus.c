/* SPDX-License-Identifier: MIT
 *
 * bus: accesses to the bus, and the tests of registers, writes, interrupt and modem.
 */
#include "bus.h"
#include "board_pins.h"
#include "bringup.h"
#include "console.h"
#include "lines.h"
#include "map_regs.h"
#include "modem_regs.h"
#include "stm32f2.h"
#include "system_regs.h"
#include "timing.h"
#include "watchdog.h"

/* Registers of the FSMC (RM0033, 31.5.6). */
#define BCR(bank) REG(0xA0000000UL + 8UL * (bank))
#define BTR(bank) REG(0xA0000004UL + 8UL * (bank))
#define BWTR(bank) REG(0xA0000104UL + 8UL * (bank))
#define BCR_ON 0x1091UL /* enabled, 16 bits wide, reserved bit 7 set, writes allowed */
#define BCR_MUXED 0x6UL /* multiplexed, PSRAM */
#define BCR_EXTMOD (1UL << 14)
#define BCR_ASYNCWAIT (1UL << 15)
#define BUSTURN(n) ((n) << 16)
#define WINDOW_MASK ((1UL << MAP_DDR_WINDOW_LOG2) - 1UL)

static const Bus_Timing slow = {15, 255, 0, 0, 15};
static U32 page;

void Bus_set(U32 bank, const Bus_Timing* t) {
#if BOARD_MUXED
    /* NOE always falls after the address phase, so mode A is not needed. */
    BTR(bank) = t->addset | t->addhld << 4 | t->datast << 8 | BUSTURN(2UL);
    BCR(bank) = BCR_ON | BCR_MUXED | (t->waits ? BCR_ASYNCWAIT : 0);
#else
    U32 time = t->addset | t->datast << 8 | BUSTURN(1UL);
    BTR(bank) = time;
    BWTR(bank) = time;
    BCR(bank) = BCR_ON | (t->isModeA ? BCR_EXTMOD : 0) | (t->waits ? BCR_ASYNCWAIT : 0);
#endif
}

void Bus_setSlow(void) {
    Bus_set(0, &slow);
    Bus_set(1, &slow);
}

U32 Bus_read(U32 slot, U32 word) {
    return REG(MAP_CONTROL_WINDOW + (slot << 6 | word << 2));
}

void Bus_write(U32 slot, U32 word, U32 value) {
    REG(MAP_CONTROL_WINDOW + (slot << 6 | word << 2)) = value;
}

static U32 window(U32 address) {
    Watchdog_feed();
    if (address >> MAP_DDR_WINDOW_LOG2 != page) {
        page = address >> MAP_DDR_WINDOW_LOG2;
        Bus_write(MAP_SLOT_SYSTEM, SYSTEM_PAGE, page);
        (void)Bus_read(MAP_SLOT_SYSTEM, SYSTEM_PAGE);
    }
    return MAP_DDR_WINDOW + (address & WINDOW_MASK);
}

U16 Bus_load(U32 address) {
    return *(volatile U16*)window(address);
}

void Bus_store(U32 address, U16 value) {
    *(volatile U16*)window(address) = value;
}

void Bus_storeByte(U32 address, U8 value) {
    *(volatile U8*)window(address) = value;
}

int Bus_start(void) {
    RCC_AHB3ENR |= RCC_AHB3ENR_FSMC;
    Lines_useForFsmc();
    Bus_setSlow();
    return Bus_read(MAP_SLOT_SYSTEM, SYSTEM_ID) >> 16 == SYSTEM_ID_VALUE >> 16;
}

int Bus_isShifted(void) {
    U32 id;
    (void)Bus_read(MAP_SLOT_SYSTEM, SYSTEM_ID);
    id = Bus_read(MAP_SLOT_SYSTEM, SYSTEM_ID);
    return (id & 0xFFFFUL) == SYSTEM_ID_VALUE >> 16;
}

/* ---- writes ---- */

static U32 scratchAfter(U32 value) {
    Bus_write(MAP_SLOT_SYSTEM, SYSTEM_SCRATCH, value);
    return Bus_read(MAP_SLOT_SYSTEM, SYSTEM_SCRATCH);
}

static int writesArrive(void) {
    U32 i;
    for (i = 0; i < 8U; ++i)
        if (scratchAfter(0x01020408UL << (i & 3U) ^ i * 0x11111111UL) !=
            (0x01020408UL << (i & 3U) ^ i * 0x11111111UL))
            return 0;
    return 1;
}

void Bus_testWrites(void) {
    static const U8 mhz[] = {120, 100, 80, 60, 40, 30, 24};
    U32 i, fastest = Timing_mhz();
    Report_step("writes", "writes arrive at 120 MHz: NWE's edge comes before NE, address and data"
                          " change, one HCLK cycle later");
    for (i = 0; i < sizeof mhz && !writesArrive(); ++i)
        if (i + 1U < sizeof mhz)
            Timing_setHclk(mhz[i + 1U] * 1000000UL);
    if (i == sizeof mhz) {
        Timing_setHclk(fastest * 1000000UL);
        Report_fail("NWE", 0, "no-write", "no write arrives, at any HCLK",
                    "NWE with line_tester; a register of the chip that is being reset");
        return;
    }
    Console_start(Timing_mhz() * 500000UL);
    if (i) {
        Report_fail("NWE", 0, "late", "writes only arrive at a lower HCLK",
                    "the resistor, length and load of the wire: it must not be slower than those of"
                    " NE, A and D; a buffer in it");
        Console_text("INFO NWE is late by ns: ");
        Console_fixed(10000UL / mhz[i - 1U], 1);
        Console_text(" to ");
        Console_fixed(10000UL / mhz[i], 1);
        Console_text("; the test continues at MHz: ");
        Console_number(Timing_mhz());
        Console_end();
    }
    if (Report_pass()) {
        Console_text("hold time of ");
        Console_fixed(10000UL / Timing_mhz(), 1);
        Console_text(" ns is enough");
        Console_end();
    }
}

/* ---- data and addresses of registers ---- */

static void reportBits(U32 first, U32 count, U32 bits, const char* kind, const char* seen) {
    U32 i;
    for (i = 0; i < count; ++i)
        if (bits >> i & 1U)
            Report_fail(Lines_name(first + i), 0, kind, seen,
                        "this line with line_tester; both ends of the wire");
}

/* lowest address line that has a wire and that no register needs */
#define FIRST_BEYOND (BOARD_MUXED ? 16U : 11U)

void Bus_testData(void) {
    U32 i, wrong = 0, value;
    Report_step("data", "a register keeps each bit; registers that no slot has are refused");
    for (i = 0; i < 16U; ++i) {
        value = 1UL << i | ~(1UL << i) << 16;
        wrong |= scratchAfter(value) ^ value;
        wrong |= scratchAfter(~value) ^ ~value;
    }
    reportBits(LINE_D0, 16, (wrong | wrong >> 16) & 0xFFFFU, "wrong",
               "a bit of a register is not read as it was written");
    /* A read at an address beyond the slots must return 0 and report an error. Each pass of the
     * loop sets one of the address lines that no register needs. */
    wrong = 0;
    for (i = FIRST_BEYOND; i < 25U; ++i) {
        Bus_write(MAP_SLOT_SYSTEM, SYSTEM_EVENT, SYSTEM_EVENT_BUS_ERROR_MASK);
        if (REG(MAP_CONTROL_WINDOW + (2UL << i)) != 0 ||
            !(Bus_read(MAP_SLOT_SYSTEM, SYSTEM_EVENT) & SYSTEM_EVENT_BUS_ERROR_MASK))
            wrong |= 1UL << i;
    }
    Bus_write(MAP_SLOT_SYSTEM, SYSTEM_EVENT, SYSTEM_EVENT_BUS_ERROR_MASK);
    reportBits(LINE_A0, 25, wrong, "wrong", "an address beyond the registers is answered");
    if (Report_pass()) {
        Console_text("chip of ");
        Console_number(Bus_read(MAP_SLOT_SYSTEM, SYSTEM_SLOTS));
        Console_text(" slots at ");
        Console_number(Bus_read(MAP_SLOT_SYSTEM, SYSTEM_CLK_HZ) / 1000000UL);
        Console_text(" MHz");
        Console_end();
    }
}

/* ---- interrupt ---- */

void Bus_testInterrupt(void) {
    int low, high;
    Report_step("interrupt", "IRQ follows an event of the system slot");
    Bus_write(MAP_SLOT_SYSTEM, SYSTEM_MASK, 0);
    (void)Bus_read(MAP_SLOT_SYSTEM, SYSTEM_MASK);
    low = Lines_read(LINE_IRQ);
    (void)REG(MAP_CONTROL_WINDOW + (2UL << 11));
    Bus_write(MAP_SLOT_SYSTEM, SYSTEM_MASK, SYSTEM_MASK_BUS_ERROR_MASK);
    (void)Bus_read(MAP_SLOT_SYSTEM, SYSTEM_MASK);
    high = Lines_read(LINE_IRQ);
    Bus_write(MAP_SLOT_SYSTEM, SYSTEM_MASK, 0);
    Bus_write(MAP_SLOT_SYSTEM, SYSTEM_EVENT, SYSTEM_EVENT_BUS_ERROR_MASK);
    if (low || !high)
        Report_fail("IRQ", 0, low ? "stuck1" : "stuck0", "it does not follow the event",
                    "this line with line_tester; other parts on it, such as a LED");
    if (Report_pass()) {
        Console_text("IRQ high and low");
        Console_end();
    }
}

/* ---- modem ---- */

/* longest set-up of the modem, ms: three rates with two guard times each */
#define SETUP_LIMIT_MS 30000UL
#define POLL_US 1000U

void Bus_testModem(void) {
    U32 ms, event = 0, status;
    Report_step("modem", "the modem answers AT commands, and accepts bytes (CTS)");
    Bus_write(MAP_SLOT_MODEM, MODEM_BAUD, 3UL | bringup_limits.guardMs << MODEM_BAUD_GUARD_MS_LSB);
    Bus_write(MAP_SLOT_MODEM, MODEM_ADDR, 0x00000001UL);
    Bus_write(MAP_SLOT_MODEM, MODEM_NET, 0x3332000CUL);
    Bus_write(MAP_SLOT_MODEM, MODEM_TX_BASE, 0);
    Bus_write(MAP_SLOT_MODEM, MODEM_RX_BASE, 0x1000UL);
    Bus_write(MAP_SLOT_MODEM, MODEM_CONTROL, MODEM_CONTROL_CONFIGURE_MASK);
    for (ms = 0; ms < SETUP_LIMIT_MS && !event; ++ms) {
        Timing_wait(POLL_US);
        event = Bus_read(MAP_SLOT_MODEM, MODEM_EVENT) &
                (MODEM_EVENT_CONFIGURED_MASK | MODEM_EVENT_CONFIGURE_FAILED_MASK);
    }
    status = Bus_read(MAP_SLOT_MODEM, MODEM_STATUS);
    Bus_write(MAP_SLOT_MODEM, MODEM_EVENT, event);
    if (!(event & MODEM_EVENT_CONFIGURED_MASK)) {
        U32 step = status >> MODEM_STATUS_STEP_LSB & 15U;
        if (step <= 1U)
            Report_fail("MODEM_TXD", "MODEM_RXD", "silent", "no answer to +++ at any rate",
                        "both lines with line_tester; that the modem has 802.15.4 firmware; that"
                        " its guard time is 1 s");
        else
            Report_fail("MODEM", 0, "refuses", "it answers, but refuses a command",
                        "its firmware: the step in the next line, table in docs/modem.md");
        Console_text("INFO modem step: ");
        Console_number(step);
        Console_end();
    } else if (!(status & MODEM_STATUS_CTS_MASK))
        Report_fail("MODEM_CTS", 0, "stuck1", "the modem never accepts bytes",
                    "this line with line_tester, and D7 = 1");
    if (Report_pass()) {
        Console_text("set up in ms: ");
        Console_number(ms);
        Console_end();
    }
}
