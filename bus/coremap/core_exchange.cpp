// SPDX-License-Identifier: MIT
//
// core_exchange: the chip's registers for other tools: CMSIS-SVD 1.3, SystemRDL 2.0 and IP-XACT
// (IEEE 1685-2014).

#include "core_list.h"
#include <algorithm>
#include <fmt/format.h>

using nlohmann::json;

std::string escaped(const std::string& text) {
    std::string s;
    for (char c : text)
        switch (c) {
        case '<':
            s += "&lt;";
            break;
        case '>':
            s += "&gt;";
            break;
        case '&':
            s += "&amp;";
            break;
        case '"':
            s += "&quot;";
            break;
        default:
            s += c;
        }
    return s;
}

// The three words every slot begins with, then the block's own.
json registersOf(const json& block) {
    json events = json::array();
    for (const json& e : block.value("events", json::array()))
        events.push_back(
            {{"name", e.at("name")}, {"lsb", e.at("bit")}, {"width", 1}, {"doc", e.at("doc")}});
    json list = json::array();
    list.push_back({{"word", 0},
                    {"name", "ID"},
                    {"access", "ro"},
                    {"doc", "type and version of the slot"},
                    {"fields",
                     {{{"name", "TYPE"},
                       {"lsb", 16},
                       {"width", 16},
                       {"doc", "type id"},
                       {"reset", block.at("type")}},
                      {{"name", "VERSION"},
                       {"lsb", 0},
                       {"width", 16},
                       {"doc", "major and minor, 8 bits each"},
                       {"reset", block.at("version")}}}}});
    list.push_back({{"word", 1},
                    {"name", "EVENT"},
                    {"access", "w1c"},
                    {"doc", "sticky events"},
                    {"fields", events}});
    list.push_back({{"word", 2},
                    {"name", "MASK"},
                    {"access", "rw"},
                    {"doc", "1: drives the interrupt line"},
                    {"fields", events}});
    for (const json& r : block.at("registers"))
        list.push_back(r);
    return list;
}

namespace {

std::string upper(std::string s) {
    for (char& c : s)
        c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return s;
}

std::string svdAccess(const std::string& access) {
    return access == "ro" ? "read-only" : access == "ws" ? "write-only" : "read-write";
}

std::string svdRegister(const json& r) {
    std::string access = r.at("access"), s, group;
    if (int page = r.value("page", -1); page >= 0)
        group = fmt::format("          <alternateGroup>PAGE_0x{:X}</alternateGroup>\n", page);
    s += fmt::format(
        "        <register>\n          <name>{}</name>\n          <description>{}</description>\n"
        "{}          <addressOffset>0x{:X}</addressOffset>\n          <access>{}</access>\n",
        r.at("name").get<std::string>(), escaped(r.at("doc")), group,
        4 * r.at("word").get<unsigned>(), svdAccess(access));
    if (access == "w1c")
        s += "          <modifiedWriteValues>oneToClear</modifiedWriteValues>\n";
    json fields = r.value("fields", json::array());
    if (!fields.empty())
        s += "          <fields>\n";
    for (const json& f : fields)
        s += fmt::format("            <field>\n              <name>{}</name>\n              "
                         "<description>{}</description>\n"
                         "              <bitOffset>{}</bitOffset>\n              "
                         "<bitWidth>{}</bitWidth>\n            </field>\n",
                         f.at("name").get<std::string>(), escaped(f.at("doc")),
                         f.at("lsb").get<unsigned>(), f.at("width").get<unsigned>());
    if (!fields.empty())
        s += "          </fields>\n";
    return s + "        </register>\n";
}

// A register's fields; one without has the field WORD. "reset" is the number as
// text.
json fieldsOf(const json& r) {
    json fields = r.value("fields", json::array());
    if (fields.empty())
        fields.push_back(
            {{"name", "WORD"}, {"lsb", 0}, {"width", r.value("width", 32u)}, {"doc", r.at("doc")}});
    return fields;
}

// Words behind an adapter share their addresses in the slot, so they have an address map of their
// own, <SLOT>_PAGES: by their byte addresses in the core.
bool isPaged(const json& r) {
    return r.value("page", -1) >= 0;
}
bool hasPages(const Slot& slot) {
    const json registers = registersOf(slot.description);
    return std::any_of(registers.begin(), registers.end(), isPaged);
}
unsigned addressOf(const json& r) {
    const unsigned word = r.at("word");
    return isPaged(r) ? r.at("page").get<unsigned>() + 4 * (word - 8) : 4 * word;
}

std::string quoted(const std::string& text) {
    std::string s;
    for (char c : text)
        s += c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
    return '"' + s + '"';
}

std::string rdlRegister(const json& r) {
    std::string access = r.at("access");
    std::string how = access == "ro"    ? "sw=r; hw=w;"
                      : access == "ws"  ? "sw=w; hw=r;"
                      : access == "w1c" ? "sw=rw; hw=w; onwrite=woclr;"
                                        : "sw=rw; hw=r;";
    std::string s = fmt::format("        reg {{\n            desc = {};\n", quoted(r.at("doc")));
    for (const json& f : fieldsOf(r)) {
        unsigned lsb = f.at("lsb"), width = f.at("width");
        std::string reset = f.value("reset", std::string());
        s += fmt::format("            field {{ {} desc = {}; }} {}[{}:{}]{};\n", how,
                         quoted(f.at("doc")), f.at("name").get<std::string>(), lsb + width - 1, lsb,
                         reset.empty() ? "" : " = " + reset);
    }
    return s +
           fmt::format("        }} {} @ 0x{:X};\n", r.at("name").get<std::string>(), addressOf(r));
}

std::string ipxact(const std::string& tag, const std::string& text) {
    return fmt::format("<ipxact:{0}>{1}</ipxact:{0}>", tag, text);
}

std::string ipxactRegister(const json& r) {
    std::string access = r.at("access");
    std::string s = "        <ipxact:register>" + ipxact("name", r.at("name")) +
                    ipxact("description", escaped(r.at("doc"))) +
                    ipxact("addressOffset", fmt::format("'h{:x}", addressOf(r))) +
                    ipxact("size", "32") + "\n";
    for (const json& f : fieldsOf(r)) {
        std::string reset = f.value("reset", std::string());
        s += "          <ipxact:field>" + ipxact("name", f.at("name")) +
             ipxact("description", escaped(f.at("doc"))) +
             ipxact("bitOffset", std::to_string(f.at("lsb").get<unsigned>())) +
             (reset.empty()
                  ? ""
                  : ipxact("resets", ipxact("reset", ipxact("value", "'h" + reset.substr(2))))) +
             ipxact("bitWidth", std::to_string(f.at("width").get<unsigned>())) +
             ipxact("access", svdAccess(access)) +
             (access == "w1c" ? ipxact("modifiedWriteValue", "oneToClear") : "") +
             "</ipxact:field>\n";
    }
    return s + "        </ipxact:register>\n";
}

} // namespace

std::string svdOf(const std::vector<Slot>& slots) {
    std::string s =
        "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"
        "<device schemaVersion=\"1.3\" xmlns:xs=\"http://www.w3.org/2001/XMLSchema-instance\" "
        "xs:noNamespaceSchemaLocation=\"CMSIS-SVD.xsd\">\n"
        "  <name>IceSoC</name>\n  <version>1.0</version>\n"
        "  <description>Registers of the FPGA in the FSMC window NE2. Generated from "
        "ip/cores.list: do not "
        "edit.</description>\n"
        "  <addressUnitBits>8</addressUnitBits>\n  <width>32</width>\n  <size>32</size>\n"
        "  <resetValue>0</resetValue>\n  <resetMask>0xFFFFFFFF</resetMask>\n  <peripherals>\n";
    for (const Slot& slot : slots) {
        s += fmt::format(
            "    <peripheral>\n      <name>{}</name>\n      <description>{}</description>\n"
            "      <baseAddress>0x{:08X}</baseAddress>\n      <addressBlock>\n        "
            "<offset>0</offset>\n"
            "        <size>0x{:X}</size>\n        <usage>registers</usage>\n      </addressBlock>\n"
            "      <registers>\n",
            upper(slot.name), escaped(slot.description.at("doc")), slot.address, slotBytes);
        for (const json& r : registersOf(slot.description))
            s += svdRegister(r);
        s += "      </registers>\n    </peripheral>\n";
    }
    return s + "  </peripherals>\n</device>\n";
}

std::string rdlOf(const std::vector<Slot>& slots) {
    std::string s =
        "// Registers of the FPGA in the FSMC window NE2 (SystemRDL 2.0). Generated from "
        "ip/cores.list: do not edit.\n"
        "property memory_bytes { type = longint unsigned; component = addrmap; };\n";
    const std::string words = "    default regwidth = 32;\n    default accesswidth = 32;\n";
    for (const Slot& slot : slots)
        if (hasPages(slot)) {
            s +=
                fmt::format("addrmap {}_PAGES {{\n    desc = \"By byte address in the core.\";\n{}",
                            upper(slot.name), words);
            for (const json& r : registersOf(slot.description))
                if (isPaged(r))
                    s += rdlRegister(r);
            s += "};\n";
        }
    s += "addrmap icesoc {\n" + words;
    for (const Slot& slot : slots) {
        s +=
            fmt::format("    addrmap {{\n        desc = {};\n", quoted(slot.description.at("doc")));
        if (unsigned bytes = slot.description.value("memory_bytes", 0u))
            s += fmt::format("        memory_bytes = {};\n", bytes);
        for (const json& r : registersOf(slot.description))
            if (!isPaged(r))
                s += rdlRegister(r);
        s += fmt::format("    }} {} @ 0x{:X};\n", upper(slot.name), slot.address);
    }
    return s + "};\n";
}

std::string ipxactOf(const std::vector<Slot>& slots) {
    std::string s = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
                    "<!-- Registers of the FPGA in the FSMC window NE2. Generated from "
                    "ip/cores.list: do not edit. -->\n"
                    "<ipxact:component "
                    "xmlns:ipxact=\"http://www.accellera.org/XMLSchema/IPXACT/1685-2014\">\n  " +
                    ipxact("vendor", "icesoc") + ipxact("library", "icesoc") +
                    ipxact("name", "icesoc") + ipxact("version", "1.0") +
                    "\n  <ipxact:memoryMaps>\n    <ipxact:memoryMap>" +
                    ipxact("name", "registers") + "\n";
    auto block = [](const Slot& slot, const std::string& name, unsigned address, bool paged) {
        std::string registers;
        unsigned range = slotBytes;
        for (const json& r : registersOf(slot.description))
            if (isPaged(r) == paged) {
                registers += ipxactRegister(r);
                range = std::max(range, addressOf(r) + 4);
            }
        return "      <ipxact:addressBlock>" + ipxact("name", name) +
               ipxact("description", escaped(slot.description.at("doc"))) +
               ipxact("baseAddress", fmt::format("'h{:x}", address)) +
               ipxact("range", std::to_string(range)) + ipxact("width", "32") + "\n" + registers +
               "      </ipxact:addressBlock>\n";
    };
    std::string pages;
    for (const Slot& slot : slots) {
        const std::string name = upper(slot.name);
        s += block(slot, name, slot.address, false);
        if (hasPages(slot))
            pages += "    <ipxact:memoryMap>" + ipxact("name", name + "_PAGES") + "\n" +
                     block(slot, name, 0, true) + "      " + ipxact("addressUnitBits", "8") +
                     "</ipxact:memoryMap>\n";
    }
    return s + "      " + ipxact("addressUnitBits", "8") + "</ipxact:memoryMap>\n" + pages +
           "  </ipxact:memoryMaps>\n</ipxact:component>\n";
}
