// SPDX-License-Identifier: MIT
//
// set_up_bench: simulated time that the modem controller's set-up takes, from CONFIGURE to
// CONFIGURED, by guard time and by the rate at which the modem is found.

#include "VModem.h"
#include "bench.h"
#include "bus_master.h"
#include "modem_regs.h"
#include "npi_memory.h"
#include "rf_channel.h"
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>
#include <nlohmann/json.hpp>

namespace {

constexpr uint64_t clkNs = 500;

// ms; 0 if the set-up failed.
double setUpMs(uint32_t guardMs, uint32_t bd) {
    Bench<VModem> bench;
    BusMaster<VModem> bus(bench);
    NpiMemory<VModem> memory(bench, 0, 1);
    RfChannel air(1);
    UartPins pins;
    XBee::Options options;
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

} // namespace

int main(int argc, char** argv) {
    CLI::App app{"Measures the simulated time of the modem's set-up."};
    std::string json;
    app.add_option("--json", json, "File for the figures")->required();
    CLI11_PARSE(app, argc, argv);

    struct Case {
        const char* name;
        uint32_t guardMs, bd;
    };
    const Case cases[] = {
        {"set-up, modem as from the factory (9600), guard time 1000 ms", 1000, 3},
        {"set-up, modem at the rate already, guard time 1000 ms", 1000, 7},
        {"set-up, modem as from the factory (9600), guard time 20 ms", 20, 3},
        {"set-up, modem at the rate already, guard time 20 ms", 20, 7},
        {"set-up, modem at 1200 baud, found last but one, guard time 20 ms", 20, 0}};
    nlohmann::json entries = nlohmann::json::array();
    bool good = true;
    for (const Case& c : cases) {
        double ms = setUpMs(c.guardMs, c.bd);
        good = good && ms > 0;
        // Two guard times are in the modem's manual; what is above them is commands and search.
        double floor = 2.0 * c.guardMs;
        std::printf("%-72s %8.1f ms  (two guard times: %.0f)\n", c.name, ms, floor);
        entries.push_back({{"name", c.name},
                           {"value", ms},
                           {"unit", "ms simulated"},
                           {"peer", floor},
                           {"ratio", ms / floor},
                           {"command", "make bench"}});
    }
    std::ofstream(json) << entries.dump(2) << '\n';
    return good ? 0 : 1;
}
