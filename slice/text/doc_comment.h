// SPDX-License-Identifier: MIT
//
// doc_comment: doc comments of Slice as comments of C.

#pragma once

#include "front/ast.h"
#include "text/writer.h"
#include <string>
#include <vector>

// The text without stars and margins; @param, @return, @throws and {@link} in plain words.
std::vector<std::string> docLines(const std::string& doc);
// Writes it, with a line for ["deprecate"]; nothing where there is neither.
void writeDoc(Writer& w, const std::string& doc, const std::vector<std::string>& metadata = {});
