// SPDX-License-Identifier: MIT
//
// icesoc-sim: options of a simulated flight.

#include "flight.h"
#include <CLI/CLI.hpp>
#include <iostream>

int main(int argc, char** argv) {
    CLI::App app{
        "Simulates the UAV: RTL, DDR3, firmware, modems, radio. The ground's modem is a pty.\n"
        "Words of COMMAND: {device} the pty, {frame} the camera's picture, {status} counters, "
        "{guard}, {out}."};
    Flight::Options o;
    app.add_option("--image", o.image, "picture for the camera: PNG, JPEG or PGM")->required();
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
    std::string trace;
    app.add_option("--trace", trace,
                   "CSV of loss, RSSI and delay (docs/models.md), in place of --loss");
    app.add_option("--seed", o.seed, "of the radio's misfortunes");
    app.add_option("--key", o.key,
                   "the UAV's modem encrypts with this AES key, 32 hexadecimal digits")
        ->check([](const std::string& text) {
            bool good = text.size() == 32 &&
                        text.find_first_not_of("0123456789abcdefABCDEF") == std::string::npos;
            return good ? std::string() : std::string("give 32 hexadecimal digits");
        });
    app.add_option("--guard", o.guard,
                   "guard time of both modems, ms; a ground station must know it: {guard}")
        ->check(CLI::Range(2, 3300));
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
    app.add_option("--hclk", o.hclk,
                   "of the Cortex-M3, Hz in simulated time; 0: 6/5 of the fabric's clock");
    app.add_option("--gdb", o.gdb, "wait for GDB on this port of the loopback interface; 0: any")
        ->check(CLI::Range(0, 65535));
    app.add_option("--marks", o.marks, "write exceptions and tasks to this waveform file (VCD)");
    app.add_flag("--quiet", o.quiet, "say nothing");
    app.add_option("command", o.command, "program to run against the modem, behind --");
    app.positionals_at_end();
    CLI11_PARSE(app, argc, argv);
    struct sigaction action {};
    action.sa_handler = [](int signal) { Flight::stopSignal = signal; };
    for (int signal : {SIGINT, SIGTERM, SIGHUP})
        sigaction(signal, &action, nullptr);
    if (o.cpu == "m3" && !o.key.empty()) {
        std::cerr << "icesoc-sim: --key needs --cpu host: the ARM binary has its own\n";
        return 2;
    }
    if (o.cpu != "m3" && (o.gdb >= 0 || !o.marks.empty())) {
        std::cerr << "icesoc-sim: --gdb and --marks need --cpu m3\n";
        return 2;
    }
    try {
        if (!trace.empty())
            o.weather.trace = std::make_shared<RfTrace>(trace);
        return Flight(o).run();
    } catch (const std::exception& e) {
        std::cerr << "icesoc-sim: error: " << e.what() << "\n";
        return 1;
    }
}
