/* SPDX-License-Identifier: MIT
 *
 * uav_modem: the radio task: sets the modem up, runs the links, and sets the modem up again if no
 * link comes up.
 */
#pragma once

#include "icec.h"

/* Prepares the links. Returns 0 if the vehicle has no key and was not opened. */
int UAV_initRadio(void);

/* Gives the communicator its endpoint. */
void UAV_useRadio(Ice_CommunicatorPtr ic);

void UAV_radioTask(void* argument);

/* Returns the time since the start by the OS's ticks, us. */
U32 UAV_nowUs(void);
