// SPDX-License-Identifier: MIT
//
// core_pins: drives the pins of cores by a script, and writes down what cores drive.

#ifndef CORE_PINS_H
#define CORE_PINS_H

#include "soc_model.h"
#include <string>

// Plays `script` on the chip's inputs, a change a line: "12.5 servo.fault_i 1" is milliseconds,
// instance and port, value; # begins a comment. Every change of an output goes to the file `log` in
// the same form. Throws std::runtime_error, with file and line, for a script that is wrong.
void connectPins(SocModel& soc, const std::string& script, const std::string& log);

#endif
