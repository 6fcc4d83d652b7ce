// SPDX-License-Identifier: MIT
//
// icesoc-sim: reads the options of a simulated flight from a file (flight.json) and from arguments
// "--name value". A schema defines the fields, their types and limits; ./icesoc generates it from
// its options.

#include "files.h"
#include "flight.h"
#include <algorithm>
#include <fmt/format.h>
#include <iostream>
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

// Converts an argument to a value of the field's type; returns the text if that is not possible.
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

// Reads arguments up to "--". "--flight FILE" takes all fields from a file; later arguments
// override single fields. Throws std::invalid_argument, which names the argument, if one is wrong.
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
                throw std::invalid_argument("'" + *word +
                                            "' is not a flight: expected a JSON "
                                            "object");
            flight.update(described);
        } else
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

// Returns the help text, with all fields.
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
    throw std::runtime_error("this simulator writes no waveforms: the one in build/trace does "
                             "(make run REPLAY=" +
                             o.flight.value("replay", "") + " FROM=1.5 TO=1.6)");
#endif
}

// Combines the options of the recorded flight with the options that control this replay.
Flight::Options recorded(const Flight::Options& now, const std::string& folder) {
    auto replayed = std::make_shared<ReplayedLine>(folder + "/flight.jsonl");
    const json& head = replayed->head();
    if (head.at("clkHz") != SocModel::clkHz)
        throw std::runtime_error("the recorded flight has a clock of " + head.at("clkHz").dump() +
                                 " Hz: make run REPLAY=" + folder +
                                 " CLK_HZ=" + head.at("clkHz").dump());
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
            throw std::invalid_argument("give --image, the picture for the camera");
        if (replay.empty() && o.flight.contains("wave"))
            throw std::invalid_argument(
                "--wave needs --replay: a flight is recorded, then looked at");
        if (o.camera && !o.pins.empty())
            throw std::invalid_argument("--camera and --pins: both drive the inputs of cores");
        if (!o.trouble.empty() && o.vehicles < 2)
            throw std::invalid_argument("--trouble needs --vehicles: it befalls one of several");
        if (o.cpu == "m3" && !o.modem_key.empty())
            throw std::invalid_argument("--modem-key needs --cpu host: the ARM binary has its own");
        if (!o.flash.empty() && (o.cpu != "m3" || o.guard != 1000))
            throw std::invalid_argument("--flash needs --cpu m3, and the modems' usual guard time");
        if (!o.fpga_flash.empty() && o.flash.empty())
            throw std::invalid_argument("--fpga-flash needs --flash: the boot loader's checks");
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
