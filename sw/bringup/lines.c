/* SPDX-License-Identifier: MIT
 *
 * lines: sets and reads single pins, and exchanges frames with the tester in the FPGA.
 */
#include "lines.h"
#include "bringup_pins.h"
#include "stm32f2.h"
#include "timing.h"

#define KEY 0x1CE5UL
#define ID 0x4C54UL
#define KEY_BITS 16U
#define SENT_BITS (KEY_BITS + 2U * FPGA_PINS + 1U)
#define PINS_AT 40U
#define EARLY_AT (PINS_AT + FPGA_PINS)
#define ANSWER_BITS (EARLY_AT + 5U)
#define AF_FSMC 12UL
/* half a bit, HCLK cycles: 300 ns, which are seven clocks of an oscillator of 25 MHz */
#define HALF_BIT 36U

typedef struct Line {
    const char* name;
    U8 port, pin;
} Line;

#define ROW(name, place) {#name, place},
static const Line lines[LINES] = {BRINGUP_LINES(ROW)};

/* The three lines of each channel: for its clock, its data and the tester's answer. */
static const U8 channels[CHANNELS][3] = {{LINE_NE1, LINE_NE2, LINE_NWAIT},
                                         {LINE_NOE, LINE_NWE, LINE_IRQ},
                                         {LINE_NBL0, LINE_NBL1, LINE_D0}};
static U32 channel;

Pins lines_value, lines_enable;

const char* Lines_name(U32 line) {
    static const char* const modem[] = {"MODEM_RXD", "MODEM_TXD", "MODEM_CTS", "MODEM_RTS",
                                        "MODEM_RESET"};
    return line < LINES ? lines[line].name : modem[line - LINES];
}

int Lines_isWired(U32 line) {
    return lines[line].port != 255U;
}

static void setMode(const Line* line, U32 mode) {
    GPIO_MODER(line->port) =
        (GPIO_MODER(line->port) & ~(3UL << 2U * line->pin)) | mode << 2U * line->pin;
}

void Lines_input(U32 line, Pull pull) {
    const Line* l = &lines[line];
    if (!Lines_isWired(line))
        return;
    GPIO_PUPDR(l->port) = (GPIO_PUPDR(l->port) & ~(3UL << 2U * l->pin)) | (U32)pull << 2U * l->pin;
    setMode(l, 0);
}

void Lines_drive(U32 line, int high) {
    const Line* l = &lines[line];
    if (!Lines_isWired(line))
        return;
    GPIO_BSRR(l->port) = (high ? 1UL : 0x10000UL) << l->pin;
    setMode(l, 1);
}

int Lines_read(U32 line) {
    const Line* l = &lines[line];
    return Lines_isWired(line) && (GPIO_IDR(l->port) >> l->pin & 1UL);
}

void Lines_release(Pull pull) {
    U32 i;
    RCC_AHB1ENR |= 0x7FUL;
    for (i = 0; i < LINES; ++i)
        Lines_input(i, pull);
}

void Lines_useForFsmc(void) {
    U32 i;
    for (i = 0; i < LINES; ++i) {
        const Line* l = &lines[i];
        U32 at = 4U * (l->pin & 7U);
        if (!Lines_isWired(i) || i == LINE_IRQ)
            continue;
        GPIO_OSPEEDR(l->port) |= 3UL << 2U * l->pin;
        GPIO_AFR(l->port, l->pin >> 3) =
            (GPIO_AFR(l->port, l->pin >> 3) & ~(15UL << at)) | AF_FSMC << at;
        setMode(l, 2);
    }
}

int Lines_idleNwait(void) {
    int high;
    Lines_input(LINE_NWAIT, PULL_NONE);
    high = Lines_read(LINE_NWAIT);
    Lines_useForFsmc();
    return high;
}

int Pins_get(const Pins* pins, U32 pin) {
    return pins->bytes[pin >> 3] >> (pin & 7U) & 1;
}

void Pins_set(Pins* pins, U32 pin, int high) {
    U8 mask = (U8)(1U << (pin & 7U));
    U8* byte = &pins->bytes[pin >> 3];
    *byte = (U8)(high ? *byte | mask : *byte & ~mask);
}

/* ---- frames ---- */

static void level(U32 line, int high) {
    const Line* l = &lines[line];
    GPIO_BSRR(l->port) = (high ? 1UL : 0x10000UL) << l->pin;
}

static int sentBit(U32 at) {
    if (at < KEY_BITS)
        return (int)(KEY >> at & 1U);
    at -= KEY_BITS;
    if (at < FPGA_PINS)
        return Pins_get(&lines_value, at);
    at -= FPGA_PINS;
    return at < FPGA_PINS && Pins_get(&lines_enable, at);
}

static void takeBit(Answer* answer, U32 at, int bit) {
    if (at < 16U)
        answer->id |= (U32)bit << at;
    else if (at < 32U)
        answer->clocks |= (U32)bit << (at - 16U);
    else if (at < 40U)
        answer->edges |= (U32)bit << (at - 32U);
    else if (at < EARLY_AT)
        Pins_set(&answer->pins, at - PINS_AT, bit);
    else if (at < ANSWER_BITS)
        Pins_set(&answer->early, at - EARLY_AT + PIN_RXD, bit);
}

int Lines_exchange(Answer* answer) {
    static const Answer none;
    const U8* own = channels[channel];
    U32 at;
    *answer = none;
    Lines_input(own[2], PULL_NONE);
    Lines_drive(own[0], 1);
    Lines_drive(own[1], 1);
    Timing_pause(HALF_BIT);
    level(own[1], 0);
    Timing_pause(HALF_BIT);
    for (at = 0; at < SENT_BITS; ++at) {
        level(own[0], 0);
        level(own[1], sentBit(at));
        Timing_pause(HALF_BIT);
        if (at >= KEY_BITS)
            takeBit(answer, at - KEY_BITS, Lines_read(own[2]));
        level(own[0], 1);
        Timing_pause(HALF_BIT);
    }
    level(own[1], 1);
    Timing_pause(HALF_BIT);
    return answer->id == ID;
}

int Lines_isChannels(U32 line) {
    const U8* own = channels[channel];
    return line == own[0] || line == own[1] || line == own[2];
}

U32 Lines_find(void) {
    Answer answer;
    U32 found = 0;
    for (channel = CHANNELS; channel--;) {
        Lines_release(PULL_UP);
        if (Lines_exchange(&answer))
            found |= 1U << channel;
    }
    Lines_release(PULL_UP);
    for (channel = 0; channel < CHANNELS - 1U && !(found >> channel & 1U);)
        ++channel;
    return found;
}
