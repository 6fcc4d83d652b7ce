// SPDX-License-Identifier: MIT
//
// core_pages: the chip's registers for people (HTML).

#include "core_list.h"
#include <fmt/format.h>

using nlohmann::json;

namespace {

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
