/* SPDX-License-Identifier: MIT
 *
 * mps2: start-up, serial port and clock of ARM's MPS2 board with a Cortex-M3 (application note
 * 385). The UART comes from ARM's CMSDK (DDI 0479).
 */
#include "mps2.h"

#include <string.h>

#define UART ((volatile U32*)0x40004000U)
enum { DATA = 0, STATE = 1, CTRL = 2, INTERRUPT = 3, DIVISOR = 4 };
#define STATE_TX_FULL 1U
#define STATE_RX_FULL 2U
#define CTRL_TX 1U
#define CTRL_RX 2U
#define CTRL_RX_INTERRUPT 8U
#define INTERRUPT_RX 2U

#define NVIC_ISER ((volatile U32*)0xE000E100U)
#define NVIC_IPR ((volatile U8*)0xE000E400U)
#define SYSTICK ((volatile U32*)0xE000E010U) /* CSR, RVR, CVR */

static volatile U32 milliseconds;

/* Ring of received bytes. Only the interrupt routine writes bytes, and only Mps2_read removes
 * them. */
#define RING 512U
static U8 ring[RING];
static volatile U32 written, taken;

static U8 frame[LINK_MAX_FRAME];
static U32 frameSize, frameSent;

void Mps2_start(void) {
    UART[DIVISOR] = MPS2_HZ / 115200U;
    UART[CTRL] = CTRL_TX | CTRL_RX | CTRL_RX_INTERRUPT;
    NVIC_IPR[0] = (U8)(MPS2_UART_PRIORITY << 5U);
    NVIC_ISER[0] = 1U;
}

void Mps2_startClock(void) {
    SYSTICK[1] = MPS2_HZ / 1000U - 1U;
    SYSTICK[2] = 0;
    SYSTICK[0] = 7U; /* CPU clock, interrupt, on */
}

U32 Mps2_nowMs(void) {
    return milliseconds;
}

U32 Mps2_read(U8* to, U32 size) {
    U32 count = 0;
    while (count < size && taken != written) {
        to[count++] = ring[taken % RING];
        ++taken;
    }
    return count;
}

int Mps2_send(const U8* bytes, U32 size) {
    if (Mps2_pump())
        return 1;
    memcpy(frame, bytes, size);
    frameSize = size;
    frameSent = 0;
    (void)Mps2_pump();
    return 0;
}

int Mps2_pump(void) {
    while (frameSent < frameSize && !(UART[STATE] & STATE_TX_FULL))
        UART[DATA] = frame[frameSent++];
    return frameSent < frameSize;
}

void Mps2_sleep(void) {
    __asm__ volatile("wfi");
}

static void onUart(void) {
    /* The interrupt is cleared before the loop, so that a byte which arrives after the loop causes
     * another interrupt. */
    UART[INTERRUPT] = INTERRUPT_RX;
    while (UART[STATE] & STATE_RX_FULL) {
        U8 byte = (U8)UART[DATA];
        /* if the ring is full, drops the byte; the link layer sends it again */
        if (written - taken < RING) {
            ring[written % RING] = byte;
            ++written;
        }
    }
    Mps2_onReceive();
}

static void onTick(void) {
    ++milliseconds;
}

static void halt(void) {
    for (;;)
        Mps2_sleep();
}

/* Handlers for a program without a kernel. A kernel replaces them by its own handlers with these
 * names, as in CMSIS. */
void SVC_Handler(void) __attribute__((weak, alias("halt")));
void PendSV_Handler(void) __attribute__((weak, alias("halt")));
void SysTick_Handler(void) __attribute__((weak, alias("onTick")));

extern U8 data_load[], data_begin[], data_end[], bss_begin[], bss_end[];
int main(void);
void stack_top(void); /* initial stack pointer, not a function */

void Mps2_reset(void);
void Mps2_reset(void) {
    memcpy(data_begin, data_load, (size_t)(data_end - data_begin));
    memset(bss_begin, 0, (size_t)(bss_end - bss_begin));
    (void)main();
    halt();
}

typedef void (*Vector)(void);
__attribute__((section(".vectors"), used)) static const Vector vectors[] = {
    stack_top, Mps2_reset, halt, halt,        halt, halt, halt,           0,
    0,         0,          0,    SVC_Handler, halt, 0,    PendSV_Handler, SysTick_Handler,
    onUart};
