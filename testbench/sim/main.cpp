// SPDX-License-Identifier: MIT
//
// icesoc-sim: options of a simulated flight.

#include "files.h"
#include "flight.h"
#include <CLI/CLI.hpp>
#include <iostream>

namespace {

struct CommandLine {
    Flight::Options o;
    std::string replay, wave;
    CLI::App app{
        "Simulates the UAV: RTL, DDR3, firmware, modems, radio. The ground's modem is a pty.\n"
        "Words of COMMAND: {device} the pty, {frame} the camera's picture, {status} counters, "
        "{guard}, {out}."};
    CommandLine();
    void parse(std::vector<std::string> words);
};

CommandLine::CommandLine() {
    app.add_option("--image", o.image, "picture for the camera: PNG, JPEG or PGM");
    app.add_flag("--sensor", o.sensor,
                 "the picture comes through the camera core's pins, not into memory");
    app.add_option("--pins", o.pins,
                   "play this file on the inputs of cores, and write their outputs to pins.log: "
                   "\"12.5 servo.fault_i 1\" is milliseconds, core and pin, value")
        ->excludes("--sensor");
    app.add_option("--size", o.size, "of the camera's frame, WIDTHxHEIGHT");
    app.add_option("--loss", o.weather.loss, "loss on the air, each way")
        ->check(CLI::Range(0.0, 1.0));
    app.add_option("--interference", o.weather.interference,
                   "share of each 20 ms in which others are heard on the channel")
        ->check(CLI::Range(0.0, 1.0));
    app.add_option("--distance", o.weather.distance, "metres in free space, with fading; 0: none")
        ->check(CLI::Range(0.0, 1e5));
    app.add_option("--trace", o.trace,
                   "CSV of loss, RSSI and delay (docs/models.md), in place of --loss");
    app.add_option("--seed", o.seed, "of the radio's misfortunes");
    app.add_option("--key", o.keyFile,
                   "file with the vehicle's key, as the ground's (XBeeAT.KeyFile); without: open");
    app.add_option("--modem-key", o.modemKey,
                   "the UAV's modem encrypts with this AES key, 32 hexadecimal digits")
        ->check([](const std::string& text) {
            bool good = text.size() == 32 &&
                        text.find_first_not_of("0123456789abcdefABCDEF") == std::string::npos;
            return good ? std::string() : std::string("give 32 hexadecimal digits");
        });
    app.add_option("--guard", o.guard,
                   "guard time of both modems, ms; a ground station must know it: {guard}")
        ->check(CLI::Range(2, 3300));
    app.add_option("--replay", replay,
                   "fly the flight again that was recorded in this folder, as it was, without its "
                   "command; beside it --out, --gdb, --wave, --every-clock and --speed count");
    app.add_option("--wave", wave, "write a waveform (FST) of a replay to this file");
    app.add_option("--from", o.from, "s, where the waveform begins");
    app.add_option("--to", o.to, "s, where it ends");
    app.add_flag("--every-clock", o.everyClock, "evaluate each clock, quiet ones too (slow)");
    app.add_option("--out", o.out, "folder for before.png and the counters");
    app.add_option("--speed", o.speed,
                   "real: simulated time follows the clock; 0.25: at a quarter of its speed; max: "
                   "as fast as it goes")
        ->check(CLI::IsMember({"real", "max"}) | CLI::Range(0.01, 100.0));
    app.add_option("--duration", o.duration, "end after so many simulated seconds");
    app.add_option("--cpu", o.cpu,
                   "host: the firmware's host build; m3: its ARM binary on a Cortex-M3 model")
        ->check(CLI::IsMember({"host", "m3"}));
    app.add_option("--firmware", o.firmware, "ELF file for --cpu m3");
    app.add_option("--flash", o.flash,
                   "the chip's flash with --cpu m3, 1 MiB by pack_update; it is kept there");
    app.add_option("--fpga-flash", o.fpgaFlash,
                   "the FPGA's configuration flash beside --flash, 2 MiB by pack_update; kept too");
    app.add_option("--gdb", o.gdb, "wait for GDB on this port of the loopback interface; 0: any")
        ->check(CLI::Range(0, 65535));
    app.add_flag("--quiet", o.quiet, "say nothing");
    app.add_option("command", o.command, "program to run against the modem, behind --");
    app.positionals_at_end();
}

void CommandLine::parse(std::vector<std::string> words) {
    o.words.assign(words.begin(), std::find(words.begin(), words.end(), "--"));
    std::reverse(words.begin(), words.end()); // CLI11 needs this order
    app.parse(words);
}

void writeWave(const CommandLine& line) {
    if (line.wave.empty())
        return;
#ifdef ICESOC_TRACE
    auto clocks = [](double seconds) {
        return std::to_string(
            static_cast<uint64_t>(seconds * static_cast<double>(SocModel::clkHz)));
    };
    setenv("WAVE", line.wave.c_str(), 1); // observer.h
    setenv("WAVE_FROM", clocks(line.o.from).c_str(), 1);
    setenv("WAVE_TO", clocks(line.o.to).c_str(), 1);
#else
    throw std::runtime_error("this simulator writes no waveforms: the one in build/trace does "
                             "(make run REPLAY=" +
                             line.replay + " FROM=1.5 TO=1.6)");
#endif
}

// The options of the recorded flight, and those of this view of it.
Flight::Options recorded(const CommandLine& now) {
    auto replayed = std::make_shared<ReplayedLine>(now.replay + "/flight.jsonl");
    const nlohmann::json& head = replayed->head();
    if (head.at("clkHz") != SocModel::clkHz)
        throw std::runtime_error("that flight had a clock of " + head.at("clkHz").dump() +
                                 " Hz: make run REPLAY=" + now.replay +
                                 " CLK_HZ=" + head.at("clkHz").dump());
    CommandLine then;
    then.parse(head.at("flight"));
    Flight::Options o = then.o;
    for (const auto& [file, hash] : head.value("hashes", std::map<std::string, std::string>()))
        if (hexHash(readFile(file)) != hash)
            throw std::runtime_error("'" + file +
                                     "' is not what it was when that flight was recorded");
    if (std::filesystem::weakly_canonical(now.o.out) ==
        std::filesystem::weakly_canonical(now.replay))
        throw std::runtime_error("the replay needs a folder of its own: give another --out than '" +
                                 now.replay + "'");
    o.image = now.replay + "/before.png";
    o.replayed = replayed;
    o.out = now.o.out;
    o.speed = now.app.count("--speed") ? now.o.speed : "max";
    o.gdb = now.o.gdb;
    o.everyClock = now.o.everyClock;
    o.quiet = now.o.quiet;
    o.from = now.o.from;
    o.to = now.o.to;
    return o;
}

} // namespace

int main(int argc, char** argv) {
    CommandLine line;
    try {
        line.parse({argv + 1, argv + argc});
    } catch (const CLI::ParseError& e) {
        if (e.get_exit_code() == 0) // --help
            return line.app.exit(e);
        std::cerr << "icesoc-sim: " << e.what() << "; see --help\n";
        return 2;
    }
    struct sigaction action{};
    action.sa_handler = [](int signal) { Flight::stopSignal = signal; };
    for (int signal : {SIGINT, SIGTERM, SIGHUP})
        sigaction(signal, &action, nullptr);
    try {
        Flight::Options o = line.replay.empty() ? line.o : recorded(line);
        if (o.image.empty())
            throw std::invalid_argument("give --image, the picture for the camera");
        if (line.replay.empty() && !line.wave.empty())
            throw std::invalid_argument(
                "--wave needs --replay: a flight is recorded, then looked at");
        if (o.cpu == "m3" && !o.modemKey.empty())
            throw std::invalid_argument("--modem-key needs --cpu host: the ARM binary has its own");
        if (!o.flash.empty() && (o.cpu != "m3" || o.guard != 1000))
            throw std::invalid_argument("--flash needs --cpu m3, and the modems' usual guard time");
        if (!o.fpgaFlash.empty() && o.flash.empty())
            throw std::invalid_argument("--fpga-flash needs --flash: the boot loader's checks");
        if (o.cpu != "m3" && o.gdb >= 0)
            throw std::invalid_argument(
                o.replayed ? "that flight was flown by the firmware's host build; GDB needs one of "
                             "the ARM binary: make run CPU=m3"
                           : "--gdb needs --cpu m3");
        writeWave(line);
        if (!o.trace.empty())
            o.weather.trace = std::make_shared<RfTrace>(o.trace);
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
