// SPDX-License-Identifier: MIT
//
// board_faults: plants faults of a board in the models of a vehicle: in its wires, its clock, its
// memory and its modem.

#pragma once

#include "soc_model.h"
#include "wire_fault.h"
#include <vector>

// Plants faults. Call it once, after the board was chosen and before the chip's reset. Throws
// std::runtime_error for a fault that the models do not implement.
void plantFaults(SocModel& soc, const std::vector<WireFault>& faults);

// Adds the typical delays of a board with wires of 10 cm. A signal at the wrong time then causes
// wrong data instead of an error of the simulation.
void delayWires(SocModel& soc);
