// SPDX-License-Identifier: MIT
//
// app: the firmware that the simulator runs on the host; each program that links sim_main defines
// it.

#ifndef APP_H
#define APP_H

#include "uav_machine.h"
#include <vector>

// `modemKey`: 16 bytes of the modem's AES key, or none; `isSecure`: the link has a key. Throws if
// the firmware cannot encrypt.
UavMachine::Firmware simulatedFirmware(const std::vector<uint8_t>& modemKey, bool isSecure);

#endif
