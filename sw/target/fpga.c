/* SPDX-License-Identifier: MIT
 *
 * fpga: the flash hangs on SPI 1 and on the FPGA's configuration pins. These float once it is
 * configured; the processor drives the bus for the length of a transaction only, and PROGRAM_B when
 * nothing is under way there.
 */
#include "fpga.h"
#include "board.h"
#include "spi_nor.h"
#include "stm32f2.h"
#include "ucos_ii.h"

#define BUS 0U                  /* port A: chip select 4, clock 5, data in 6, data out 7 */
#define BUS_PINS (0xFFUL << 8)  /* their bits of MODER */
#define BUS_OURS (0xA9UL << 8)  /* an output, and three of SPI 1 */
#define BUS_SPI (0x555UL << 20) /* alternate function 5 */
#define SELECT 4U
#define CONTROL 2U /* port C: PROGRAM_B 0, open drain; DONE 1 */
#define DONE 1U
#define NO_TASK 255U
#define WAIT_TICKS 500U /* of 10 ms: 3.7 Mbit at 2 MHz take 1.9 s, after tries that fail more */
#define READS_A_PAUSE 64U

static Slots_Port port;

static void select(int isLow) {
    if (isLow)
        GPIO_MODER(BUS) = (GPIO_MODER(BUS) & ~BUS_PINS) | BUS_OURS;
    GPIO_BSRR(BUS) = 1UL << (isLow ? 16U + SELECT : SELECT);
    if (!isLow)
        GPIO_MODER(BUS) &= ~BUS_PINS;
}

static U8 transfer(U8 byte) {
    SPI1_DR = byte;
    while (!(SPI1_SR & SPI1_SR_RXNE))
        ;
    return (U8)SPI1_DR;
}

static void pause(void) {
    if (Board_task() != NO_TASK)
        OSTimeDly(1);
}

static const SpiNor_Bus bus = {select, transfer, pause};

/* Reads for as long as other tasks, the watchdog's among them, can wait. */
static void read(void* context, U32 offset, U8* bytes, U32 count) {
    static U32 reads;
    SpiNor_read(context, offset, bytes, count);
    if (++reads % READS_A_PAUSE == 0U)
        pause();
}

static void startPins(void) {
    RCC_AHB1ENR |= 1UL << BUS | 1UL << CONTROL;
    RCC_APB2ENR |= RCC_APB2ENR_SPI1;
    GPIO_AFR(BUS, 0) = (GPIO_AFR(BUS, 0) & ~(0xFFFUL << 20)) | BUS_SPI;
    GPIO_OTYPER(CONTROL) |= 1UL;
    SPI1_CR1 = SPI1_CR1_MASTER;
}

/* Has the FPGA load its configuration: PROGRAM_B is low for more than 0.5 us. */
static void reconfigure(void) {
    U32 i;
    GPIO_BSRR(CONTROL) = 1UL << 16;
    GPIO_MODER(CONTROL) = (GPIO_MODER(CONTROL) & ~3UL) | 1UL;
    for (i = 0; i < 100U; ++i)
        (void)GPIO_IDR(CONTROL);
    GPIO_MODER(CONTROL) &= ~3UL;
}

/* Sleeps until DONE is high, or long enough. The SysTick wakes the processor, and is not served. */
static void waitForDone(void) {
    U32 i;
    __asm__ volatile("cpsid i");
    SYST_RVR = (SYST_CALIB & SYST_CALIB_TENMS) * 8UL * 10UL - 1UL;
    SYST_CVR = 0;
    SYST_CSR = SYST_CSR_ON;
    for (i = 0; i < WAIT_TICKS && !(GPIO_IDR(CONTROL) >> DONE & 1UL); ++i) {
        __asm__ volatile("wfi");
        SCB_ICSR = SCB_ICSR_PENDSTCLR;
    }
    SYST_CSR = 0;
    SCB_ICSR = SCB_ICSR_PENDSTCLR;
    __asm__ volatile("cpsie i");
}

const Slots_Port* Fpga_slots(const Slots_Port* firmware, U32* running) {
    startPins();
    waitForDone(); /* until then the bus is the FPGA's */
    if (!SpiNor_isThere((void*)&bus))
        return 0;
    port = *firmware;
    port.layout = &slots_fpga;
    port.context = (void*)&bus;
    port.read = read;
    port.erase = SpiNor_erase;
    port.program = SpiNor_program;
    port.mapped = 0;
    if (Slots_settleFpga(&port)) {
        reconfigure();
        waitForDone();
    }
    *running = Slots_is(&port, 1, SLOTS_READY) ? 1U : 0U;
    return &port;
}
