// SPDX-License-Identifier: MIT
//
// app_uav: the UAV's application.

#include "app.h"

UavMachine::Firmware simulatedFirmware(const std::vector<uint8_t>& radioKey) {
    static std::vector<uint8_t> key;
    key = radioKey;
    uav_radioKey = key.empty() ? nullptr : key.data();
    return {};
}
