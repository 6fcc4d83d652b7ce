// SPDX-License-Identifier: MIT
//
// modem: measures the simulated time that the set-up of a modem takes, for several guard times,
// several initial baud rates and each kind of modem. It measures the set-up by the modem controller
// (from CONFIGURE to CONFIGURED), and that by the engine on the ground.

#include "VModem.h"
#include "bench.h"
#include "bus_master.h"
#include "figures.h"
#include "modem_regs.h"
#include "modem_setup.h"
#include "npi_memory.h"
#include "rf_channel.h"
#include "xbee.h"
#include <fcntl.h>
#include <unistd.h>

namespace {

constexpr uint64_t clkNs = 500;

// Returns how long the controller takes to set up the modem, ms; 0 if the set-up failed.
double setUpMs(const char* profile, uint32_t guardMs, uint32_t bd) {
    Bench<VModem> bench;
    BusMaster<VModem> bus(bench);
    NpiMemory<VModem> memory(bench, 0, 1);
    RfChannel air(1);
    UartPins pins;
    XBee::Options options;
    options.profile = profile;
    options.set = {{"GT", guardMs}, {"BD", bd}};
    XBee modem(pins, air, options);
    bool txd = true;
    bench.addModel(
        [&] {
            if (bench.top().modem_txd_o != txd) {
                txd = bench.top().modem_txd_o;
                pins.setTxd(txd, bench.cycles() * clkNs);
            }
        },
        [&] {
            modem.advance(bench.cycles() * clkNs);
            bench.top().modem_rxd_i = pins.rxd();
            bench.top().modem_cts_n_i = pins.ctsN();
        });
    bench.reset();
    bus.write(MODEM_MASK, 0x7F);
    bus.write(MODEM_ADDR, 1);
    bus.write(MODEM_NET, 0x3332u << MODEM_NET_PAN_LSB | 0x0C);
    bus.write(MODEM_BAUD, guardMs << MODEM_BAUD_GUARD_MS_LSB | 7);
    uint64_t begin = bench.cycles();
    bus.write(MODEM_CONTROL, MODEM_CONTROL_CONFIGURE_MASK);
    bench.waitFor([&] { return bench.top().irq_o; }, "the end of the set-up", 100'000'000);
    bool done = bus.read(MODEM_EVENT) & MODEM_EVENT_CONFIGURED_MASK;
    return done ? static_cast<double>((bench.cycles() - begin) * clkNs) / 1e6 : 0;
}

// Returns the time in which the ground program sets up the modem over a pty, ms. Simulated time
// also passes while the program waits.
double groundSetUpMs(const char* profile, uint32_t guardMs, uint32_t bd) {
    RfChannel air(1);
    PtyLine pty;
    XBee::Options options;
    options.profile = profile;
    options.set = {{"GT", guardMs}, {"BD", bd}};
    XBee modem(pty, air, options);
    XBeeAT::Settings settings;
    settings.guardMs = static_cast<int>(guardMs);
    uint64_t now = 0;
    XBeeAT::SystemClock clock;
    XBeeAT::SerialPort serial(clock);
    serial.open(pty.path());
    XBeeAT::Log log = [](int, const std::string&) {};
    XBeeAT::ModemSetup setup(serial, settings, log, [&](int ms, bool forBytes) {
        const uint64_t begin = now;
        pollfd bytes = {serial.fd(), POLLIN, 0};
        while (now < begin + static_cast<uint64_t>(ms) * 1'000'000 &&
               !(forBytes && poll(&bytes, 1, 0) > 0)) {
            now += 50'000;
            modem.advance(now);
        }
        return static_cast<int>((now - begin) / 1000);
    });
    bool done = setup.run() && modem.parameter("BD") == 7;
    return done ? static_cast<double>(now) / 1e6 : 0;
}

} // namespace

int main(int argc, char** argv) {
    Figures figures("The simulated time of the modem's set-up.");
    return figures.run(argc, argv, [&] {
        struct Case {
            const char* name;
            uint32_t guardMs, bd;
            const char* profile = "s1"; // kind of modem (xbee_profile.h)
        };
        const Case cases[] = {
            {"set-up, modem with factory settings (9600 baud), guard time 1000 ms", 1000, 3},
            {"set-up, modem already at the target rate, guard time 1000 ms", 1000, 7},
            {"set-up, modem with factory settings (9600 baud), guard time 20 ms", 20, 3},
            {"set-up, modem already at the target rate, guard time 20 ms", 20, 7},
            {"set-up, modem at 1200 baud (the last rate but one that is tried), guard time 20 ms",
             20, 0},
            {"set-up, S2C with factory settings (9600 baud), guard time 1000 ms", 1000, 3, "s2c"},
            {"set-up, S2C already at the target rate, guard time 1000 ms", 1000, 7, "s2c"},
            {"set-up, XBee 3 with factory settings (9600 baud), guard time 1000 ms", 1000, 3,
             "xb3"},
            {"set-up, XBee 3 already at the target rate, guard time 1000 ms", 1000, 7, "xb3"}};
        struct Side {
            const char* name;
            double (*measure)(const char*, uint32_t, uint32_t);
        };
        const Side sides[] = {{"controller", setUpMs}, {"ground", groundSetUpMs}};
        for (const Side& side : sides)
            for (const Case& c : cases) {
                if (figures.brief && (c.guardMs > 20 || c.bd != 7))
                    continue;
                double ms = side.measure(c.profile, c.guardMs, c.bd);
                // The limit is the two guard times that the modem's manual demands; the commands
                // and the search for the baud rate take additional time.
                double floor = 2.0 * c.guardMs;
                std::string name = std::string(side.name) + ": " + c.name;
                if (ms == 0)
                    throw std::runtime_error(name + ": the set-up failed");
                figures.add(name, ms, "ms simulated")
                    .update({{"peer", floor}, {"ratio", ms / floor}});
            }
    });
}
