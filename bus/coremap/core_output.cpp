// SPDX-License-Identifier: MIT
//
// core_output: the chip's cores as address map, as instances in soc.v, and as the firmware's table.

#include "core_list.h"
#include <algorithm>
#include <fmt/format.h>
#include <set>

using nlohmann::json;
using nlohmann::ordered_json;

namespace {

std::string upper(std::string s) {
    for (char& c : s)
        c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return s;
}

std::string bits(unsigned lsb, unsigned width) {
    return width == 1 ? fmt::format("[{}]", lsb) : fmt::format("[{}:{}]", lsb + width - 1, lsb);
}

uint32_t hashOf(const std::string& text) { // FNV-1a
    uint32_t hash = 0x811C9DC5;
    for (char c : text)
        hash = (hash ^ static_cast<unsigned char>(c)) * 0x01000193;
    return hash;
}

std::string declared(unsigned width, const std::string& name) {
    return fmt::format("wire {}{}", width == 1 ? "" : fmt::format("[{}:0] ", width - 1), name);
}

// Signals of probes by hierarchical names. Yosys joins a wire of such a name with the signal when
// it flattens the chip.
std::string probed(const Chip& chip) {
    const Signal count{"u_system_slot.cycles", 64};
    std::string yosys, names[2], ends;
    std::set<std::string> joined;
    for (const Core& c : chip.cores) {
        if (!c.isProbe)
            continue;
        unsigned bits = 0;
        std::string list;
        auto add = [&](const Signal& signal, unsigned width, const std::string& wire) {
            if (joined.insert(signal.name).second)
                yosys += fmt::format("    (* hierconn *) {} ;\n",
                                     declared(signal.width, "\\" + signal.name));
            std::string part = width < signal.width ? fmt::format("[{}:0]", width - 1) : "";
            names[0] +=
                fmt::format("    {} = \\{} {};\n", declared(width, wire), signal.name, part);
            names[1] += fmt::format("    {} = {}{};\n", declared(width, wire), signal.name, part);
        };
        for (size_t i = 0; i < c.signals.size(); ++i) {
            std::string wire = fmt::format("{}_{}", c.name, i);
            add(c.signals[i], c.signals[i].width, wire);
            list = wire + (list.empty() ? "" : ", ") + list;
            bits += c.signals[i].width;
        }
        add(count, 32, "cycles_" + c.name);
        unsigned width = 64 * changeWords(c) - 33;
        ends += fmt::format("    {} = {{{}{}}};\n", declared(width, "signals_" + c.name),
                            bits < width ? fmt::format("{}'d0, ", width - bits) : "", list);
    }
    if (ends.empty())
        return "";
    return "    // What probes record.\n`ifdef YOSYS\n" + yosys + names[0] + "`else\n" + names[1] +
           "`endif\n" + ends + "\n";
}

// Returns the wire of the output, core.pin, that drives this input.
std::string sourceNet(const Pin& p) {
    std::string net = "pin_" + p.source;
    net[net.find('.')] = '_';
    return net;
}

std::string instance(const Core& c) {
    std::string s = fmt::format("    // {}: ip/{}\n", c.name, c.folder), pins, parameters;
    if (c.hasClock && !c.ownClock)
        parameters = ".CLK_HZ(CLK_HZ)";
    else if (c.hasClock)
        parameters = c.multiply ? fmt::format(".CLK_HZ(CLK_HZ / {} * {})", c.divide, c.multiply)
                                : fmt::format(".CLK_HZ({})", c.ownClock);
    if (c.multiply)
        s += fmt::format("    wire clk_{0};\n    core_clock #(.MULTIPLY({1}), .DIVIDE({2})) "
                         "u_clock_{0} (.clk_i(clk_i), .clk_o(clk_{0}));\n",
                         c.name, c.multiply, c.divide);
    if (c.isProbe) {
        parameters += fmt::format(", .WORDS({}), .NAMES(32'h{:08X})", changeWords(c), namesOf(c));
        pins = fmt::format(",\n        .cycles_i(cycles_{0}), .signals_i(signals_{0})", c.name);
    }
    for (const Pin& p : c.pins) {
        std::string at;
        if (!p.source.empty()) {
            at = sourceNet(p);
        } else if (c.multiply && p.name == "clock_i") {
            at = "clk_" + c.name;
        } else if (!p.isOut() && p.isInternal) {
            at = fmt::format("{}'d0", p.width);
        } else if (!p.isOut()) {
            at = "core_pins_i" + bits(p.lsb, p.width);
        } else {
            at = fmt::format("pin_{}_{}", c.name, p.name);
        }
        pins += fmt::format(",\n        .{}({})", p.name, at);
    }
    if (c.saysIdle) {
        s += fmt::format("    wire clk_{0}, idle_{0};\n"
                         "    core_gate #(.GATED({2})) u_gate_{0} (.clk_i(clk_i), .rst_i(rst), "
                         ".access_i(slot_valid[{1}]), .idle_i(idle_{0}), .clk_o(clk_{0}));\n",
                         c.name, c.slot, c.hasGate ? "1" : "GATES");
        pins = fmt::format(", .idle_o(idle_{})", c.name) + pins;
    }
    s += fmt::format("    {0}{5} {3}u_{1} (\n        .clk_i({4}), .rst_i(rst), `SLOT({2}), "
                     ".irq_o(slot_irq[{2}])",
                     c.folder, c.name, c.slot, parameters.empty() ? "" : "#(" + parameters + ") ",
                     c.saysIdle ? "clk_" + c.name : "clk_i", c.ownClock ? "_clocked" : "");
    if (c.port >= 0)
        s += fmt::format(", `NPI({})", c.port);
    return s + pins + "\n    );\n";
}

} // namespace

ordered_json mapOf(const Chip& chip, const ordered_json& base) {
    ordered_json map = base;
    auto& constants = map["constants"];
    auto set = [&](const std::string& name, unsigned value) {
        for (auto& c : constants)
            if (c["name"] == name)
                c["value"] = value;
    };
    auto add = [&](const std::string& name, unsigned value, const std::string& doc) {
        constants.push_back({{"name", name}, {"value", value}, {"doc", doc}});
    };
    for (const auto& c : base["constants"])
        if (c["name"] == "SLOT_COUNT")
            add("CONTRACTS", c["value"].get<unsigned>() + static_cast<unsigned>(chip.cores.size()),
                "slots that are not empty: the platform's and the cores'");
    set("SLOT_COUNT", chip.slots);
    set("NPI_PORT_COUNT", chip.ports);
    add("CORES", std::max<unsigned>(1, static_cast<unsigned>(chip.cores.size())),
        "cores, 1 where there are none: for tables");
    for (const Core& c : chip.cores) {
        add("SLOT_" + upper(c.name), c.slot, "slot of the core " + c.name);
        if (c.port >= 0)
            add("NPI_PORT_" + upper(c.name), static_cast<unsigned>(c.port),
                "memory port of the core " + c.name);
        add("MEMORY_" + upper(c.name), c.memory,
            fmt::format("DDR3 byte address of the buffers of the core {}: {} bytes", c.name,
                        c.memoryBytes));
        for (const Pin& p : c.pins)
            if (p.isPin())
                add("PIN_" + upper(c.name + "_" + p.name), p.lsb,
                    fmt::format("bit of core_pins_{}, {} wide", p.isOut() ? 'o' : 'i', p.width));
    }
    return map;
}

uint32_t contractOf(const json& description) {
    std::vector<std::string> lines = {description.at("type").dump()};
    for (const json& r : description.at("registers")) {
        auto name = r.at("name").get<std::string>();
        lines.push_back(fmt::format("{} {} {} {} {}", r.at("word").get<unsigned>(),
                                    r.value("page", -1), name, r.at("access").get<std::string>(),
                                    r.value("width", 32u)));
        for (const json& f : r.value("fields", json::array()))
            lines.push_back(fmt::format("{}.{} {} {}", name, f.at("name").get<std::string>(),
                                        f.at("lsb").get<unsigned>(),
                                        f.at("width").get<unsigned>()));
    }
    for (const json& e : description.value("events", json::array()))
        lines.push_back(
            fmt::format("{} {}", e.at("name").get<std::string>(), e.at("bit").get<unsigned>()));
    std::sort(lines.begin(), lines.end()); // the order in the file does not matter
    std::string all;
    for (const std::string& line : lines)
        all += line + "\n";
    return hashOf(all);
}

unsigned changeWords(const Core& probe) {
    unsigned bits = 0;
    for (const Signal& signal : probe.signals)
        bits += signal.width;
    return bits <= 31 ? 1 : bits <= 95 ? 2 : 4;
}

uint32_t namesOf(const Core& probe) {
    std::string all;
    for (const Signal& signal : probe.signals)
        all += fmt::format("{}:{}\n", signal.name, signal.width);
    return hashOf(all);
}

ordered_json probesOf(const Chip& chip) {
    ordered_json all = ordered_json::object();
    for (const Core& c : chip.cores)
        if (c.isProbe) {
            ordered_json& probe = all[c.name];
            probe["identity"] = c.identity;
            probe["names"] = namesOf(c);
            for (const Signal& signal : c.signals)
                probe["signals"].push_back({signal.name, signal.width});
        }
    return all;
}

std::string verilogOf(const Chip& chip, const std::vector<Slot>& slots) {
    std::string s =
        "// Generated from ip/cores.list: do not edit. Cores in their slots, for soc.v.\n\n";
    std::vector<uint32_t> contracts(chip.slots);
    for (const Slot& slot : slots)
        contracts.at(slot.number) = contractOf(slot.description);
    std::string list;
    for (uint32_t contract : contracts)
        list = fmt::format("32'h{:08X}{}{}", contract, list.empty() ? "" : ", ", list);
    s += fmt::format("    localparam [32*{}-1:0] CONTRACTS = {{{}}};\n\n", chip.slots, list);
    for (const Core& c : chip.cores)
        for (const Pin& p : c.pins)
            if (p.isOut())
                s += fmt::format("    {};\n", declared(p.width, "pin_" + c.name + "_" + p.name));
    s += probed(chip);
    for (const Core& c : chip.cores)
        s += instance(c) + "\n";
    std::set<unsigned> used;
    for (const Core& c : chip.cores)
        used.insert(c.slot);
    for (unsigned slot = 2; slot < chip.slots; ++slot)
        if (!used.count(slot))
            s += fmt::format("    // slot {0} is empty\n"
                             "    assign slot_ready[{0}] = slot_valid[{0}];\n"
                             "    assign slot_rdata[32*{0} +: 32] = 32'd0;\n"
                             "    assign slot_error[{0}] = 1'b1;\n"
                             "    assign slot_irq[{0}]   = 1'b0;\n\n",
                             slot);
    std::string unused;
    for (const Core& c : chip.cores)
        for (const Pin& p : c.pins)
            if (p.isOut() && p.isInternal)
                unused += fmt::format(", pin_{}_{}", c.name, p.name);
            else if (p.isOut())
                s += fmt::format("    assign core_pins_o{} = pin_{}_{};\n", bits(p.lsb, p.width),
                                 c.name, p.name);
    if (chip.pins[1] < 32)
        s += fmt::format("    assign core_pins_o{} = {}'d0;\n",
                         bits(chip.pins[1], 32 - chip.pins[1]), 32 - chip.pins[1]);
    return s + "    wire unused_pins = &{1'b0, core_pins_i, GATES != 0" + unused + ", 1'b0};\n";
}

std::string pinTableOf(const Chip& chip) {
    std::string s =
        "// Generated from ip/cores.list: do not edit. Pins of cores, by name.\n"
        "struct CorePin {\n    const char* name; // instance.port\n    unsigned lsb, width; // in "
        "core_pins_i or core_pins_o\n    bool isOut;\n};\n"
        "constexpr CorePin corePins[] = {\n";
    for (const Core& c : chip.cores)
        for (const Pin& p : c.pins)
            if (p.isPin())
                s += fmt::format("    {{\"{}.{}\", {}, {}, {}}},\n", c.name, p.name, p.lsb, p.width,
                                 p.isOut());
    return s + "    {nullptr, 0, 0, false}};\n";
}

// The core's own constraints: @name@ is the instance, @port@ its pads, those of a bus as a list.
static std::string ownConstraints(const Core& c) {
    std::string s = c.constraints;
    auto replace = [&s](const std::string& what, const std::string& with) {
        for (size_t at = s.find(what); at != std::string::npos; at = s.find(what, at))
            s.replace(at, what.size(), with);
    };
    replace("@name@", c.name);
    for (const Pin& p : c.pins) {
        std::string pads;
        for (unsigned bit = 0; p.isPin() && bit < p.width; ++bit)
            pads += fmt::format("{}core_pins_{}<{}>", bit ? "\" : \"" : "", p.isOut() ? 'o' : 'i',
                                p.lsb + bit);
        replace("@" + p.name + "@", pads);
    }
    return s;
}

// A clock of the core's own: its period. Between it and the chip's a path has 8 ns, so two bits, or
// a word and its flag, arrive at most a clock of 10 ns apart.
static std::string clockConstraints(const Core& c) {
    if (!c.ownClock)
        return "";
    const Pin& p = c.pins.back();
    std::string net = p.isPin()    ? fmt::format("core_pins_i<{}>", p.lsb)
                      : c.multiply ? "u_soc/clk_" + c.name
                                   : "u_soc/" + sourceNet(p);
    return fmt::format("NET \"{0}\" TNM_NET = \"{1}_clk\";\n"
                       "TIMESPEC \"TS_{1}_clk\" = PERIOD \"{1}_clk\" {2:.3f} ns HIGH 50%;\n"
                       "TIMESPEC \"TS_{1}_to_soc\" = FROM \"{1}_clk\" TO \"soc_clk\" 8 ns "
                       "DATAPATHONLY;\n"
                       "TIMESPEC \"TS_soc_to_{1}\" = FROM \"soc_clk\" TO \"{1}_clk\" 8 ns "
                       "DATAPATHONLY;\n",
                       net, c.name, 1e9 / c.clockHz());
}

std::string constraintsOf(const Chip& chip) {
    std::string s = "# Generated from ip/cores.list: do not edit. Pins of cores, for ngdbuild "
                    "(docs/utilisation.md).\n";
    for (const Core& c : chip.cores)
        for (const Pin& p : c.pins)
            for (unsigned bit = 0; p.isPin() && bit < p.width; ++bit)
                s += fmt::format("{}NET \"core_pins_{}<{}>\" LOC = \"{}\"; # {}.{}[{}]\n",
                                 p.places.empty() ? "# " : "", p.isOut() ? 'o' : 'i', p.lsb + bit,
                                 p.places.empty() ? "..." : p.places[bit], c.name, p.name, bit);
    for (const Core& c : chip.cores)
        s += ownConstraints(c) + clockConstraints(c);
    for (const Core& c : chip.cores)
        if (c.hasGate)
            s += fmt::format(
                "NET \"u_soc/u_gate_{}.g_gate.run\" MAXDELAY = 4 ns; # to its BUFGCE\n", c.name);
    return s;
}

// The C of one core's servant: its own, or the one for a core without its own.
static std::string servantOf(const Core& c) {
    std::string table, init = c.servantType, arguments = "MAP_MEMORY_" + upper(c.name);
    if (c.isGeneric()) {
        std::string block = upper(c.folder);
        table = fmt::format("static const Hw_Register core_{}_table[] = {{{}_TABLE}};\n", c.name,
                            block);
        init = "Hw_Registers_Core";
        arguments = fmt::format("{0}_ID_VALUE, core_{1}_table,\n        "
                                "(Ice_Int)(sizeof core_{1}_table / sizeof core_{1}_table[0])",
                                block, c.name);
    }
    return fmt::format("\n{4}static {0} {1};\n"
                       "static Hw_Status {1}_start(const Hw_Port *port, void *context) {{\n"
                       "    return {0}_init(&{1}, MAP_SLOT_{2}, {3}, port, context);\n}}\n"
                       "static void {1}_interrupt(void) {{\n    {0}_interrupt(&{1});\n}}\n"
                       "static U32 {1}_poll(U32 nowMs) {{\n    return {0}_poll(&{1}, nowMs);\n}}\n",
                       init, "core_" + c.name, upper(c.name), arguments, table);
}

std::string instancesOf(const Chip& chip, const std::vector<Slot>& slots) {
    std::string s = "/* Generated from ip/cores.list: do not edit.\n"
                    " * The firmware's cores: what hw_instance.h declares. */\n"
                    "#include \"hw_instance.h\"\n#include \"map_regs.h\"\n",
                servants, table;
    std::set<std::string> headers;
    for (const Core& c : chip.cores) {
        headers.insert(c.isGeneric() ? c.folder + "_regs.h" : c.servantHeader);
        if (c.isGeneric())
            headers.insert("hw_registers.h");
        servants += servantOf(c);
        table += fmt::format("    {{\"{0}\", MAP_SLOT_{1}, (Ice_ObjectPtr)&{2}.servant, {2}_start, "
                             "{2}_interrupt, {2}_poll}},\n",
                             c.identity, upper(c.name), "core_" + c.name);
    }
    for (const std::string& h : headers)
        s += fmt::format("#include \"{}\"\n", h);
    s += servants + "\nconst Hw_Instance hw_instances[] = {\n" + table +
         "    {0, 0, 0, 0, 0, 0}};\n\nconst Hw_Contract hw_contracts[MAP_CONTRACTS] = {";
    for (size_t i = 0; i < slots.size(); ++i)
        s += fmt::format("{}\n    {{{{{}, \"{}\"}}, {}, 0, (Ice_Int)0x{:08X}U}}", i ? "," : "",
                         slots[i].name.size(), slots[i].name, slots[i].number,
                         contractOf(slots[i].description));
    return s + "};\n";
}
