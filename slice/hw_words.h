// SPDX-License-Identifier: MIT
//
// hw_words: scalars into words: the part of hw_map that knows the types.

#ifndef HW_WORDS_H
#define HW_WORDS_H

#include "hw_map.h"

namespace hw {

// A number, a bool, an enum, or a struct of such.
bool isMappable(const Type& type);
// Appends the value's scalars. Those that follow each other share a word where they fit; a scalar
// of 64 bits takes two words, low one first. `c` is the lvalue in C; "*p" for what p points to.
void addValue(std::vector<Word>& words, const Type& type, const std::string& name,
              const std::string& c, bool isOut);

} // namespace hw

#endif
