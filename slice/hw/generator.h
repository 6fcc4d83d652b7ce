// SPDX-License-Identifier: MIT
//
// generator: the files generated for a hardware interface, one function per file
// (docs/hw-mapping.md), and code shared by the wrappers in both languages.

#pragma once

#include "front/ast.h"
#include "text/writer.h"
#include <string>
#include <vector>

namespace hw {

// ---- map: the register of a slot for each value of a [":hw"] interface ----

constexpr unsigned firstWord = 3, slotWords = 16; // ID, EVENT and MASK come first
constexpr unsigned control = 3, status = 4, page = 5, pageLsb = 5;
// PAGE selects which words appear at 8..15 of a slot: word n is at n % slotWords on page n /
// slotWords, at least 8 on pages above 0.
constexpr unsigned pageWords = 8, mostPageBits = 5;
constexpr unsigned bufferAlignment = 128; // bytes: bursts begin there
constexpr unsigned mostPins = 32;         // pins of a core in one direction
constexpr unsigned mostOperations = 16, refusedLsb = 16, resetBit = 31;

// A scalar, or half of a 64-bit one, as a field of a word and bits of a port.
struct Piece {
    Type type;
    std::string name; // a_x: of parameter a, member x
    std::string c;    // its name in the servant's function: a->x
    unsigned lsb = 0, width = 0;
    unsigned portLsb = 0, portWidth = 0;
    unsigned exception = 0; // 0: of the call or its results; else a member of the n-th exception
    bool isCode = false;    // not a value: 0, or the number of the exception
    // The number of elements of a sequence, which is in DDR3, `offset` bytes after the start of the
    // slot's buffers.
    bool isCount = false;
    unsigned offset = 0, most = 0, elementBytes = 0;
};

struct Word {
    unsigned number = 0;
    std::string name; // ADD_IN0
    std::string call; // the name of its call
    bool isOut = false;
    std::vector<Piece> pieces;
    unsigned width() const { return pieces.back().lsb + pieces.back().width; }
};

// A call of the core's operation, or an event: a call from the core of a callback interface's
// operation.
struct Call {
    const Operation* operation = nullptr;
    bool isEvent = false;
    bool isAmd = false;                     // long, and the processor continues meanwhile
    const Declaration* owner = nullptr;     // the interface of the operation
    std::vector<const Declaration*> thrown; // codes 1, 2, ...
    std::vector<std::string> labels;        // their constants in C
    std::string name;                       // snake_case
    unsigned bit = 0;                       // bit in CONTROL, STATUS, EVENT and MASK
    bool isLong = false;
    unsigned timeout = 0; // milliseconds
    std::vector<Word> words;
};

// An operation that subscribes a listener.
struct Listener {
    const Operation* operation = nullptr;
    const Declaration* interface = nullptr;
    std::string name;            // snake_case
    size_t first = 0, count = 0; // range of Block::calls
};

// A pin of the chip, a port of the core besides its slot's.
struct Pin {
    std::string name; // ends with _i or _o
    unsigned width = 1;
    bool isOut() const { return name.back() == 'o'; }
};

struct Block {
    const Declaration* interface = nullptr;
    std::string source; // the Slice file, without .ice
    std::string header; // name of the generated C header
    std::string name;   // snake_case
    unsigned type = 0, version = 0;
    std::vector<Call> calls;
    std::vector<Listener> listeners;
    std::vector<Pin> pins;
    bool hasOwnClock = false; // the clock may stop: then accesses are not answered
    unsigned pageBits = 0;    // if not 0: word 5 is PAGE, and there are 2 to this power of pages
    unsigned memoryWord = 0;  // MEMORY; 0: no sequences
    unsigned memoryBytes = 0; // size of all buffers, a power of two

    bool hasLong() const;
    unsigned memoryLsb() const; // lowest address bit stored in MEMORY
    unsigned events() const;    // bits of EVENT that are used, from bit 0
    unsigned numbers() const;   // number of words, a multiple of slotWords
    bool isPaged(unsigned word) const { return pageBits && word % slotWords >= pageWords; }
    // Returns every word of parameters and results, by number.
    std::vector<const Word*> words() const;
};

// A port of a wrapper.
struct Port {
    std::string name; // with _i or _o
    bool isOut = false;
    unsigned width = 1;
    std::string group;          // heading of the group, for its first port
    const Call* call = nullptr; // 0: a port that each wrapper has
};

std::vector<Port> wrapperPorts(const Block& b);

// Maps all hardware interfaces of the unit's main file; errors are in `diagnostics`.
std::vector<Block> mapHardware(const Unit& unit, Diagnostics& diagnostics);

// Assigns words to the calls of an interface.
void mapCalls(const Declaration& d, const Unit& unit, Block& block, Diagnostics& diagnostics);
// Parses an integer, decimal or 0x..., within [low, high]. Returns false if it is malformed.
bool number(const std::string& text, unsigned low, unsigned high, unsigned& value);
// Checks that hw: metadata is one of `known`.
void checkKeys(const std::vector<std::string>& metadata, const std::vector<std::string>& known,
               const std::string& who, const Location& at, Diagnostics& diagnostics);

std::string snakeCase(const std::string& name);
std::string upperCase(std::string text);
std::string hexDigits(unsigned value, unsigned digits);

// ---- words: the part that depends on types ----

// True for a number, a bool, an enum, or a struct of these.
bool isMappable(const Type& type);
// Appends the scalars of the value. Successive ones share a word without a number if they fit; a
// 64-bit scalar takes two words, low one first. `c` is the lvalue in C; "*p" for the target of p.
void addValue(std::vector<Word>& words, const Type& type, const std::string& name,
              const std::string& c, bool isOut, unsigned exception = 0);

// Appends the number of elements of a sequence that lies `offset` bytes into the slot's buffers.
void addCount(std::vector<Word>& words, const Type& type, const std::string& name,
              const std::string& c, bool isOut, unsigned most, unsigned offset);
// Appends the code of the exception that was thrown, 1 to `count`.
void addCode(std::vector<Word>& words, size_t count);
// "a_base", the address port of the sequence that "a_count" counts.
std::string baseName(const Piece& count);

bool isSequence(const Type& type);
// Bytes of an element in DDR3, as C lays it out; 0 if compilers lay the type out differently.
unsigned elementBytes(const Type& type);

GeneratedFile registersFile(const Block& b); // <block>.regs.json
GeneratedFile verilogFile(const Block& b);   // <block>_wrapper.v
GeneratedFile vhdlFile(const Block& b);      // <block>_wrapper.vhd
GeneratedFile servantHeader(const Block& b); // <block>_servant.h
GeneratedFile servantSource(const Block& b); // <block>_servant.c

GeneratedFile proxyFile(const Block& b); // <block>_proxy.h

// Files to begin a core with: <block>.v, <block>.vhd, <block>_test.cpp
GeneratedFile verilogSkeleton(const Block& b);
GeneratedFile vhdlSkeleton(const Block& b);
GeneratedFile testSkeleton(const Block& b);

// ---- the head and the ports of a wrapper ----

// Writes the first comment of a wrapper; `mark` begins its lines.
void wrapperHead(Writer& w, const Block& b, const std::string& mark);

// Returns "[7:0] ", or "" for one bit; "std_logic_vector(7 downto 0)", or "std_logic".
std::string verilogRange(unsigned width);
std::string vhdlType(unsigned width);
// Writes an entity, up to the declarations of its architecture, with a package that it uses.
void vhdlEntity(Writer& w, const std::string& name, const std::vector<Port>& ports,
                const std::string& package = "");

// ---- values of the servant ----

std::string coreType(const Block& b); // Module_Interface_Core

// Moves parameters into registers and buffers; `hw_core` is the servant.
void writeParameters(Writer& w, const Block& b, const Call& c);
// Moves registers and buffers into results, through pointers; returns after an exception.
void readResults(Writer& w, const Block& b, const Call& c);
// Declares the variables of both.
void resultVariables(Writer& w, const Call& c);
// Declares room for the elements of received sequences, as members of the servant.
void sequenceMembers(Writer& w, const Block& b);
void checkLayouts(Writer& w, const Block& b);

} // namespace hw
