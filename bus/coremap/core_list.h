// SPDX-License-Identifier: MIT
//
// core_list: the cores in ip/cores.list, with the resources that the chip gives each
// (docs/hw-mapping.md).

#ifndef CORE_LIST_H
#define CORE_LIST_H

#include <cstdint>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

struct Pin {
    std::string name; // the core's port; its end says the direction
    unsigned width = 1;
    unsigned lsb = 0;                // in the chip's core_pins_i or core_pins_o; bits
    std::string source;              // instead of a pin: another core's output
    bool isInternal = false;         // for other cores only, never a pin; unconnected inputs are 0
    std::vector<std::string> places; // of its bits on the board, from bit 0; empty: not given
    bool isPin() const { return source.empty() && !isInternal; }
    bool isOut() const { return name.back() == 'o'; }
};

// A signal that a probe records, by its name in the simulator, below soc.
struct Signal {
    std::string name;
    unsigned width = 1;
};

struct Core {
    std::string name, folder, identity;
    unsigned line = 0, slot = 0;
    int port = -1;            // memory port; -1: none
    unsigned memory = 0;      // DDR3 byte address of its buffers, a multiple of memoryBytes
    unsigned memoryBytes = 0; // a power of two, or 0: no buffers
    bool isPlaced = false;    // memory= gives its address
    std::string servantType, servantHeader;
    std::vector<Pin> pins;
    std::string constraints; // <folder>.ucf beside its description, or nothing
    bool hasClock = false;   // the module has the parameter CLK_HZ
    unsigned ownClock = 0;   // Hz at most of its own clock; 0: it has the chip's
    // Its own clock is the chip's clock times this ratio; 0: the pin clock_i, its last, brings it.
    unsigned multiply = 0, divide = 1;
    // Returns the frequency of its own clock, Hz; for a clock from a pin, the highest.
    double clockHz() const { return multiply ? 100e6 / divide * multiply : ownClock; }
    bool saysIdle = false;       // the module has the output idle_o
    bool hasGate = false;        // its clock stops while it is idle, on the board, too
    bool isProbe = false;        // it has cycles_i and signals_i
    std::vector<Signal> signals; // of a probe, from bit 0 of signals_i on
    // A core without a servant has the one of sw/hw/registers.
    bool isGeneric() const { return servantType.empty(); }
};

struct Chip {
    std::vector<Core> cores; // by slot
    unsigned slots = 0, ports = 0;
    unsigned registers = 0;    // the processor's address of slot 0
    unsigned pins[2] = {0, 0}; // bits used of core_pins_i, core_pins_o
};

// Reads `list`, a file's text, into a chip. `base` is the platform's map; `descriptions` are the
// cores' *.regs.json by folder. Throws for a line that is wrong, with its number.
Chip readCores(const std::string& list, const nlohmann::json& base,
               const std::map<std::string, nlohmann::json>& descriptions);

// 64-bit words of a probe's change: 1, 2 or 4, for 31, 95 or 223 bits (ip/probe/probe.v).
unsigned changeWords(const Core& probe);
// Hash of its signals' names and widths.
uint32_t namesOf(const Core& probe);
nlohmann::ordered_json probesOf(const Chip& chip); // the signals of each probe, for the ground

nlohmann::ordered_json mapOf(const Chip& chip, const nlohmann::ordered_json& base);
std::string pinTableOf(const Chip& chip);    // pins by name, for the simulator
std::string constraintsOf(const Chip& chip); // pins by place, for ISE

// A populated slot, the platform's included, with its *.regs.json.
struct Slot {
    std::string name;
    unsigned number, address; // address: the processor's
    nlohmann::json description;
};
constexpr unsigned slotBytes = 64;
// The hash of the register properties that software relies on: places, widths, accesses, names.
uint32_t contractOf(const nlohmann::json& description);
std::string verilogOf(const Chip& chip, const std::vector<Slot>& slots);   // instances, for soc.v
std::string instancesOf(const Chip& chip, const std::vector<Slot>& slots); // for the firmware
std::string svdOf(const std::vector<Slot>& slots);
std::string rdlOf(const std::vector<Slot>& slots);       // SystemRDL
std::string ipxactOf(const std::vector<Slot>& slots);    // IP-XACT
std::string escaped(const std::string& text);            // as text of XML and HTML
nlohmann::json registersOf(const nlohmann::json& block); // with the three that every slot has
std::string htmlOf(const std::vector<Slot>& slots);

#endif
