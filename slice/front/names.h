// SPDX-License-Identifier: MIT
//
// names: Slice's keywords, and the identifiers that Slice allows.

#pragma once

#include "front/diagnostics.h"
#include <string>
#include <string_view>

struct NameRules {
    bool underscore = false; // underscores are allowed
    bool icePrefix = false;  // names may begin with "ice"
};

bool isKeyword(std::string_view word);

// Reports what is wrong with the name of a declaration.
void checkName(std::string_view name, const NameRules& rules, const Location& at,
               Diagnostics& diagnostics);

std::string lowerCase(std::string_view text);
