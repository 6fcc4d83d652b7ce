// SPDX-License-Identifier: MIT
//
// icesoc-xbee: simulates two XBee modems, each on a pseudo-terminal, and the air between them, to
// test any program that uses an XBee.

#include "rf_channel.h"
#include "xbee.h"
#include "xbee_parameters.h"
#include <CLI/CLI.hpp>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>
#include <memory>
#include <thread>

namespace {

volatile std::sig_atomic_t stopped = 0;

struct Settings {
    std::string link; // path of a symbolic link to the pseudo-terminal
    std::vector<std::string> set;
};

struct Options {
    Settings a, b;
    RfChannel::Weather weather;
    double delayMs = 0, duration = 0;
    uint64_t seed = testSeed(), bootMs = 50;
    bool verbose = false;
    std::string trace, modem = "s1";
};

struct Modem {
    PtyLine line;
    std::unique_ptr<XBee> xbee;
    std::string link;
    ~Modem() {
        std::error_code ignored;
        if (!link.empty())
            std::filesystem::remove(link, ignored);
    }
};

// Parses "MY=1" and sets this parameter of the modem. Throws CLI::ValidationError with the reason.
void setParameter(std::map<std::string, uint32_t>& set, const std::string& profile,
                  const std::string& text) {
    std::string letters = text.substr(0, text.find('='));
    std::string digits = text.substr(std::min(letters.size() + 1, text.size()));
    const auto known = xbeeParameters(xbeeProfile(profile));
    auto parameter = known.find(letters);
    char* end = nullptr;
    unsigned long value = std::strtoul(digits.c_str(), &end, 16);
    if (parameter == known.end())
        throw CLI::ValidationError("'" + text + "'", "unknown parameter " + letters);
    if (digits.empty() || *end)
        throw CLI::ValidationError("'" + text + "'",
                                   "expected a parameter and its value in hex, such as MY=1A2B");
    if (value < parameter->second.lowest || value > parameter->second.highest)
        throw CLI::ValidationError("'" + text + "'", fmt::format("{}: expected {:X} to {:X} (hex)",
                                                                 letters, parameter->second.lowest,
                                                                 parameter->second.highest));
    set[letters] = static_cast<uint32_t>(value);
}

void power(Modem& modem, RfChannel& air, const std::string& name, const Settings& settings,
           const Options& o, std::map<std::string, uint32_t> set) {
    XBee::Options options;
    options.name = name;
    options.profile = o.modem;
    options.bootNs = o.bootMs * 1'000'000;
    for (auto& text : settings.set)
        setParameter(set, o.modem, text);
    options.set = std::move(set);
    modem.xbee = std::make_unique<XBee>(modem.line, air, options);
    if (!settings.link.empty()) {
        std::error_code error;
        if (std::filesystem::is_symlink(settings.link))
            std::filesystem::remove(settings.link, error);
        std::filesystem::create_symlink(modem.line.path(), settings.link, error);
        if (error)
            throw CLI::ValidationError(settings.link, error.message());
        modem.link = settings.link;
    }
    fmt::print("{}: {}{}{}, {:.0f} baud, address {:04X}, sends to {:04X}\n", name,
               modem.line.path(), modem.link.empty() ? "" : " = ", modem.link, modem.xbee->baud(),
               modem.xbee->parameter("MY"), modem.xbee->parameter("DL"));
}

void report(const XBee& modem) {
    const XBee::Counters& c = modem.counters();
    fmt::print("{}: {} bytes from the host, {} to it, {} packets sent, {} received, {} commands "
               "({} refused), lost: {} bytes by overflow, {} framing errors, {} packets by a full "
               "buffer\n",
               modem.name(), c.bytesFromHost, c.bytesToHost, c.packetsSent, c.packetsReceived,
               c.commands, c.refused, c.overflow, c.framingErrors, c.packetsDropped);
}

void report(const RfChannel& air) {
    const RfChannel::Counters& c = air.counters();
    fmt::print("air: {} packets, {} bytes, {} lost, {} corrupted, {} duplicated, {} tries again, "
               "{} collisions, {} never sent, {:.1f} ms\n",
               c.packets, c.bytes, c.lost, c.corrupted, c.duplicated, c.retries, c.collisions,
               c.noClearChannel, static_cast<double>(c.airNs) / 1e6);
}

void say(uint64_t now, const RfPacket& packet, RfChannel::Outcome outcome) {
    static const char* const outcomes[] = {"delivered",   "lost",    "corrupted",
                                           "no receiver", "no room", "channel not clear"};
    fmt::print("{:9.3f} s  {:04X} -> {:04X}  {:3} bytes  {}\n", static_cast<double>(now) / 1e9,
               packet.from, packet.to, packet.bytes.size(), outcomes[static_cast<int>(outcome)]);
}

// Runs for `duration` seconds, or until Ctrl-C if `duration` is 0, and prints statistics.
void run(RfChannel& air, XBee& a, XBee& b, double duration) {
    std::signal(SIGINT, [](int) { stopped = 1; });
    std::signal(SIGTERM, [](int) { stopped = 1; });
    const auto begin = std::chrono::steady_clock::now();
    for (uint64_t now = 0;
         !stopped && (duration == 0 || static_cast<double>(now) <= duration * 1e9);
         std::this_thread::sleep_for(std::chrono::microseconds(500))) {
        now = static_cast<uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(
                                        std::chrono::steady_clock::now() - begin)
                                        .count());
        air.advance(now);
        a.advance(now);
        b.advance(now);
    }
    report(a);
    report(b);
    report(air);
}

void addSettings(CLI::App& app, const std::string& name, Settings& settings) {
    app.add_option("--" + name, settings.set,
                   "parameter of modem " + name +
                       " and its value in hex, such as MY=1 or BD=7; may be repeated")
        ->type_name("XX=HEX");
    app.add_option("--link-" + name, settings.link,
                   "symbolic link to create, which points to the pseudo-terminal of modem " + name)
        ->type_name("PATH");
}

void describe(CLI::App& app, Options& o) {
    addSettings(app, "a", o.a);
    addSettings(app, "b", o.b);
    app.add_option("--modem", o.modem, "kind of both modems: series 1, S2C or XBee 3")
        ->check(CLI::IsMember({"s1", "s2c", "xb3"}))
        ->capture_default_str();
    auto chance = [&app](const char* option, double& value, const char* what) {
        app.add_option(option, value, what)->check(CLI::Range(0.0, 1.0))->capture_default_str();
    };
    chance("--loss", o.weather.loss, "probability that a packet is lost despite its retries");
    chance("--burst-begin", o.weather.burstBegin,
           "probability per packet that a burst of losses begins (Gilbert-Elliott model)");
    chance("--burst-end", o.weather.burstEnd, "probability per packet that a burst ends");
    chance("--burst-loss", o.weather.burstLoss, "probability that a packet in a burst is lost");
    chance("--duplication", o.weather.duplication, "probability that a packet arrives twice");
    chance("--corruption", o.weather.corruption, "probability that a packet has a wrong byte");
    chance("--try-loss", o.weather.tryLoss,
           "probability that one try is lost; the MAC then tries again");
    chance("--ack-loss", o.weather.ackLoss,
           "probability that an acknowledgement is lost, which causes duplicates");
    chance("--interference", o.weather.interference,
           "share of each 20 ms in which other senders occupy the channel");
    app.add_option("--distance", o.weather.distance,
                   "distance in free space, m, with fading; 0 disables path loss (default)")
        ->check(CLI::Range(0.0, 1e5));
    app.add_option("--trace", o.trace,
                   "CSV file with loss, RSSI and delay over time; replaces the options above")
        ->check(CLI::ExistingFile);
    app.add_flag("--perfect", o.weather.perfect,
                 "no collisions, both directions at once, modems without processing time");
    app.add_option("--delay", o.delayMs, "delay in addition to the time on the air, ms (default 0)")
        ->check(CLI::Range(0.0, 10000.0));
    app.add_option("--boot", o.bootMs, "boot time of the modems, ms")
        ->check(CLI::Range(0, 5000))
        ->capture_default_str();
    app.add_option("--seed", o.seed,
                   "seed of all random numbers (default: the environment variable SEED, or 1)");
    app.add_option("--duration", o.duration, "run time, s; 0 runs until Ctrl-C (default)")
        ->check(CLI::Range(0.0, 1e6));
    app.add_flag("-v,--verbose", o.verbose, "print a line for each packet");
    app.footer("examples:\n"
               "  icesoc-xbee --link-a /tmp/ground --link-b /tmp/uav\n"
               "  icesoc-xbee --a MY=0 --a DL=1 --b MY=1 --b DL=0 --loss 0.05\n"
               "  icesoc-xbee --modem s2c --distance 300 --verbose --duration 60");
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app{
        "Simulates two XBee 802.15.4 modems on pseudo-terminals, and the air between them, to\n"
        "try any program that uses an XBee. Open the printed devices as serial ports. Ctrl-C\n"
        "ends the simulation and prints statistics. Modem a has address 1 and sends to 2;\n"
        "modem b has address 2 and sends to 1.",
        "icesoc-xbee"};
    Options o;
    describe(app, o);
    CLI11_PARSE(app, argc, argv);

    RfChannel air(o.seed);
    air.weather = o.weather;
    air.weather.delayNs = static_cast<uint64_t>(o.delayMs * 1e6);
    if (o.verbose)
        air.onPacket(say);
    std::setvbuf(stdout, nullptr, _IOLBF, 0);
    try {
        if (!o.trace.empty())
            air.weather.trace = std::make_shared<RfTrace>(o.trace);
        Modem a, b;
        power(a, air, "a", o.a, o, {{"MY", 1}, {"DL", 2}});
        power(b, air, "b", o.b, o, {{"MY", 2}, {"DL", 1}});
        run(air, *a.xbee, *b.xbee, o.duration);
    } catch (const CLI::Error& error) {
        fmt::print(stderr, "icesoc-xbee: {}\n", error.what());
        return 2;
    } catch (const std::exception& error) {
        fmt::print(stderr, "icesoc-xbee: {}\n", error.what());
        return 1;
    }
    return 0;
}
