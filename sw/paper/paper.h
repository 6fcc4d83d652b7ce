/* SPDX-License-Identifier: MIT
 *
 * paper: what the paper's figures leave out: start and interrupt of a program with one main task.
 */
#pragma once

#include "fsmc.h"
#include "icec.h"

/* Runs the program as its only application task. */
void appMainTask(void* argument);

/* Sets up XBeeATEndpoint_init, the link, the radio task, and IceC's locks. */
void PAPER_useRadio(Ice_CommunicatorPtr ic);

/* Creates the task; call between OSInit and OSStart. */
void PAPER_start(const FSMC_Port* port, void* context);

int PAPER_irqEnabled(void); /* the interrupt itself is handled by UAV_irqHandler */
