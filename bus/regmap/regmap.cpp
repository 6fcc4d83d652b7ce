// SPDX-License-Identifier: MIT
//
// regmap: turns the register description of a block (*.regs.json) into what each side includes:
// <block>_regs.vh (Verilog localparams), <block>_regs.h (C90 macros), <block>_regs_pkg.vhd (VHDL
// package), <block>_regs.md (page for people); or, with --clocked, <block>_clocked.v (the block
// behind bus_crossing.v). Format of the description: docs/bus.md.

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <fstream>
#include <iostream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

using nlohmann::json;

namespace {

constexpr unsigned wordsPerSlot = 16;

struct Field {
    std::string name, doc;
    unsigned lsb = 0, width = 1;
};
struct Register {
    std::string name, access, doc;
    unsigned word = 0, width = 32;
    int page = -1; // the PAGE that it needs: a byte address in a core behind an adapter
    std::vector<Field> fields{};
};
struct Constant {
    std::string name, doc;
    unsigned long value = 0;
};
struct Block {
    std::string name, prefix, doc;
    bool isSlot = false; // has ID, EVENT and MASK in words 0..2
    std::vector<Constant> constants;
    std::vector<Register> registers;
};

std::string upper(std::string s) {
    for (char& c : s)
        c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return s;
}

unsigned long number(const json& v) {
    return v.is_string() ? std::stoul(v.get<std::string>(), nullptr, 0) : v.get<unsigned long>();
}

void check(bool ok, const std::string& what) {
    if (!ok)
        throw std::runtime_error(what);
}

// Adds the words that every slot begins with: its id, its sticky events, their mask.
void addCommonWords(Block& b, const json& j) {
    Register event{"EVENT", "w1c", "sticky events; write 1 to clear", 1};
    Register mask{"MASK", "rw", "1: the event drives the interrupt line", 2};
    for (const json& e : j.value("events", json::array())) {
        Field f{e.at("name"), e.at("doc"), e.at("bit").get<unsigned>(), 1};
        event.fields.push_back(f);
        mask.fields.push_back(f);
    }
    Register id{"ID", "ro", "type and version of the slot", 0};
    id.fields = {{"VERSION", "major and minor, 8 bits each", 0, 16}, {"TYPE", "type id", 16, 16}};
    b.constants.push_back(
        {"ID_VALUE", "what word ID reads", number(j.at("type")) << 16 | number(j.at("version"))});
    b.registers.insert(b.registers.begin(), {id, event, mask});
}

void checkRegisters(const Block& b) {
    std::set<std::pair<unsigned, int>> words;
    std::set<std::string> names; // as the generated files spell them
    for (const Constant& c : b.constants)
        check(names.insert(c.name).second, fmt::format("{} is there twice", c.name));
    for (const Register& r : b.registers) {
        static const std::set<std::string> accesses = {"ro", "rw", "w1c", "ws"};
        check(names.insert(r.name).second, fmt::format("{} is there twice", r.name));
        check(r.word < wordsPerSlot, fmt::format("{}: word {} is not in 0..15", r.name, r.word));
        check(words.insert({r.word, r.page}).second && (r.page < 0 || !words.count({r.word, -1})),
              fmt::format("{}: word {} is taken", r.name, r.word));
        check(r.page < 0 || (r.word >= 8 && r.page % 32 == 0),
              fmt::format("{}: only words 8..15 have a page, a multiple of 32", r.name));
        check(r.width > 0 && r.width <= 32, fmt::format("{}: its width is 1..32 bits", r.name));
        check(accesses.count(r.access),
              fmt::format("{}: access '{}' is not one of ro rw w1c ws", r.name, r.access));
        unsigned long used = 0;
        for (const Field& f : r.fields) {
            check(f.width > 0 && f.lsb + f.width <= 32,
                  fmt::format("{}.{}: bits {}..{} do not fit a word", r.name, f.name,
                              f.lsb + f.width - 1, f.lsb));
            check(names.insert(r.name + "_" + f.name + "_LSB").second,
                  fmt::format("{}.{} is there twice", r.name, f.name));
            unsigned long bits = ((1ul << f.width) - 1) << f.lsb;
            check(!(used & bits), fmt::format("{}.{}: overlaps another field", r.name, f.name));
            used |= bits;
        }
    }
}

Block parse(const json& j) {
    Block b;
    b.name = j.at("block");
    b.prefix = upper(b.name);
    b.doc = j.at("doc");
    b.isSlot = j.contains("type");
    for (const json& c : j.value("constants", json::array()))
        b.constants.push_back({c.at("name"), c.at("doc"), number(c.at("value"))});
    for (const json& r : j.at("registers")) {
        Register out{r.at("name"),          r.at("access"),
                     r.at("doc"),           r.at("word").get<unsigned>(),
                     r.value("width", 32u), r.value("page", -1)};
        for (const json& f : r.value("fields", json::array()))
            out.fields.push_back({f.at("name"), f.at("doc"), f.at("lsb").get<unsigned>(),
                                  f.at("width").get<unsigned>()});
        b.registers.push_back(out);
    }
    if (b.isSlot)
        addCommonWords(b, j);
    checkRegisters(b);
    return b;
}

std::string verilog(const Block& b) {
    std::string s = fmt::format("// Generated from {}.regs.json: do not edit.\n"
                                "// verilator lint_off UNUSEDPARAM\n",
                                b.name);
    for (const Constant& c : b.constants)
        s += fmt::format("localparam [31:0] {}_{} = 32'h{:08X}; // {}\n", b.prefix, c.name, c.value,
                         c.doc);
    for (const Register& r : b.registers) {
        s += fmt::format("localparam [3:0] {}_{} = 4'd{}; // {}: {}\n", b.prefix, r.name, r.word,
                         r.access, r.doc);
        for (const Field& f : r.fields)
            s += fmt::format("localparam integer {0}_{1}_{2}_LSB = {3}, {0}_{1}_{2}_WIDTH = {4};\n",
                             b.prefix, r.name, f.name, f.lsb, f.width);
    }
    return s + "// verilator lint_on UNUSEDPARAM\n";
}

// Registers and fields as initialisers of Hw_Register (sw/hw/registers).
std::string table(const Block& b) {
    std::string s = fmt::format("\n#define {}_TABLE", b.prefix);
    auto entry = [&](const Register& r, const std::string& name, unsigned lsb, unsigned width) {
        s += fmt::format(" \\\n    {{{{{}, \"{}\"}}, Hw_{}, {}, {}, {}, {}}},", name.size(), name,
                         r.access, r.word, lsb, width, r.page);
    };
    for (const Register& r : b.registers) {
        entry(r, r.name, 0, r.width);
        for (const Field& f : r.fields)
            entry(r, r.name + "." + f.name, f.lsb, f.width);
    }
    s.back() = '\n'; // C90 allows no comma there
    return s;
}

std::string cHeader(const Block& b) {
    std::string s = fmt::format("/* Generated from {0}.regs.json: do not edit.\n * {1} */\n"
                                "#ifndef {2}_REGS_H\n#define {2}_REGS_H\n\n",
                                b.name, b.doc, b.prefix);
    for (const Constant& c : b.constants)
        s += fmt::format("#define {}_{} 0x{:X}U /* {} */\n", b.prefix, c.name, c.value, c.doc);
    for (const Register& r : b.registers) {
        s += fmt::format("\n#define {}_{} {}U /* {}: {} */\n", b.prefix, r.name, r.word, r.access,
                         r.doc);
        if (r.page >= 0)
            s += fmt::format("#define {}_{}_PAGE 0x{:X}U\n", b.prefix, r.name, r.page);
        for (const Field& f : r.fields)
            s += fmt::format("#define {0}_{1}_{2}_LSB {3}U /* {4} */\n"
                             "#define {0}_{1}_{2}_MASK 0x{5:X}U\n",
                             b.prefix, r.name, f.name, f.lsb, f.doc,
                             ((1ul << f.width) - 1) << f.lsb);
    }
    if (b.isSlot)
        s += table(b);
    return s + "\n#endif\n";
}

std::string vhdl(const Block& b) {
    std::string s = fmt::format("-- Generated from {0}.regs.json: do not edit.\n"
                                "package {0}_regs_pkg is\n",
                                b.name);
    for (const Constant& c : b.constants)
        if (c.value <= 0x7FFFFFFF)
            s += fmt::format("  constant {}_{} : natural := {}; -- {}\n", b.prefix, c.name, c.value,
                             c.doc);
    for (const Register& r : b.registers) {
        s += fmt::format("  constant {}_{} : natural := {}; -- {}: {}\n", b.prefix, r.name, r.word,
                         r.access, r.doc);
        for (const Field& f : r.fields)
            s += fmt::format("  constant {0}_{1}_{2}_LSB : natural := {3};\n"
                             "  constant {0}_{1}_{2}_WIDTH : natural := {4};\n",
                             b.prefix, r.name, f.name, f.lsb, f.width);
    }
    return s + "end package;\n";
}

std::string markdown(const Block& b) {
    std::string s = fmt::format("# `{}`\n\n{}\n", b.name, b.doc);
    if (!b.constants.empty()) {
        s += "\n| constant | value | meaning |\n|---|---|---|\n";
        for (const Constant& c : b.constants)
            s += fmt::format("| {} | {} (0x{:X}) | {} |\n", c.name, c.value, c.value, c.doc);
    }
    if (!b.registers.empty())
        s += "\n| word | register | access | bits | meaning |\n|---|---|---|---|---|\n";
    for (const Register& r : b.registers) {
        s += fmt::format("| {}{} | **{}** | {} | {} | {} |\n", r.word,
                         r.page < 0 ? "" : fmt::format(", PAGE 0x{:X}", r.page), r.name, r.access,
                         r.width < 32 ? fmt::format("{}..0", r.width - 1) : "", r.doc);
        for (const Field& f : r.fields)
            s += fmt::format("| | {} | | {} | {} |\n", f.name,
                             f.width == 1 ? fmt::format("{}", f.lsb)
                                          : fmt::format("{}..{}", f.lsb + f.width - 1, f.lsb),
                             f.doc);
    }
    return s + "\nAccess: ro read only; rw read and write; w1c write 1 to clear; ws write acts, "
               "reads as 0.\n";
}

// The block, a core with a clock of its own, with a slot's ports; clock_i is its clock.
std::string clocked(const Block& b, const json& j, bool hasClkHz) {
    check(
        !j.value("memory_port", false),
        "a core with a memory port has the chip's clock, which the port has; one of its own for a "
        "part of the core: hdl/cdc/async_fifo.v, as ip/camera does");
    std::string ports, pins;
    for (const json& p : j.value("pins", json::array())) {
        auto name = p.at("name").get<std::string>();
        unsigned width = p.value("width", 1u);
        ports += fmt::format(",\n    {} wire {}{}", name.back() == 'o' ? "output" : "input ",
                             width == 1 ? "" : fmt::format("[{}:0] ", width - 1), name);
        pins += fmt::format(",\n        .{0}({0})", name);
    }
    return fmt::format(
        R"(// Generated from {0}.regs.json: do not edit. {0} in a clock of its own (docs/hw-mapping.md).

`default_nettype none

module {0}_clocked{1} (
    `include "slot_ports.vh"
    output wire        irq_o,
    input  wire        clock_i{2}
);
    wire        rst, valid, write, ready, error, irq;
    wire [3:0]  addr;
    wire [31:0] wdata, rdata;
    bus_crossing u_crossing (
        `include "slot_connect.vh"
        .irq_o(irq_o),
        .core_clk_i(clock_i), .core_rst_o(rst), .core_valid_o(valid), .core_write_o(write),
        .core_addr_o(addr), .core_wdata_o(wdata), .core_ready_i(ready), .core_rdata_i(rdata),
        .core_error_i(error), .core_irq_i(irq)
    );
    {0} {3}u_core (
        .clk_i(clock_i), .rst_i(rst), .bus_valid_i(valid), .bus_write_i(write), .bus_addr_i(addr),
        .bus_wdata_i(wdata), .bus_ready_o(ready), .bus_rdata_o(rdata), .bus_error_o(error),
        .irq_o(irq){4}
    );
endmodule
)",
        b.name, hasClkHz ? " #(\n    parameter CLK_HZ = 100000000 // of clock_i\n)" : "", ports,
        hasClkHz ? "#(.CLK_HZ(CLK_HZ)) " : "", pins);
}

void save(const std::string& path, const std::string& text) {
    std::ofstream out(path, std::ios::binary);
    out << text;
    out.close();
    check(bool(out), fmt::format("cannot write '{}'", path));
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app{"Generates the Verilog, C, VHDL and Markdown view of a block's registers."};
    std::string input, outputDir = ".";
    app.add_option("description", input, "the block's *.regs.json")->required();
    app.add_option("--output-dir", outputDir, "where the four files go");
    bool isClocked = false, hasClkHz = false;
    app.add_flag("--clocked", isClocked, "instead of them <block>_clocked.v");
    app.add_flag("--clk-hz", hasClkHz, "whose module has the parameter CLK_HZ");
    CLI11_PARSE(app, argc, argv);
    try {
        std::ifstream in(input);
        check(bool(in), "cannot be read");
        const json j = json::parse(in);
        Block b = parse(j);
        if (isClocked) {
            save(outputDir + "/" + b.name + "_clocked.v", clocked(b, j, hasClkHz));
            return 0;
        }
        std::string base = outputDir + "/" + b.name + "_regs";
        save(base + ".vh", verilog(b));
        save(base + ".h", cHeader(b));
        save(base + "_pkg.vhd", vhdl(b));
        save(base + ".md", markdown(b));
    } catch (const std::exception& e) {
        std::cerr << input << ": error: " << e.what() << "\n";
        return 1;
    }
    return 0;
}
