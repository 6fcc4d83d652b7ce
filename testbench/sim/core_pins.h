// SPDX-License-Identifier: MIT
//
// core_pins: drives the inputs of cores from a script, and records their outputs.

#pragma once

#include "camera.h"
#include "soc_model.h"
#include <string>

// Plays `script` on the chip's inputs. Each line is one change: in "12.5 servo.fault_i 1", 12.5 is
// the time in ms, servo.fault_i is instance and port, and 1 is the value; # begins a comment.
// Writes each change of an output to the file `log` in the same format. Throws std::runtime_error,
// with file and line, if the script is wrong.
void connectPins(SocModel& soc, const std::string& script, const std::string& log);

// Calls `sends` every two milliseconds. If it returns true, sends the frame to the camera core, one
// pixel every second clock. Between frames the sensor clock stops, as in many sensors. `note`
// receives the levels of the pins in each clock (default: none). Throws std::runtime_error if the
// chip has no camera core.
void connectSensor(SocModel& soc, const Frame& frame, std::function<bool()> sends,
                   std::function<void(uint32_t pins)> note = nullptr);
