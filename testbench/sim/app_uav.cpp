// SPDX-License-Identifier: MIT
//
// app_uav: selects the UAV's application as the firmware of a simulator.

#include "uav_machine.h"

UavMachine::Firmware simulatedFirmware(const std::vector<uint8_t>& modemKey, bool) {
    static std::vector<uint8_t> key;
    key = modemKey;
    uav_modemKey = key.empty() ? nullptr : key.data();
    return {};
}
