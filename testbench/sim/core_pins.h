// SPDX-License-Identifier: MIT
//
// core_pins: drives the inputs of cores by a script, and records their outputs.

#pragma once

#include "camera.h"
#include "soc_model.h"
#include <string>

// Plays `script` on the chip's inputs, a change a line: "12.5 servo.fault_i 1" is milliseconds,
// instance and port, value; # begins a comment. Every change of an output goes to the file `log` in
// the same form. Throws std::runtime_error, with file and line, for a wrong script.
void connectPins(SocModel& soc, const std::string& script, const std::string& log);

// Sends the frame to the camera core, one pixel every second clock, each time that `sends` returns
// true. `sends` is called every two milliseconds; between frames the sensor clock stops, as in many
// sensors. `note` gets the pins of each clock. Throws std::runtime_error if the chip has no such
// core.
void connectSensor(
    SocModel& soc, const Frame& frame, std::function<bool()> sends,
    std::function<void(uint32_t pins)> note = [](uint32_t) {});
