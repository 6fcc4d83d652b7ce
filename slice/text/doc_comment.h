// SPDX-License-Identifier: MIT
//
// doc_comment: doc comments of Slice as comments of C.

#pragma once

#include "front/ast.h"
#include "text/writer.h"
#include <string>
#include <vector>

// Returns the text without stars and margins, with @param, @return, @throws and {@link} in words.
std::vector<std::string> docLines(const std::string& doc);
// Writes it, with a line for ["deprecate"]; nothing if there is neither.
void writeDoc(Writer& w, const std::string& doc, const std::vector<std::string>& metadata = {});
