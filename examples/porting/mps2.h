/* SPDX-License-Identifier: MIT
 *
 * mps2: the board of the porting examples, ARM's MPS2 with a Cortex-M3 (QEMU's mps2-an385): a
 * serial port and a clock. A port to another board replaces this file and mps2.c.
 */
#ifndef MPS2_H
#define MPS2_H

#include "icec_link.h"

#define MPS2_HZ 25000000U     /* clock of the CPU, Hz */
#define MPS2_UART_PRIORITY 5U /* priority of its interrupt, 0 (urgent) to 7 */

/* Switches the serial port and its receive interrupt on. */
void Mps2_start(void);

/* Switches the clock on, if no kernel owns the SysTick. Mps2_nowMs then counts. */
void Mps2_startClock(void);
U32 Mps2_nowMs(void);

/* Takes received bytes, at most `size`; returns how many. */
U32 Mps2_read(U8* to, U32 size);

/* Queues a frame for the serial port. Returns 0 if it is taken, as Link_Port.transmit does; 1 while
 * the previous frame is being sent. */
int Mps2_send(const U8* frame, U32 size);

/* Moves queued bytes to the serial port; returns 1 while some are left. */
int Mps2_pump(void);

/* Sleeps until the next interrupt. */
void Mps2_sleep(void);

/* Called by the receive interrupt; the program defines it. */
void Mps2_onReceive(void);

#endif
