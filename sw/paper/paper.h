/* SPDX-License-Identifier: MIT
 *
 * paper: code that the paper's figures omit: start and interrupt of a program with one main task.
 */
#pragma once

#include "fsmc.h"
#include "icec.h"

/* The main task of the program, which is its only application task. */
void appMainTask(void* argument);

/* Prepares everything that XBeeATEndpoint_init needs: the link, the radio task, and the locks of
 * IceC. */
void PAPER_useRadio(Ice_CommunicatorPtr ic);

/* Creates the main task. Call this between OSInit and OSStart. */
void PAPER_start(const FSMC_Port* port, void* context);

/* Returns 1 while the interrupt is enabled; UAV_irqHandler is the interrupt routine. */
int PAPER_irqEnabled(void);
