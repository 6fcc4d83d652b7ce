/* SPDX-License-Identifier: MIT
 *
 * provision: accepts the vehicle's keys over the serial port. No task runs yet, so it polls the
 * port; SysTick measures time in units of 10 ms.
 */
#include "provision.h"
#include "ascon.h"
#include "stm32f2.h"
#include "uav_keys.h"

#include <string.h>

#define PORT 0U
#define TRANSMIT 9U
#define RECEIVE 10U
#define LIMIT 1000U /* time-out, units of 10 ms */
#define LINE_BYTES 88U
/* pin PC2: if a jumper connects it to ground, a vehicle with a key may get other keys */
#define JUMPER_PORT 2U
#define JUMPER 2U

static int isBreak(void) {
    return !(GPIO_IDR(PORT) >> RECEIVE & 1UL);
}

/* Returns 1 if 10 ms have passed since the last call that returned 1. */
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

/* Reads a line. Returns 0 after a time-out. */
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

/* Converts two hexadecimal digits per byte. Returns the text after them; 0 if they are not
 * digits. */
static const char* readBytes(const char* text, U8* bytes, U32 count) {
    for (; text && count; --count, text += 2) {
        const int high = digitOf(text[0]), low = high < 0 ? -1 : digitOf(text[1]);
        if (low < 0)
            return 0;
        *bytes++ = (U8)((U32)high << 4 | (U32)low);
    }
    return text;
}

static int isProtected(void) {
    return (FLASH_OPTCR & FLASH_OPTCR_RDP) != FLASH_OPTCR_RDP_NONE;
}

/* Sets read protection level 1, which takes effect when the power is switched on next. Removing the
 * protection erases flash and keys. */
static void protect(void) {
    if (isProtected())
        return;
    FLASH_OPTKEYR = FLASH_OPTKEY1;
    FLASH_OPTKEYR = FLASH_OPTKEY2;
    FLASH_OPTCR = (FLASH_OPTCR & ~FLASH_OPTCR_RDP) | FLASH_OPTCR_RDP_1;
    FLASH_OPTCR |= FLASH_OPTCR_STRT;
    while (FLASH_SR & FLASH_SR_BSY)
        ;
    FLASH_OPTCR |= FLASH_OPTCR_LOCK;
}

/* Executes the command in a line. Returns the reply. */
static const char* obey(const char* line) {
    const char *end, *answer = "ok\r\n";
    U8 key[LINK_KEY_BYTES], old[LINK_KEY_BYTES], address[2] = {0, 0}, call[4] = {0, 0, 0, 0};
    const int isFellow = strncmp(line, "fellow ", 7) == 0;
    const int isGroup = strncmp(line, "group ", 6) == 0;
    const int isPeer = isFellow || isGroup || strncmp(line, "ground ", 7) == 0;
    int isKey = strncmp(line, "key ", 4) == 0;
    U32 number;
    int isProven = UAV_countKeys(0) == 0 || !(GPIO_IDR(JUMPER_PORT) >> JUMPER & 1UL);
    if (strcmp(line, "protect") == 0) {
        protect();
        return answer;
    }
    if (isPeer) {
        end = isGroup ? readBytes(line + 6, call, sizeof call)
                      : readBytes(line + 7, address, sizeof address);
        isKey = end && *end == ' ';
        end = isKey ? readBytes(end + 1, key, sizeof key) : end;
    } else {
        end = isKey                           ? readBytes(line + 4, key, sizeof key)
              : strncmp(line, "open", 4) == 0 ? line + 4
                                              : 0;
        end = end && *end == ' ' ? readBytes(end + 1, address, sizeof address) : 0;
    }
    if (end && *end == ' ') {
        end = readBytes(end + 1, old, sizeof old);
        isProven |= end && UAV_isKey(old);
    }
    number = isGroup ? UAV_EVERYBODY : (U32)address[0] << 8 | address[1];
    if (!end || *end)
        answer = "no: expected key KEY ADDRESS, open ADDRESS, ground ADDRESS KEY, fellow ADDRESS "
                 "KEY, group NUMBER KEY or protect; a current key may follow\r\n";
    else if (!isProven)
        answer = "no: it has a key; append it, or fit the jumper\r\n";
    else if (!(isPeer ? UAV_providePeer(isFellow                  ? UAV_VEHICLE
                                        : number == UAV_EVERYBODY ? UAV_GROUP
                                                                  : UAV_OBSERVER,
                                        number, isKey ? key : 0)
                      : UAV_provide(number, isKey ? key : 0)))
        answer = "no: this firmware was built without keys or without several peers\r\n";
    else if (isGroup)
        UAV_setCallNumber((U32)call[0] << 24 | (U32)call[1] << 16 | (U32)call[2] << 8 | call[3]);
    Ascon_wipe(key, sizeof key);
    Ascon_wipe(old, sizeof old);
    return answer;
}

static void stop(void) {
    USART1_CR1 = 0;
    SYST_CSR = 0;
}

void Provision_listen(void) {
    char line[LINE_BYTES];
    U32 ticks = 0;
    RCC_AHB1ENR |= 1UL << PORT | 1UL << JUMPER_PORT;
    /* enables the pull-up, because the pin may be unconnected */
    GPIO_PUPDR(PORT) |= 1UL << 2U * RECEIVE;
    if (!isBreak())
        return;
    SYST_RVR = 10UL * SYST_MS - 1UL;
    SYST_CVR = 0;
    SYST_CSR = SYST_CSR_POLLED;
    while (!tick())
        if (!isBreak()) {
            stop();
            return; /* the port receives the bytes of another program, not a break */
        }
    while (isBreak() && ticks < LIMIT)
        ticks += tick();
    RCC_APB2ENR |= RCC_APB2ENR_USART1;
    GPIO_AFR(PORT, 1) |= GPIO_AF_USART1 << 4U * (TRANSMIT - 8U) | GPIO_AF_USART1
                                                                      << 4U * (RECEIVE - 8U);
    GPIO_MODER(PORT) |= 2UL << 2U * TRANSMIT | 2UL << 2U * RECEIVE;
    USART1_BRR = USART1_BRR_115200;
    USART1_CR1 = USART1_CR1_ON;
    GPIO_PUPDR(JUMPER_PORT) |= 1UL << 2U * JUMPER;
    say("icesoc: key?");
    if (!isProtected())
        say(" (read protection is off: anyone who opens the vehicle can read its key)");
    say("\r\n");
    if (readLine(line))
        say(obey(line));
    Ascon_wipe(line, sizeof line);
    GPIO_MODER(PORT) &= ~(3UL << 2U * TRANSMIT | 3UL << 2U * RECEIVE);
    stop();
}
