// SPDX-License-Identifier: MIT
//
// cores_test: a core's share of the chip, with figures that add up by hand, and the owner of logic
// that reads its registers.

#include "cores.h"

#include <gmock/gmock.h>

using testing::ElementsAre;
using testing::HasSubstr;

namespace {

struct Chip {
    ChipMap map = {{"SLOT_SYSTEM", 0}, {"SLOT_MODEM", 1},     {"SLOT_LOW", 2},
                   {"SLOT_PLAIN", 3},  {"SLOT_OWN", 4},       {"SLOT_GONE", 5},
                   {"SLOT_COUNT", 6},  {"NPI_PORT_COUNT", 3}, {"NPI_PORT_LOW", 1}};
    Costs costs;
    Cost slot{12, 0, 5, 0, 0, 0};

    Chip() {
        const auto add = [&](const char* path, int lut, int ff, double ram = 0, int dsp = 0) {
            costs[{path, "signal"}] = {lut, 0, ff, 0, ram, dsp};
        };
        add("u_modem", 900, 900);
        add("u_bus_decoder", 400, 4);
        add("u_low", 15, 3);
        add("u_low.u_wrapper", 3, 30);
        add("u_low.u_wrapper.u_registers", 1, 2);
        add("u_low.u_filter", 7, 8, 1.5, 4);
        add("u_lower", 1000, 1000);
        add("u_plain", 9, 9);
        add("u_plain.u_bus.u_window", 4, 5);
        add("u_own.u_crossing", 20, 60);
        add("u_own.u_core.u_bus", 6, 7);
        add("u_own.u_core.u_core", 1, 1);
        add("u_memory.u_arbiter", 20, 6);
        add("u_memory.u_backend", 10, 0);
        add("u_memory.u_arbiter.g_port[1].u_write", 5, 6, 2);
        add("u_memory.u_arbiter.g_port[10].u_write", 500, 500);
    }
    std::vector<std::vector<std::string>> rows(const std::vector<std::string>& names = {}) const {
        return coreTable(costs, map, slot, names, "here").rows();
    }
};

TEST(Cores, AShareHasEachPartOnce) {
    EXPECT_THAT(
        Chip().rows(),
        ElementsAre(
            ElementsAre("core in the chip", "LUT", "FF", "RAM16", "DSP", "itself", "registers",
                        "slot 6", "memory port", "of the arbiter"),
            ElementsAre("low", "53", "56", "3.5", "4", "22 / 11", "4 / 32", "12 / 5", "5 / 6",
                        "10 / 2"),
            ElementsAre("plain", "25", "19", "0", "0", "9 / 9", "4 / 5", "12 / 5", "", ""),
            ElementsAre("own", "39", "73", "0", "0", "1 / 1", "26 / 67", "12 / 5", "", "")));
}

TEST(Cores, OnlyThoseAskedForAreTold) {
    EXPECT_EQ(Chip().rows({"plain"}).size(), 2U);
    try {
        Chip().rows({"plain", "gone"});
        FAIL();
    } catch (const std::runtime_error& e) {
        EXPECT_THAT(e.what(),
                    HasSubstr("gone is not in the chip of here: a line in ip/cores.list"));
    }
}

// Two LUTs that read a register of a block each, one that reads both, and the decoder's choice.
TEST(Cores, LogicThatReadsOneSlotIsItsBlocks) {
    Netlist n;
    const auto add = [&](const std::string& name, const char* type, const std::vector<int>& inputs,
                         int output) {
        Cell cell{name, type, !name.empty(), {}, {{"O", true, {output}}}};
        const int index = static_cast<int>(n.cells.size());
        for (const int bit : inputs) {
            cell.pins.push_back({"I", false, {bit}});
            n.readers[bit].push_back(index);
        }
        n.driver[output] = index;
        n.cells.push_back(cell);
    };
    add("u_a.count", "FDRE", {}, 2);
    add("u_b.u_part.state", "FDRE", {}, 3);
    add("u_bus_decoder.index", "FDRE", {}, 4);
    add("", "LUT4", {2, 4}, 5);
    add("", "LUT4", {3, 4}, 6);
    add("", "LUT4", {2, 3, 4}, 7);
    add("", "LUT6", {5}, 8); // behind a's
    add("", "LUT6", {6, 7, 8}, 9);
    n.names[9] = {{"u_bus_decoder.bus_rdata_o", 0}};
    const auto owners = ownersOf(n, [](const std::string&) { return std::set<std::string>{}; });
    EXPECT_THAT(owners,
                ElementsAre("u_a.count", "u_b.u_part.state", "u_bus_decoder.index",
                            "u_a.bus_rdata_o", "u_b.bus_rdata_o", "u_bus_decoder.bus_rdata_o",
                            "u_a.bus_rdata_o", "u_bus_decoder.bus_rdata_o"));
}

} // namespace
