// SPDX-License-Identifier: MIT
//
// icesoc-sim: reads the options of a simulated flight from a file (flight.json) and from arguments
// "--name value". A schema defines the names, types and limits of the options; ./icesoc generates
// the schema from its own options.

#include "files.h"
#include "flight.h"
#include <algorithm>
#include <fmt/format.h>
#include <iostream>
#include <map>
#include <regex>

using nlohmann::json;

namespace {

// Contents of tools/icesoc/cli/flight.schema.json, built in so that the program needs no file.
constexpr char schemaText[] =
#include "flight_schema.inc"
    ;

json fields() {
    return json::parse(schemaText).at("properties");
}

// Converts an argument to the type of the field; returns it as text if that is not possible.
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

// Returns a description of the values that a field accepts, for messages.
std::string expectedOf(const std::string& name, const json& field) {
    static const std::map<std::string, std::string> patterns = {
        {"modem_key", "32 hexadecimal digits"},
        {"speed", "real, max, viewed, or a factor such as 0.25"},
        {"trouble", "KIND:ADDRESS:START:DURATION, such as away:2:1.5:3"}};
    if (patterns.count(name))
        return patterns.at(name);
    if (field.contains("enum"))
        return fmt::format("{}", fmt::join(field["enum"].get<std::vector<std::string>>(), " or "));
    const std::string type = field.value("type", "string");
    if (field.contains("maximum"))
        return field.value("minimum", json(0)).dump() + " to " + field["maximum"].dump();
    if (field.contains("minimum"))
        return "at least " + field["minimum"].dump();
    return type == "boolean" ? "true or false" : type == "array" ? "a list" : "a text";
}

std::string optionOf(const std::string& name) {
    return "--" + std::regex_replace(name, std::regex("_"), "-");
}

// Reads the arguments up to "--". "--flight FILE" takes all fields from a file; later arguments
// override single fields. Throws std::invalid_argument, with the name of the argument, if an
// argument is wrong.
json flightOf(const std::vector<std::string>& words) {
    const json known = fields();
    json flight = json::object();
    const auto end = std::find(words.begin(), words.end(), "--");
    for (auto word = words.begin(); word != end; ++word) {
        std::string name = word->compare(0, 2, "--") == 0 ? word->substr(2) : "";
        std::replace(name.begin(), name.end(), '-', '_');
        if (name != "flight" && !known.contains(name))
            throw std::invalid_argument("unknown option '" + *word + "'; see --help");
        if (name != "flight" && known[name].value("type", "") == "boolean")
            flight[name] = true;
        else if (word + 1 == end)
            throw std::invalid_argument(*word + " needs a value");
        else if (name == "flight") {
            const json described = json::parse(readFile(*++word), nullptr, false);
            if (!described.is_object())
                throw std::invalid_argument(
                    "'" + *word +
                    "': expected a flight, which is a JSON object (./icesoc run writes it)");
            flight.update(described);
        } else if (known[name].value("type", "") == "array")
            flight[name].push_back(*++word);
        else
            flight[name] = valueOf(known[name], *(word + 1)), ++word;
    }
    flight.erase("version");
    for (const auto& [name, value] : flight.items())
        if (!known.contains(name))
            throw std::invalid_argument("unknown field '" + name + "'; see --help");
        else if (!fits(known[name], value))
            throw std::invalid_argument(fmt::format(
                "{}: expected {}, got {}", optionOf(name), expectedOf(name, known[name]),
                value.is_string() ? "'" + value.get<std::string>() + "'" : value.dump()));
    return flight;
}

// Returns the help text, which lists all fields.
std::string flightHelp() {
    std::string text =
        "Usage: icesoc-sim --image PICTURE [--flight flight.json] [--name value]... [-- COMMAND]\n"
        "\n"
        "Simulates the UAV: RTL, DDR3, firmware, modems and radio. The modem of the ground "
        "station\n"
        "is a pseudo-terminal. COMMAND is the ground program; the flight ends when it ends. In "
        "its\n"
        "arguments, {device} is replaced by the pseudo-terminal, {frame} by the picture of the\n"
        "camera, {status} by the file of counters, {guard} by the guard time and {out} by the "
        "output\n"
        "folder.\n"
        "\n"
        "Options:\n";
    const json known = fields();
    for (const auto& [name, field] : known.items()) {
        if (name == "version")
            continue;
        text += fmt::format("  {:<16} {}", optionOf(name), field.value("description", ""));
        const bool isText =
            !field.contains("enum") && !field.contains("maximum") && !field.contains("minimum");
        const json value = field.value("default", json());
        const bool hasDefault =
            !value.is_null() && value != "" && value != false && !value.is_array();
        const std::string range = isText ? "" : expectedOf(name, field);
        const std::string preset =
            !hasDefault
                ? ""
                : "default " + (value.is_string() ? value.get<std::string>() : value.dump());
        if (!(range + preset).empty())
            text += " (" + range + (range.empty() || preset.empty() ? "" : "; ") + preset + ")";
        text += "\n";
    }
    return text +
           "\n"
           "examples:\n"
           "  icesoc-sim --image photo.png --duration 2 --open\n"
           "  icesoc-sim --image photo.png --loss 0.05 --key uav1.key -- ./ground.py {device}\n"
           "  icesoc-sim --flight build/run/flight.json --seed 7 -- ./ground.py {device}\n";
}

void writeWave(const Flight::Options& o) {
    const std::string wave = o.flight.value("wave", "");
    if (wave.empty())
        return;
#ifdef ICESOC_TRACE
    auto clocks = [](double seconds) {
        return std::to_string(
            static_cast<uint64_t>(seconds * static_cast<double>(SocModel::clkHz)));
    };
    setenv("WAVE", wave.c_str(), 1); // observer.h
    setenv("WAVE_FROM", clocks(o.from).c_str(), 1);
    setenv("WAVE_TO", clocks(o.to).c_str(), 1);
#else
    throw std::runtime_error(
        "this simulator cannot write waveforms: use the one in build/trace (make run REPLAY=" +
        o.flight.value("replay", "") + " FROM=1.5 TO=1.6)");
#endif
}

// Combines the options of the recorded flight with the options that control this replay.
Flight::Options recorded(const Flight::Options& now, const std::string& folder) {
    auto replayed = std::make_shared<ReplayedLine>(folder + "/flight.jsonl");
    const json& head = replayed->head();
    if (head.at("clkHz") != SocModel::clkHz)
        throw std::runtime_error(
            "this simulator has another clock than the recorded flight, which has " +
            head.at("clkHz").dump() + " Hz: make run REPLAY=" + folder +
            " CLK_HZ=" + head.at("clkHz").dump());
    if (const std::string bridge = head.value("bridge", SOC_BRIDGE); bridge != SOC_BRIDGE)
        throw std::runtime_error("this simulator has the bridge '" SOC_BRIDGE "', and the recorded "
                                 "flight has '" +
                                 bridge + "': make run REPLAY=" + folder +
                                 " selects the simulator");
    json fields = head.at("flight"), view = now;
    for (const char* ofThisView : {"out", "gdb", "every_clock", "quiet", "from", "to"})
        fields[ofThisView] = view[ofThisView];
    Flight::Options o = fields;
    for (const auto& [file, hash] : head.value("hashes", std::map<std::string, std::string>()))
        if (hexHash(readFile(file)) != hash)
            throw std::runtime_error("'" + file + "' has changed since the flight was recorded");
    if (std::filesystem::weakly_canonical(now.out) == std::filesystem::weakly_canonical(folder))
        throw std::runtime_error("--out: expected a folder other than the recording's, got '" +
                                 folder + "'");
    o.flight = now.flight;
    o.image = folder + "/before.png";
    o.replayed = replayed;
    o.speed = now.flight.value("speed", "max");
    return o;
}

// Checks the flight's board and its faults. Uses the board's kind of modem, unless the flight
// chooses a kind. Throws std::invalid_argument if the board or a fault is wrong.
void completeBoard(Flight::Options& o) {
    try {
        for (const std::string& fault : o.fault)
            (void)WireFault::parse(fault);
        if (o.board.empty())
            return;
        const BoardWires wires = BoardWires::fromFolder(o.board);
        if (wires.isMuxed() != BoardWires().isMuxed())
            throw std::runtime_error(
                std::string("--board: expected a board ") +
                (wires.isMuxed() ? "without multiplexed" : "with multiplexed") +
                " address and data, as this simulator was built, got '" + o.board +
                "'; build one with -DBOARD=NAME");
        if (!o.flight.contains("modem") && !wires.modem().empty())
            o.modem = wires.modem();
    } catch (const std::runtime_error& e) {
        throw std::invalid_argument(e.what());
    }
}

} // namespace

int main(int argc, char** argv) {
    const std::vector<std::string> words(argv + 1, argv + argc);
    if (std::find(words.begin(), words.end(), "--help") <
        std::find(words.begin(), words.end(), "--")) {
        std::cout << flightHelp();
        return 0;
    }
    struct sigaction action{};
    action.sa_handler = [](int signal) { Flight::stopSignal = signal; };
    for (int signal : {SIGINT, SIGTERM, SIGHUP})
        sigaction(signal, &action, nullptr);
    try {
        const json flight = flightOf(words);
        Flight::Options o = flight;
        o.flight = flight;
        const std::string replay = o.flight.value("replay", "");
        if (!replay.empty())
            o = recorded(o, replay);
        o.command.assign(std::find(words.begin(), words.end(), "--"), words.end());
        if (!o.command.empty())
            o.command.erase(o.command.begin());
        if (o.image.empty())
            throw std::invalid_argument("--image PICTURE is missing: the camera needs a picture");
        if (replay.empty() && o.flight.contains("wave"))
            throw std::invalid_argument(
                "--wave needs --replay: a waveform is made from a recorded flight");
        completeBoard(o);
        if (o.camera && !o.pins.empty())
            throw std::invalid_argument(
                "--camera and --pins exclude each other: both drive the inputs of cores");
        if (!o.trouble.empty() && o.vehicles < 2)
            throw std::invalid_argument("--trouble needs --vehicles 2 or more");
        if (o.cpu == "m3" && !o.modem_key.empty())
            throw std::invalid_argument(
                "--modem-key needs --cpu host: the ARM binary contains its own key");
        if (!o.flash.empty() && (o.cpu != "m3" || o.guard != 1000))
            throw std::invalid_argument(
                "--flash needs --cpu m3 and the default guard time of 1000 ms");
        if (!o.fpga_flash.empty() && o.flash.empty())
            throw std::invalid_argument(
                "--fpga-flash needs --flash: the boot loader loads the FPGA");
        if (o.cpu != "m3" && o.gdb >= 0)
            throw std::invalid_argument(
                o.replayed ? "--gdb: expected a flight with the ARM binary, got one with the host "
                             "build; fly again with make run CPU=m3"
                           : "--gdb needs --cpu m3");
        writeWave(o);
        return Flight(o).run();
    } catch (const std::invalid_argument& e) {
        std::cerr << "icesoc-sim: " << e.what() << "\n";
        return 2;
    } catch (const std::bad_alloc&) {
        std::cerr << "icesoc-sim: error: out of memory; a flight takes about 200 MB\n";
        return 1;
    } catch (const std::exception& e) {
        std::cerr << "icesoc-sim: error: " << e.what() << "\n";
        return 1;
    }
}
