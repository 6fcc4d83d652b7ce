// SPDX-License-Identifier: MIT
//
// words: maps scalars to words: the part of hw_map that knows the types.

#ifndef SLICE_HW_WORDS_H
#define SLICE_HW_WORDS_H

#include "hw/map.h"

namespace hw {

// True if it is a number, a bool, an enum, or a struct of these.
bool isMappable(const Type& type);
// Appends the value's scalars. Successive ones share a word where they fit; a scalar of 64 bits
// takes two words, low one first. `c` is the lvalue in C; "*p" for the target of p.
void addValue(std::vector<Word>& words, const Type& type, const std::string& name,
              const std::string& c, bool isOut);

// Appends the number of elements of a sequence that lies `offset` bytes into the slot's buffers.
void addCount(std::vector<Word>& words, const Type& type, const std::string& name,
              const std::string& c, bool isOut, unsigned most, unsigned offset);
// Appends the code that tells which of `count` exceptions was thrown.
void addCode(std::vector<Word>& words, size_t count);
// "a_base", the address port of the sequence that "a_count" counts.
std::string baseName(const Piece& count);

bool isSequence(const Type& type);
// Bytes of an element in DDR3, as C lays it out; 0 if compilers lay the type out differently.
unsigned elementBytes(const Type& type);

} // namespace hw

#endif
