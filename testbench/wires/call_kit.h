// SPDX-License-Identifier: MIT
//
// call_kit: simulates the last step of the bring-up. The vehicle's firmware answers a call over a
// cable in the modem's place, on a board with faults.

#pragma once

#include "wire_fault.h"
#include <string>
#include <vector>

// Makes the call, for at most `seconds` of simulated time. Returns the step's lines of the report
// (sw/bringup/console.h).
std::string callOverCable(const std::string& firmware, const std::vector<WireFault>& faults,
                          double seconds = 10);
