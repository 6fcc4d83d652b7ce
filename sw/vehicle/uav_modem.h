/* SPDX-License-Identifier: MIT
 *
 * uav_modem: the radio task. It configures the modem, runs the links, and configures the modem
 * again if no link comes up.
 */
#pragma once

#include "icec.h"

/* Initialises the links. Returns 0 if the vehicle has no key and was not explicitly opened. */
int UAV_initRadio(void);

/* Adds the radio's endpoint to the communicator. */
void UAV_useRadio(Ice_CommunicatorPtr ic);

void UAV_radioTask(void* argument);

/* Returns the time since the start in us, with the resolution of an operating system tick. */
U32 UAV_nowUs(void);
