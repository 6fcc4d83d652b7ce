// SPDX-License-Identifier: MIT
//
// lights: a run in seven lights: tests, proofs, plan, mutants, coverage, size, speed. Green, red,
// or grey: not measured, or the sources have changed since.

#ifndef LIGHTS_H
#define LIGHTS_H

#include <nlohmann/json.hpp>
#include <string>

// Makes the lights from what report.cpp has gathered: [{name, state, text}]. The text of a red
// light says what is wrong. `source` is the tree whose state the measurements are compared with.
nlohmann::json lightsOf(const nlohmann::json& data, const std::string& source);

// Prints a line a light for the terminal.
std::string lightsText(const nlohmann::json& lights);

#endif
