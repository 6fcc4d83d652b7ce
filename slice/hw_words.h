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

// The number of elements of a sequence, which lies `offset` bytes behind the slot's buffers.
void addCount(std::vector<Word>& words, const Type& type, const std::string& name,
              const std::string& c, bool isOut, unsigned most, unsigned offset);
// Which exception it is, of `count`.
void addCode(std::vector<Word>& words, size_t count);
// a_count is the count of what a_base says where it is.
std::string baseName(const Piece& count);

bool isSequence(const Type& type);
// Bytes of an element in DDR3, as C lays it out; 0: of a type that is not laid out alike
// everywhere.
unsigned elementBytes(const Type& type);

} // namespace hw

#endif
