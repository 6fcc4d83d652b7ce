// SPDX-License-Identifier: MIT
//
// app_uav: the UAV's application.

#include "app.h"

UavMachine::Firmware simulatedFirmware() { return {}; }
