/* SPDX-License-Identifier: MIT
 *
 * mps2: the board of the porting examples, ARM's MPS2 with a Cortex-M3 (QEMU's mps2-an385): a
 * serial port and a clock. A port to another board replaces this file and mps2.c.
 */
#ifndef MPS2_H
#define MPS2_H

#include "icec_link.h"

#define MPS2_HZ 25000000U     /* clock frequency of the CPU, Hz */
#define MPS2_UART_PRIORITY 5U /* priority of the UART's interrupt, 0 (most urgent) to 7 */

/* Enables the serial port and its receive interrupt. */
void Mps2_start(void);

/* Starts SysTick, which counts the time for Mps2_nowMs. Not to be called if a kernel uses
 * SysTick. */
void Mps2_startClock(void);
U32 Mps2_nowMs(void);

/* Copies up to `size` received bytes to `to`, and returns their number. */
U32 Mps2_read(U8* to, U32 size);

/* Queues a frame for the serial port. Returns 0 if the frame was queued; returns 1 if the previous
 * frame is still being sent. Link_Port.transmit has the same results. */
int Mps2_send(const U8* frame, U32 size);

/* Moves queued bytes to the serial port. Returns 1 if bytes remain in the queue. */
int Mps2_pump(void);

/* Sleeps until the next interrupt. */
void Mps2_sleep(void);

/* Called by the receive interrupt. Each program defines this function. */
void Mps2_onReceive(void);

#endif
