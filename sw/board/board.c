/* SPDX-License-Identifier: MIT
 *
 * board: set-up of the STM32F2 (RM0033), and its interrupt routines.
 *
 * The FPGA's interrupt is a level on a pin of EXTI0, but EXTI only detects its rising edge. The
 * routine therefore repeats its work until the pin is low. The port of uC/OS-II masks interrupts
 * with priorities from 0x40 upwards. Interrupts that call the kernel must have such a priority.
 */
#include "board.h"
#include "board_pins.h"
#include "boot.h"
#include "clock.h"
#include "program.h"
#include "stm32f2.h"
#include "ucos_ii.h"

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

/* Registers of a GPIO port that connect pins to the FSMC; board_pins.h has the values for this
 * board. */
typedef struct Port {
    U32 base, mode, speed, pull, low, high;
} Port;

static const Port ports[BOARD_PORTS] = {BOARD_PINS};

static void startPins(void) {
    const Port* port;
    RCC_AHB1ENR |= 0x1FFUL;
    RCC_AHB3ENR |= RCC_AHB3ENR_FSMC;
    for (port = ports; port < ports + BOARD_PORTS; ++port) {
        volatile U32* const registers = &REG(port->base);
        registers[GPIO_AFRL] = port->low;
        registers[GPIO_AFRH] = port->high;
        registers[GPIO_SPEED] = port->speed;
        registers[GPIO_PULL] = port->pull;
        registers[GPIO_MODE] = port->mode;
    }
    GPIO_PUPDR(BOARD_WIRED_PORT) |= 1UL << 2U * BOARD_WIRED_PIN;
}

void Board_start(void) {
    Clock_start();
    startPins();
}

int Board_isWired(void) {
    return !(GPIO_IDR(BOARD_WIRED_PORT) >> BOARD_WIRED_PIN & 1UL);
}

void Board_startInterrupts(void) {
    SCB_SHCSR |= SCB_SHCSR_FAULTS;
    SCB_SHPR(15) = PRIORITY_TICK;
    SCB_SHPR(14) = PRIORITY_SWITCH;
    SYST_RVR = SYST_MS * 1000UL / OS_TICKS_PER_SEC - 1UL;
    SYST_CVR = 0;
    SYST_CSR = SYST_CSR_ON;

    RCC_APB2ENR |= RCC_APB2ENR_SYSCFG;
    SYSCFG_EXTICR(0) = BOARD_IRQ_PORT;
    EXTI_RTSR |= 1UL << BOARD_IRQ_PIN;
    EXTI_IMR |= 1UL << BOARD_IRQ_PIN;
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
    EXTI_PR = 1UL << BOARD_IRQ_PIN;
    /* Reads the register back, so that the edge is cleared before the pin is read. If the
     * clear took effect later, it could also clear the edge of a new interrupt, which would
     * then be lost. */
    (void)EXTI_PR;
    while (GPIO_IDR(BOARD_IRQ_PORT) >> BOARD_IRQ_PIN & 1UL)
        Program_onFpgaInterrupt();
    OSIntExit();
}

void SysTick_Handler(void) {
    OSIntEnter();
    OSTimeTick();
    OSIntExit();
}
