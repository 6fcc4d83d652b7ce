// SPDX-License-Identifier: MIT
//
// pictures: netlists of small modules as SVG, drawn by Yosys' `show` and Graphviz.

#pragma once

#include "runner.h"

#include <map>
#include <string>

// Module -> SVG. Modules of more than a screenful of cells are left out, all without `dot`.
std::map<std::string, std::string> drawNetlists(const Plan& plan, const Library& library,
                                                const RunnerOptions& options);
