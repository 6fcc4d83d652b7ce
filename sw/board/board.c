/* SPDX-License-Identifier: MIT
 *
 * board: set-up of the STM32F2 (RM0033), and its interrupt routines.
 *
 * The FPGA's interrupt is a level on PB0; EXTI only sees its rising edge, so the routine works
 * until the pin is low. Interrupts that call the kernel have priorities of 0x40 and more:
 * uC/OS-II's own port masks these, and none above.
 */
#include "board.h"
#include "boot.h"
#include "clock.h"
#include "program.h"
#include "stm32f2.h"
#include "ucos_ii.h"

#define IRQ_PORT 1UL /* PB0: EXTI0 */
#define IRQ_PIN 0U
#define WIRE_PORT 1UL /* PB1 */
#define WIRE_PIN 1U
#define EXTI0_VECTOR 6U
#define PRIORITY_FPGA 0x50U
#define PRIORITY_TICK 0x60U
#define PRIORITY_SWITCH 0xF0U
#define WATCHDOG_PRESCALER 3UL /* LSI / 32: about 1 kHz */
#define WATCHDOG_MS 1000UL

static U8 read8(void* context, U32 address) {
    (void)context;
    return *(volatile U8*)address;
}

static void write8(void* context, U32 address, U8 value) {
    (void)context;
    *(volatile U8*)address = value;
}

static U16 read16(void* context, U32 address) {
    (void)context;
    return *(volatile U16*)address;
}

static void write16(void* context, U32 address, U16 value) {
    (void)context;
    *(volatile U16*)address = value;
}

static U32 read32(void* context, U32 address) {
    (void)context;
    return *(volatile U32*)address;
}

static void write32(void* context, U32 address, U32 value) {
    (void)context;
    *(volatile U32*)address = value;
}

const FSMC_Port board_fsmc = {read8, write8, read16, write16, read32, write32};

static void usePinForFsmc(U32 port, U32 pin) {
    GPIO_MODER(port) = (GPIO_MODER(port) & ~(3UL << 2U * pin)) | 2UL << 2U * pin;
    GPIO_OSPEEDR(port) |= 3UL << 2U * pin;
    GPIO_AFR(port, pin >> 3) =
        (GPIO_AFR(port, pin >> 3) & ~(15UL << 4U * (pin & 7U))) | GPIO_AF_FSMC << 4U * (pin & 7U);
}

/* Pins of the FSMC a port, from D (data sheet of the STM32F207, table 8): D0..15, A0..24, NOE, NWE,
 * NWAIT, NE1, NE2, NBL0, NBL1. */
static const U16 fsmcPins[4] = {
    0xFFF3U, /* D: all but 2 and 3 (3 would be CLK) */
    0xFFFFU, /* E: all */
    0xF03FU, /* F: A0..A9 */
    0x223FU  /* G: A10..A15, NE2 on 9, A24 on 13 */
};

static void startPins(void) {
    U32 port, pin;
    RCC_AHB1ENR |= 0x1FFUL;
    RCC_AHB3ENR |= RCC_AHB3ENR_FSMC;
    for (port = 0; port < 4U; ++port)
        for (pin = 0; pin < 16U; ++pin)
            if (fsmcPins[port] >> pin & 1U)
                usePinForFsmc(3U + port, pin);
    GPIO_PUPDR(WIRE_PORT) |= 1UL << 2U * WIRE_PIN;
}

void Board_start(void) {
    Clock_start();
    startPins();
}

int Board_isWired(void) {
    return !(GPIO_IDR(WIRE_PORT) >> WIRE_PIN & 1UL);
}

void Board_startInterrupts(void) {
    SCB_SHCSR |= SCB_SHCSR_FAULTS;
    SCB_SHPR(15) = PRIORITY_TICK;
    SCB_SHPR(14) = PRIORITY_SWITCH;
    SYST_RVR = SYST_MS * 1000UL / OS_TICKS_PER_SEC - 1UL;
    SYST_CVR = 0;
    SYST_CSR = SYST_CSR_ON;

    RCC_APB2ENR |= RCC_APB2ENR_SYSCFG;
    SYSCFG_EXTICR(0) = IRQ_PORT;
    EXTI_RTSR |= 1UL << IRQ_PIN;
    EXTI_IMR |= 1UL << IRQ_PIN;
    NVIC_IPR(EXTI0_VECTOR) = PRIORITY_FPGA;
    NVIC_ISER(0) = 1UL << EXTI0_VECTOR;

    IWDG_KR = IWDG_KR_START;
    IWDG_KR = IWDG_KR_UNLOCK;
    IWDG_PR = WATCHDOG_PRESCALER;
    IWDG_RLR = WATCHDOG_MS;
    Board_serveWatchdog();
}

void Board_serveWatchdog(void) {
    IWDG_KR = IWDG_KR_REFRESH;
}

void EXTI0_Handler(void) {
    OSIntEnter();
    EXTI_PR = 1UL << IRQ_PIN;
    /* The edge is cleared before the pin is looked at, so the register is read back. A later clear
     * would take the edge of an interrupt that rises in between, and its level would be missed. */
    (void)EXTI_PR;
    while (GPIO_IDR(IRQ_PORT) >> IRQ_PIN & 1UL)
        Program_onFpgaInterrupt();
    OSIntExit();
}

void SysTick_Handler(void) {
    OSIntEnter();
    OSTimeTick();
    OSIntExit();
}
