// SPDX-License-Identifier: MIT
//
// description: writes the declarations of a unit as JSON, for programs that call operations without
// generated code (docs/call.md).

#pragma once

#include "front/ast.h"
#include "text/json.h"

// Adds the declarations of the unit and of included files, each under its full name:
//
//   "::Autopilot::Feature": {"kind": "struct", "file": "Autopilot.ice", "doc": "...", "fields":
//   [...]}
//
// A type is written as text: "short", "::Cores::Samples"; a proxy as "::Demo::Watcher*" or
// "Object*".
void describeUnit(const Unit& unit, Json& declarations);
