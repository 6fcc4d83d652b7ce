// SPDX-License-Identifier: MIT
//
// flight_file: holds words and files to the schema.

#include "flight_file.h"
#include "files.h"
#include <algorithm>
#include <fmt/format.h>
#include <regex>
#include <stdexcept>

using nlohmann::json;

namespace {

json fields() {
    return json::parse(readFile(FLIGHT_SCHEMA)).at("properties");
}

// The value of a word, by its field's type; the text itself where it is none.
json valueOf(const json& field, const std::string& text) {
    const std::string type = field.value("type", "string");
    if (type == "integer" || type == "number") {
        json value = json::parse(text, nullptr, false);
        if (value.is_number())
            return value;
    }
    return text;
}

bool fits(const json& field, const json& value) {
    const std::string type = field.value("type", "string");
    if (type == "integer" || type == "number") {
        if (type == "integer" ? !value.is_number_integer() : !value.is_number())
            return false;
        return value >= field.value("minimum", value) && value <= field.value("maximum", value);
    }
    if (field.contains("enum"))
        return std::count(field["enum"].begin(), field["enum"].end(), value) > 0;
    if (type != "string")
        return type == "boolean" ? value.is_boolean() : value.is_array();
    return value.is_string() && (!field.contains("pattern") ||
                                 std::regex_match(value.get<std::string>(),
                                                  std::regex(field["pattern"].get<std::string>())));
}

} // namespace

json flightOf(const std::vector<std::string>& words) {
    const json known = fields();
    json flight = json::object();
    const auto end = std::find(words.begin(), words.end(), "--");
    for (auto word = words.begin(); word != end; ++word) {
        std::string name = word->compare(0, 2, "--") == 0 ? word->substr(2) : "";
        std::replace(name.begin(), name.end(), '-', '_');
        if (name != "flight" && !known.contains(name))
            throw std::invalid_argument("there is no option '" + *word + "'; see --help");
        if (name != "flight" && known[name].value("type", "") == "boolean")
            flight[name] = true;
        else if (word + 1 == end)
            throw std::invalid_argument(*word + " needs a value");
        else if (name == "flight")
            flight.update(json::parse(readFile(*++word)));
        else
            flight[name] = valueOf(known[name], *(word + 1)), ++word;
    }
    flight.erase("version");
    for (const auto& [name, value] : flight.items())
        if (!known.contains(name) || !fits(known[name], value))
            throw std::invalid_argument(
                fmt::format("{} = {}: {}", name, value.dump(),
                            known.contains(name) ? known[name].dump() : "no such field"));
    return flight;
}

std::string flightHelp() {
    std::string text =
        "Simulates the UAV: RTL, DDR3, firmware, modems, radio. The ground's modem is a pty.\n"
        "Usage: icesoc-sim [--flight flight.json] [--name value...] [-- COMMAND]\n"
        "Words of COMMAND: {device} the pty, {frame} the camera's picture, {status} "
        "counters, {guard}, {out}.\n";
    const json known = fields();
    for (const auto& [name, field] : known.items())
        if (name != "version")
            text += fmt::format("  --{:<14} {}\n", std::regex_replace(name, std::regex("_"), "-"),
                                field.value("description", ""));
    return text;
}
