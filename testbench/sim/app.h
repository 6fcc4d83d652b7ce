// SPDX-License-Identifier: MIT
//
// app: which firmware the simulator runs on the host; each program that links sim_main answers.

#ifndef APP_H
#define APP_H

#include "uav_machine.h"

UavMachine::Firmware simulatedFirmware();

#endif
