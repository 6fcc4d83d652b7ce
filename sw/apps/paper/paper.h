/* SPDX-License-Identifier: MIT
 *
 * paper: what the paper's figures leave out: boot and interrupt of a program with one main task.
 */
#ifndef PAPER_H
#define PAPER_H

#include "fsmc.h"
#include "icec.h"

/* Runs the program; its only task of its own. */
void appMainTask(void* argument);

/* XBeeATEndpoint_init, the link and the task below it, and IceC's locks. */
void PAPER_useRadio(Ice_CommunicatorPtr ic);

/* Creates the task; call between OSInit and OSStart. */
void PAPER_start(const FSMC_Port* port, void* context);

/* Handles the FPGA's interrupt, a level; tells whether it is unmasked. */
void PAPER_irqHandler(void);
int PAPER_irqEnabled(void);

#endif
