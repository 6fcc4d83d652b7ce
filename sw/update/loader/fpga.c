/* SPDX-License-Identifier: MIT
 *
 * fpga: accesses the FPGA's flash, and makes the FPGA load its bitstream. The flash is connected to
 * SPI 1 of the processor and to the configuration pins of the FPGA. The FPGA does not drive these
 * pins after its configuration, nor while PROGRAM_B is low. The processor drives the bus only
 * during a transaction that it has started. While the FPGA loads its configuration, SPI 1 acts as a
 * slave and receives the addresses at which the FPGA reads.
 */
#include "fpga.h"
#include "board.h"
#include "spi_nor.h"
#include "stm32f2.h"
#include "ucos_ii.h"

#define BUS 0U                 /* pins on port A: chip select 4, clock 5, data in 6, data out 7 */
#define BUS_PINS (0xFFUL << 8) /* bits of these pins in the register MODER */
/* value of MODER while the processor uses the bus: chip select is an output, the other three pins
 * belong to SPI 1 */
#define BUS_OURS (0xA9UL << 8)
/* value of MODER while the processor listens: all pins except data in belong to SPI 1 */
#define BUS_HEARS (0x8AUL << 8)
#define BUS_SPI (0x5555UL << 16) /* alternate function 5 (SPI 1) for three pins */
#define SELECT 4U                /* pin of chip select on port A, and its EXTI line */
#define SELECT_VECTOR 10U
/* bytes of a read command up to the end of its address: one of the instruction, three of the
 * address */
#define ADDRESS_BYTES 4U
/* limit of the number of polls, of at least 10 cycles each; an address takes 32 us at 1 MHz */
#define POLLS 2000U
#define CONTROL 2U /* pins on port C: PROGRAM_B 0 (open drain), DONE 1 */
#define DONE 1U
#define NO_TASK 255U
/* Longest wait for DONE, ticks of 10 ms. Loading 3.7 Mbit takes 1.9 s at 2 MHz and 3.7 s at 1 MHz,
 * and the FPGA tries up to four times. */
#define WAIT_TICKS 1600U
/* Time without an edge of chip select, ticks of 10 ms, after which the FPGA counts as hung: it has
 * stopped reading, or the wire is missing. */
#define QUIET_TICKS 100U
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

/* Reads from the flash. After some reads, lets other tasks run, such as the watchdog task. */
static void read(void* context, U32 offset, U8* bytes, U32 count) {
    static U32 reads;
    SpiNor_read(context, offset, bytes, count);
    if (++reads % READS_A_PAUSE == 0U)
        pause();
}

static void startPins(void) {
    RCC_AHB1ENR |= 1UL << BUS | 1UL << CONTROL;
    RCC_APB2ENR |= RCC_APB2ENR_SPI1;
    GPIO_PUPDR(BUS) |= 1UL << 2U * SELECT;
    GPIO_AFR(BUS, 0) = (GPIO_AFR(BUS, 0) & ~(0xFFFFUL << 16)) | BUS_SPI;
    GPIO_OTYPER(CONTROL) |= 1UL;
}

/* Clears the FPGA's configuration by driving PROGRAM_B low for more than 0.5 us, and keeps it
 * low. */
static void hold(void) {
    U32 i;
    GPIO_BSRR(CONTROL) = 1UL << 16;
    GPIO_MODER(CONTROL) = (GPIO_MODER(CONTROL) & ~3UL) | 1UL;
    for (i = 0; i < 100U; ++i)
        (void)GPIO_IDR(CONTROL);
}

static int isDone(void) {
    return (int)(GPIO_IDR(CONTROL) >> DONE & 1UL);
}

static int isSelected(void) {
    return !(GPIO_IDR(BUS) >> SELECT & 1UL);
}

/* Empties the receiver of SPI 1, so that it starts with the next chip select. */
static void arm(void) {
    SPI1_CR1 = 0;
    (void)SPI1_DR;
    (void)SPI1_SR;
    SPI1_CR1 = SPI1_CR1_SLAVE;
}

/* Returns the address that the FPGA sends to the flash; 0 after a time-out. */
static U32 hear(void) {
    U32 address = 0, polls = 0, i;
    for (i = 0; i < ADDRESS_BYTES; ++i) {
        while (!(SPI1_SR & SPI1_SR_RXNE))
            if (!isSelected() || ++polls == POLLS)
                return 0;
        address = address << 8 | SPI1_DR;
    }
    return address & 0xFFFFFFUL;
}

/* Lets the FPGA load its configuration, and sleeps until DONE is high or the time-out expires.
 * SysTick and chip select wake the processor, without running their interrupt routines. Returns the
 * address of the FPGA's last read. */
static U32 load(void) {
    U32 i, edge = 0, heard = 0;
    __asm__ volatile("cpsid i");
    GPIO_MODER(BUS) = (GPIO_MODER(BUS) & ~BUS_PINS) | BUS_HEARS;
    arm();
    EXTI_RTSR |= 1UL << SELECT;
    EXTI_FTSR |= 1UL << SELECT;
    EXTI_IMR |= 1UL << SELECT;
    NVIC_ISER(0) = 1UL << SELECT_VECTOR;
    SYST_RVR = 10UL * SYST_MS - 1UL;
    SYST_CVR = 0;
    SYST_CSR = SYST_CSR_ON;
    GPIO_MODER(CONTROL) &= ~3UL;
    for (i = 0; i < WAIT_TICKS && !isDone() && (isSelected() || i - edge < QUIET_TICKS);) {
        __asm__ volatile("wfi");
        i += SCB_ICSR & SCB_ICSR_PENDSTSET ? 1U : 0U;
        SCB_ICSR = SCB_ICSR_PENDSTCLR;
        if (!(EXTI_PR >> SELECT & 1UL))
            continue;
        EXTI_PR = 1UL << SELECT;
        edge = i;
        if (isSelected())
            heard = hear();
        else
            arm();
        NVIC_ICPR(0) = 1UL << SELECT_VECTOR;
    }
    SYST_CSR = 0;
    SCB_ICSR = SCB_ICSR_PENDSTCLR;
    NVIC_ICER(0) = 1UL << SELECT_VECTOR;
    EXTI_IMR &= ~(1UL << SELECT);
    EXTI_PR = 1UL << SELECT;
    NVIC_ICPR(0) = 1UL << SELECT_VECTOR;
    GPIO_MODER(BUS) &= ~BUS_PINS;
    SPI1_CR1 = SPI1_CR1_MASTER;
    __asm__ volatile("cpsie i");
    if (!isDone() && isSelected())
        hold(); /* the FPGA hangs; clearing it frees the bus */
    return heard;
}

/* Returns 1 if the FPGA hangs, or has loaded the golden bitstream instead of the one in slot 1. */
static int loadsAnother(void) {
    const U32 from = load();
    return !isDone() || from == Slots_at(&slots_fpga, 0) + SLOTS_IMAGE_AT;
}

/* Makes the FPGA load its bitstream again, so that all its reads can be observed, and returns the
 * result of loadsAnother. If the flash contains a bitstream that is not complete or not signed,
 * returns 1 without loading it. */
static int loadsAnotherAgain(void) {
    hold();
    SPI1_CR1 = SPI1_CR1_MASTER;
    if (SpiNor_isThere((void*)&bus) && !Slots_isLoadable(&port, FPGA_PRODUCT))
        return 1;
    return loadsAnother();
}

const Slots_Port* Fpga_slots(const Slots_Port* firmware, int mustLoad, int mayTry, U32* running) {
    int isRefused;
    startPins();
    port = *firmware;
    port.layout = &slots_fpga;
    port.context = (void*)&bus;
    port.read = read;
    port.erase = SpiNor_erase;
    port.program = SpiNor_program;
    port.mapped = 0;
    isRefused = mustLoad ? loadsAnotherAgain() : loadsAnother();
    if (!SpiNor_isThere((void*)&bus)) {
        GPIO_MODER(CONTROL) &= ~3UL;
        return 0;
    }
    while ((mayTry || isRefused) && Slots_settleFpga(&port, isRefused)) {
        isRefused = loadsAnotherAgain();
        if (!isRefused)
            break;
    }
    *running = Slots_is(&port, 1, SLOTS_READY) ? 1U : 0U;
    return &port;
}
