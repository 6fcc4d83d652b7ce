// SPDX-License-Identifier: MIT
//
// core_pages: the chip's registers for debuggers (CMSIS-SVD 1.3) and for people (HTML).

#include "core_list.h"
#include <fmt/format.h>

using nlohmann::json;

namespace {

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

std::string upper(std::string s) {
    for (char& c : s)
        c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
    return s;
}

// The three words every slot begins with, then the block's own.
json registersOf(const json& block) {
    json events = json::array();
    for (const json& e : block.value("events", json::array()))
        events.push_back(
            {{"name", e.at("name")}, {"lsb", e.at("bit")}, {"width", 1}, {"doc", e.at("doc")}});
    json list = json::array();
    list.push_back(
        {{"word", 0}, {"name", "ID"}, {"access", "ro"}, {"doc", "type and version of the slot"}});
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

std::string htmlBlock(const Slot& slot) {
    std::string s =
        fmt::format("<h2 id=\"{0}\">{0}</h2>\n<p>{1} Slot {2}, 0x{3:08X}.</p>\n"
                    "<table>\n<tr><th>word<th>register<th>access<th>bits<th>meaning\n",
                    slot.name, escaped(slot.description.at("doc")), slot.number, slot.address);
    for (const json& r : registersOf(slot.description)) {
        int page = r.value("page", -1);
        s += fmt::format(
            "<tr><td>{}{}<td><b>{}</b><td>{}<td><td>{}\n", r.at("word").get<unsigned>(),
            page < 0 ? "" : fmt::format(", PAGE 0x{:X}", page), r.at("name").get<std::string>(),
            r.at("access").get<std::string>(), escaped(r.at("doc")));
        for (const json& f : r.value("fields", json::array())) {
            unsigned lsb = f.at("lsb"), width = f.at("width");
            s += fmt::format("<tr><td><td>{}<td><td>{}<td>{}\n", f.at("name").get<std::string>(),
                             width == 1 ? std::to_string(lsb)
                                        : fmt::format("{}..{}", lsb + width - 1, lsb),
                             escaped(f.at("doc")));
        }
    }
    return s + "</table>\n";
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

std::string htmlOf(const std::vector<Slot>& slots) {
    std::string s =
        "<!DOCTYPE html>\n<meta charset=\"utf-8\">\n<title>IceSoC: registers</title>\n"
        "<style>body { font: 15px sans-serif; max-width: 60em; margin: 2em auto } table { "
        "border-collapse: collapse }\n"
        "th, td { text-align: left; padding: 2px 10px; border-bottom: 1px solid #ddd }</style>\n"
        "<h1>Registers</h1>\n<p>Generated from ip/cores.list. Access: ro read only; rw read and "
        "write; w1c write 1 "
        "to clear; ws a write acts, reads as 0.</p>\n<p>";
    for (const Slot& slot : slots)
        s += fmt::format("<a href=\"#{0}\">{0}</a> ", slot.name);
    s += "</p>\n";
    for (const Slot& slot : slots)
        s += htmlBlock(slot);
    return s;
}
