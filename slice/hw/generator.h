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

// ---- map: the register in a core's slot for each value of a [":hw"] interface ----

// firstWord: number of the first word for values, after the words ID, EVENT and MASK. slotWords:
// number of words in a slot.
constexpr unsigned firstWord = 3, slotWords = 16;
constexpr unsigned control = 3, status = 4, page = 5, pageLsb = 5;
// The register PAGE selects the page that appears at words 8 to 15 of the slot. Word n is on page n
// / slotWords and appears at n % slotWords, which is at least 8 on every page except page 0.
constexpr unsigned pageWords = 8, mostPageBits = 5;
// alignment of a buffer, bytes; a burst can then start at the beginning of the buffer
constexpr unsigned bufferAlignment = 128;
constexpr unsigned mostPins = 32; // largest number of pins of a core in one direction
constexpr unsigned mostOperations = 16, refusedLsb = 16, resetBit = 31;

// A field of a word: a scalar, or half of a 64-bit scalar. The same bits are also a range of a
// port.
struct Piece {
    Type type;
    std::string name; // name of the field: a_x for member x of parameter a
    std::string c;    // C name in the servant's function: a->x
    unsigned lsb = 0, width = 0;
    unsigned portLsb = 0, portWidth = 0;
    // 0 for a parameter or result of the call; n for a member of the n-th exception
    unsigned exception = 0;
    bool isCode = false; // true for the field with the code of an exception (0: no exception)
    // true if the field is the number of elements of a sequence. The elements are in DDR3, `offset`
    // bytes after the start of the slot's buffers.
    bool isCount = false;
    unsigned offset = 0, most = 0, elementBytes = 0;
};

struct Word {
    unsigned number = 0;
    std::string name; // ADD_IN0
    std::string call; // name of the call to which the word belongs
    bool isOut = false;
    std::vector<Piece> pieces;
    unsigned width() const { return pieces.back().lsb + pieces.back().width; }
};

// A call of one of the core's operations, or an event: a call that the core makes, of an
// operation of a callback interface.
struct Call {
    const Operation* operation = nullptr;
    bool isEvent = false;
    // true for an operation with ["amd"]: the core takes a long time, and the processor does other
    // work meanwhile
    bool isAmd = false;
    const Declaration* owner = nullptr; // interface that declares the operation
    // exceptions that the operation throws; the first one has code 1, the second one code 2, ...
    std::vector<const Declaration*> thrown;
    std::vector<std::string> labels; // C constants of these codes
    std::string name;                // snake_case
    // bit number of the call in CONTROL, STATUS, EVENT and MASK
    unsigned bit = 0;
    bool isLong = false;
    unsigned timeout = 0; // time-out, ms
    std::vector<Word> words;
};

// An operation that subscribes a listener.
struct Listener {
    const Operation* operation = nullptr;
    const Declaration* interface = nullptr;
    std::string name;            // snake_case
    size_t first = 0, count = 0; // range of the listener's events in Block::calls
};

// A port of the core that is connected to pins of the chip, not to the slot.
struct Pin {
    std::string name; // ends with _i or _o
    unsigned width = 1;
    bool isOut() const { return name.back() == 'o'; }
};

struct Block {
    const Declaration* interface = nullptr;
    std::string source; // name of the Slice file, without .ice
    std::string header; // name of the generated C header
    std::string name;   // snake_case
    unsigned type = 0, version = 0;
    std::vector<Call> calls;
    std::vector<Listener> listeners;
    std::vector<Pin> pins;
    // true if the core has a clock that may stop; while the clock is stopped, accesses are not
    // answered
    bool hasOwnClock = false;
    // The number of pages is 2^pageBits. 0: the slot has one page, and no word PAGE (word 5).
    unsigned pageBits = 0;
    unsigned memoryWord = 0;  // number of the word MEMORY; 0 without sequences
    unsigned memoryBytes = 0; // size of all buffers in bytes, a power of two

    bool hasLong() const;
    unsigned memoryLsb() const; // number of the lowest address bit that MEMORY stores
    unsigned events() const;    // Returns the number of bits of EVENT that are used.
    // Returns a mask of the bits of EVENT that can become 1. Without it, synthesis would keep a
    // flip-flop for each of the other bits.
    unsigned raised() const;
    unsigned numbers() const; // Returns the number of words, a multiple of slotWords.
    bool isPaged(unsigned word) const { return pageBits && word % slotWords >= pageWords; }
    // Returns all words of parameters and results, in the order of their numbers.
    std::vector<const Word*> words() const;
};

// A port of a wrapper.
struct Port {
    std::string name; // name of the port, with _i or _o
    bool isOut = false;
    unsigned width = 1;
    std::string group; // title of the group of ports that begins with this port; otherwise empty
    // call to which the port belongs; null for a port that every wrapper has
    const Call* call = nullptr;
};

std::vector<Port> wrapperPorts(const Block& b);

// Maps all hardware interfaces of the unit's main file. Errors are reported to `diagnostics`.
std::vector<Block> mapHardware(const Unit& unit, Diagnostics& diagnostics);

// Assigns words to the calls of an interface.
void mapCalls(const Declaration& d, const Unit& unit, Block& block, Diagnostics& diagnostics);
// Parses an integer, decimal or 0x..., between `low` and `high`. Returns false if the text is not
// such a number.
bool number(const std::string& text, unsigned low, unsigned high, unsigned& value);
// Reports each hw: metadata that is not in `known`.
void checkKeys(const std::vector<std::string>& metadata, const std::vector<std::string>& known,
               const std::string& who, const Location& at, Diagnostics& diagnostics);

std::string snakeCase(const std::string& name);
std::string upperCase(std::string text);
std::string hexDigits(unsigned value, unsigned digits);

// ---- words: functions that depend on types ----

// True for a number, a bool, an enum, or a struct of such types.
bool isMappable(const Type& type);
// Appends the scalars of a value as fields of words. Successive scalars share a word if they fit
// and the word has no assigned number. A 64-bit scalar takes two words, the low half first. `c` is
// the C lvalue of the value; for a pointer p, it is "*p".
void addValue(std::vector<Word>& words, const Type& type, const std::string& name,
              const std::string& c, bool isOut, unsigned exception = 0);

// Appends the number of elements of a sequence that lies `offset` bytes into the slot's buffers.
void addCount(std::vector<Word>& words, const Type& type, const std::string& name,
              const std::string& c, bool isOut, unsigned most, unsigned offset);
// Appends the code of the exception that was thrown, 1 to `count`; 0 means that none was thrown.
void addCode(std::vector<Word>& words, size_t count);
// Returns the name of the port with the address of a sequence. `count` is the field with the number
// of elements: if its name is "a_count", the port is "a_base".
std::string baseName(const Piece& count);

bool isSequence(const Type& type);
// Returns the size in bytes of an element in DDR3, where it has the layout that C compilers use.
// Returns 0 if compilers differ in the layout of the type.
unsigned elementBytes(const Type& type);

GeneratedFile registersFile(const Block& b); // <block>.regs.json
GeneratedFile verilogFile(const Block& b);   // <block>_wrapper.v
GeneratedFile vhdlFile(const Block& b);      // <block>_wrapper.vhd
GeneratedFile servantHeader(const Block& b); // <block>_servant.h
GeneratedFile servantSource(const Block& b); // <block>_servant.c

GeneratedFile proxyFile(const Block& b); // <block>_proxy.h

// Return the files that a new core starts with: <block>.v, <block>.vhd and <block>_test.cpp.
GeneratedFile verilogSkeleton(const Block& b);
GeneratedFile vhdlSkeleton(const Block& b);
GeneratedFile testSkeleton(const Block& b);

// ---- the head and the ports of a wrapper ----

// Writes the comment at the head of a wrapper; `mark` begins its lines.
void wrapperHead(Writer& w, const Block& b, const std::string& mark);

// Return the type of a port: "[7:0] " in Verilog, "" for one bit; "std_logic_vector(7 downto 0)" in
// VHDL, "std_logic" for one bit.
std::string verilogRange(unsigned width);
std::string vhdlType(unsigned width);
// Writes an entity, up to the declarations of its architecture, with a package that it uses.
void vhdlEntity(Writer& w, const std::string& name, const std::vector<Port>& ports,
                const std::string& package = "");

// ---- values of the servant ----

std::string coreType(const Block& b); // Module_Interface_Core

// Generates the code that writes parameters to registers and buffers. In this code, `hw_core` is
// the servant.
void writeParameters(Writer& w, const Block& b, const Call& c);
// Generates the code that reads results from registers and buffers and stores them through
// pointers. If the core reports an exception, this code returns.
void readResults(Writer& w, const Block& b, const Call& c);
// Declares the variables that writeParameters and readResults need.
void resultVariables(Writer& w, const Call& c);
// Declares members of the servant's struct that hold the elements of received sequences.
void sequenceMembers(Writer& w, const Block& b);
void checkLayouts(Writer& w, const Block& b);

} // namespace hw
