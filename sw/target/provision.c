/* SPDX-License-Identifier: MIT
 *
 * provision: polls the port, since no task runs yet. SysTick tells that 10 ms have passed.
 */
#include "provision.h"
#include "ascon.h"
#include "stm32f2.h"
#include "uav_keys.h"

#include <string.h>

#define PORT 0U
#define TRANSMIT 9U
#define RECEIVE 10U
#define LIMIT 1000U /* of 10 ms */
#define LINE_BYTES 40U
#define KEY_AT 4U /* behind "key " */

static int isBreak(void) {
    return !(GPIO_IDR(PORT) >> RECEIVE & 1UL);
}

/* Returns 1 once each 10 ms. */
static U32 tick(void) {
    return SYST_CSR >> 16 & 1UL;
}

static void say(const char* text) {
    while (*text) {
        while (!(USART1_SR & USART1_SR_TXE))
            ;
        USART1_DR = (U8)*text++;
    }
    while (!(USART1_SR & USART1_SR_TC))
        ;
}

/* Reads a line. Returns 0 where none came. */
static int readLine(char* line) {
    U32 ticks = 0, size = 0;
    while (ticks < LIMIT) {
        ticks += tick();
        if (USART1_SR & USART1_SR_RXNE) {
            const char c = (char)USART1_DR;
            if (c == '\n' || size == LINE_BYTES - 1U) {
                line[size] = 0;
                return 1;
            }
            if (c > ' ' || (c == ' ' && size))
                line[size++] = c;
        }
    }
    return 0;
}

static int digitOf(char c) {
    static const char digits[] = "0123456789abcdef";
    const char* found = c ? strchr(digits, c) : 0;
    return found ? (int)(found - digits) : -1;
}

/* Executes the line. Returns 0 where it makes no sense. */
static int obey(char* line) {
    U8 key[LINK_KEY_BYTES];
    U32 i;
    int isKey = strlen(line) == KEY_AT + 2U * LINK_KEY_BYTES && memcmp(line, "key ", KEY_AT) == 0;
    for (i = 0; isKey && i < LINK_KEY_BYTES; ++i) {
        const int high = digitOf(line[KEY_AT + 2U * i]), low = digitOf(line[KEY_AT + 2U * i + 1U]);
        isKey = high >= 0 && low >= 0;
        key[i] = (U8)((U32)high << 4 | (U32)low);
    }
    if (!isKey && strcmp(line, "open") != 0)
        return 0;
    UAV_provide(isKey ? key : 0);
    Ascon_wipe(key, sizeof key);
    return 1;
}

static void stop(void) {
    USART1_CR1 = 0;
    SYST_CSR = 0;
}

void Provision_listen(void) {
    char line[LINE_BYTES];
    U32 ticks = 0;
    RCC_AHB1ENR |= 1UL << PORT;
    GPIO_PUPDR(PORT) |= 1UL << 2U * RECEIVE; /* pulled up where nothing is wired */
    if (!isBreak())
        return;
    SYST_RVR = 10UL * SYST_MS - 1UL;
    SYST_CVR = 0;
    SYST_CSR = SYST_CSR_POLLED;
    while (!tick())
        if (!isBreak()) {
            stop();
            return; /* another program's byte, not a break */
        }
    while (isBreak() && ticks < LIMIT)
        ticks += tick();
    RCC_APB2ENR |= RCC_APB2ENR_USART1;
    GPIO_AFR(PORT, 1) |= GPIO_AF_USART1 << 4U * (TRANSMIT - 8U) | GPIO_AF_USART1
                                                                      << 4U * (RECEIVE - 8U);
    GPIO_MODER(PORT) |= 2UL << 2U * TRANSMIT | 2UL << 2U * RECEIVE;
    USART1_BRR = USART1_BRR_115200;
    USART1_CR1 = USART1_CR1_ON;
    say("icesoc: key?\r\n");
    if (readLine(line))
        say(obey(line) ? "ok\r\n" : "no: key and 32 of 0..9a..f, or open\r\n");
    Ascon_wipe(line, sizeof line);
    GPIO_MODER(PORT) &= ~(3UL << 2U * TRANSMIT | 3UL << 2U * RECEIVE);
    stop();
}
