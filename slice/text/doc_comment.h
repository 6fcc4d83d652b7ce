// SPDX-License-Identifier: MIT
//
// doc_comment: converts doc comments of Slice to C comments.

#pragma once

#include "front/ast.h"
#include "text/writer.h"
#include <string>
#include <vector>

// Returns the lines of the text without stars and indentation. @param, @return, @throws and {@link}
// are replaced by words.
std::vector<std::string> docLines(const std::string& doc);
// Writes the doc comment, if there is one, and an additional line if the metadata contains
// ["deprecate"].
void writeDoc(Writer& w, const std::string& doc, const std::vector<std::string>& metadata = {});
