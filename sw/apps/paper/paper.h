/* SPDX-License-Identifier: MIT
 *
 * paper: what the paper's figures leave out: boot and interrupt of a program with one main task.
 */
#ifndef PAPER_H
#define PAPER_H

#include "fsmc.h"
#include "icec.h"

/* The program's task. */
void appMainTask(void *argument);

/* XBeeATEndpoint_init, the link and the task below it, and IceC's locks. */
void PAPER_useRadio(Ice_CommunicatorPtr ic);

/* Creates the task; call between OSInit and OSStart. */
void PAPER_start(const Fsmc_Port *port, void *context);

/* The FPGA's interrupt, a level; and whether it is unmasked. */
void PAPER_irqHandler(void);
int PAPER_irqEnabled(void);

#endif
