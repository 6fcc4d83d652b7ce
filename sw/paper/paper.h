/* SPDX-License-Identifier: MIT
 *
 * paper: what the figures of the paper omit: start and interrupt of a program with one main task.
 */
#pragma once

#include "fsmc.h"
#include "icec.h"

/* The program, run as the only application task. */
void appMainTask(void* argument);

/* Prepares what XBeeATEndpoint_init needs: the link, the radio task, and the locks of IceC. */
void PAPER_useRadio(Ice_CommunicatorPtr ic);

/* Creates the task. Call this between OSInit and OSStart. */
void PAPER_start(const FSMC_Port* port, void* context);

/* Returns 1 while the interrupt is enabled; UAV_irqHandler is the interrupt routine. */
int PAPER_irqEnabled(void);
