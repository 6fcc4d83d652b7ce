/* SPDX-License-Identifier: MIT
 *
 * console: writes text to USART 1, and the lines of a report.
 */
#include "console.h"
#include "stm32f2.h"
#include "watchdog.h"

#define CONSOLE_BAUD 115200UL
#define PORT_A 0UL
#define TX_PIN 9U
#define RX_PIN 10U

static const char* step;
static U32 stepFailures, failures;

static void useForUart(U32 pin) {
    GPIO_MODER(PORT_A) = (GPIO_MODER(PORT_A) & ~(3UL << 2U * pin)) | 2UL << 2U * pin;
    GPIO_AFR(PORT_A, pin >> 3) = (GPIO_AFR(PORT_A, pin >> 3) & ~(15UL << 4U * (pin & 7U))) |
                                 GPIO_AF_USART1 << 4U * (pin & 7U);
}

void Console_start(U32 hz) {
    RCC_AHB1ENR |= 1UL << PORT_A;
    RCC_APB2ENR |= RCC_APB2ENR_USART1;
    GPIO_PUPDR(PORT_A) |= 1UL << 2U * RX_PIN;
    useForUart(TX_PIN);
    useForUart(RX_PIN);
    USART1_BRR = (hz + CONSOLE_BAUD / 2U) / CONSOLE_BAUD;
    USART1_CR1 = USART1_CR1_ON;
}

static void put(char c) {
    while (!(USART1_SR & USART1_SR_TXE))
        ;
    USART1_DR = (U32)(U8)c;
}

void Console_text(const char* text) {
    while (*text)
        put(*text++);
}

void Console_fixed(U32 value, U32 decimals) {
    char digits[12];
    U32 count = 0;
    do {
        if (decimals && count == decimals)
            digits[count++] = '.';
        digits[count++] = (char)('0' + value % 10U);
        value /= 10U;
    } while (value || (decimals && count < decimals + 2U));
    while (count)
        put(digits[--count]);
}

void Console_number(U32 value) {
    Console_fixed(value, 0);
}

void Console_hex(U32 value, U32 digits) {
    Console_text("0x");
    while (digits--)
        put("0123456789ABCDEF"[value >> 4U * digits & 15U]);
}

void Console_end(void) {
    Console_text("\r\n");
}

void Report_step(const char* name, const char* passes) {
    step = name;
    stepFailures = 0;
    Watchdog_enter(name);
    Console_text("STEP ");
    Console_text(name);
    Console_text(": ");
    Console_text(passes);
    Console_end();
}

void Report_fail(const char* wire, const char* second, const char* kind, const char* seen,
                 const char* check) {
    ++stepFailures;
    ++failures;
    Console_text("FAIL ");
    Console_text(step);
    Console_text(" ");
    Console_text(wire);
    if (second) {
        Console_text("-");
        Console_text(second);
    }
    Console_text(" ");
    Console_text(kind);
    Console_text(": ");
    Console_text(seen);
    Console_text("; check: ");
    Console_text(check);
    Console_end();
}

int Report_pass(void) {
    if (stepFailures)
        return 0;
    Console_text("PASS ");
    Console_text(step);
    Console_text(": ");
    return 1;
}

U32 Report_stepFailures(void) {
    return stepFailures;
}

U32 Report_failures(void) {
    return failures;
}
