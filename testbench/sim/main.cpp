// SPDX-License-Identifier: MIT
//
// icesoc-sim: options of a simulated flight.

#include "files.h"
#include "flight.h"
#include "flight_file.h"
#include <iostream>

namespace {

// Takes the fields that the simulator reads; those that are missing stay as they are.
Flight::Options optionsOf(const nlohmann::json& flight) {
    Flight::Options o;
    o.flight = flight;
    auto take = [&flight](const char* name, auto& value) {
        if (flight.contains(name))
            flight.at(name).get_to(value);
    };
    take("image", o.image);
    take("size", o.size);
    take("camera", o.sensor);
    take("pins", o.pins);
    take("loss", o.weather.loss);
    take("interference", o.weather.interference);
    take("distance", o.weather.distance);
    take("trace", o.trace);
    take("seed", o.seed);
    take("key", o.keyFile);
    take("modem_key", o.modemKey);
    take("guard", o.guard);
    take("from", o.from);
    take("to", o.to);
    take("every_clock", o.everyClock);
    take("out", o.out);
    take("speed", o.speed);
    take("duration", o.duration);
    take("cpu", o.cpu);
    take("firmware", o.firmware);
    take("flash", o.flash);
    take("fpga_flash", o.fpgaFlash);
    take("gdb", o.gdb);
    take("quiet", o.quiet);
    return o;
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

// The options of the recorded flight, and those of this view of it.
Flight::Options recorded(const Flight::Options& now, const std::string& folder) {
    auto replayed = std::make_shared<ReplayedLine>(folder + "/flight.jsonl");
    const nlohmann::json& head = replayed->head();
    if (head.at("clkHz") != SocModel::clkHz)
        throw std::runtime_error("that flight had a clock of " + head.at("clkHz").dump() +
                                 " Hz: make run REPLAY=" + folder +
                                 " CLK_HZ=" + head.at("clkHz").dump());
    Flight::Options o = optionsOf(head.at("flight"));
    for (const auto& [file, hash] : head.value("hashes", std::map<std::string, std::string>()))
        if (hexHash(readFile(file)) != hash)
            throw std::runtime_error("'" + file +
                                     "' is not what it was when that flight was recorded");
    if (std::filesystem::weakly_canonical(now.out) == std::filesystem::weakly_canonical(folder))
        throw std::runtime_error("the replay needs a folder of its own: give another --out than '" +
                                 folder + "'");
    o.flight = now.flight;
    o.image = folder + "/before.png";
    o.replayed = replayed;
    o.out = now.out;
    o.speed = now.flight.value("speed", "max");
    o.gdb = now.gdb;
    o.everyClock = now.everyClock;
    o.quiet = now.quiet;
    o.from = now.from;
    o.to = now.to;
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
        Flight::Options o = optionsOf(flightOf(words));
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
        if (o.sensor && !o.pins.empty())
            throw std::invalid_argument("--camera and --pins: both drive the inputs of cores");
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
        writeWave(o);
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
