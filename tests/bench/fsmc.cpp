// SPDX-License-Identifier: MIT
//
// fsmc: measures the speed of the FSMC bridge in the whole chip: the real driver, the pins, the
// bridge, the arbiter, the MCB and DDR3.

#include "driver_port.h"
#include "figures.h"
#include "map_regs.h"
#include "random.h"
#include "soc_model.h"
#include "system_regs.h"
#include <fmt/format.h>

namespace {

constexpr double fabricHz = 100e6;
constexpr uint32_t ddr = MAP_DDR_WINDOW, control = MAP_CONTROL_WINDOW;

Figures figures("Speed of the FSMC bridge with the real driver, up to DDR3.");

// A chip and its driver. HCLK is given in MHz; the fabric runs at 100 MHz.
struct Chip {
    Chip(unsigned hclkMhz, uint64_t seed) : air(seed), soc(air, {}, hclkMhz, 100) {
        soc.reset();
        if (FSMC_init(&driverPort, &soc.fsmc()) != FSMC_OK)
            throw std::runtime_error("the chip does not answer");
        FSMC_setHclk(hclkMhz * 1000000);
        FSMC_read(MAP_SLOT_SYSTEM, SYSTEM_ID);
    }
    template <class F> double clocks(F f) {
        uint64_t start = soc.cycles();
        f();
        return static_cast<double>(soc.cycles() - start);
    }
    RfChannel air;
    SocModel soc;
};

// Measures block transfers by the driver. Their time includes the set-up of the bank, the bridge's
// reading ahead, and the driver's check at the end.
double streams(unsigned hclk, uint64_t seed, uint32_t halfwords, bool& right) {
    Chip chip(hclk, seed);
    Random random(seed);
    auto out = random.items<U16>(halfwords);
    std::vector<U16> in(halfwords);
    U32 repeated = 0;
    double least = 1;
    // An access takes a whole number of HCLK cycles. Therefore the limit of the pins depends on the
    // driver's timing at this HCLK (docs/fsmc.md).
    auto show = [&](const char* what, double clocks, unsigned cycles, double wanted) {
        double rate = halfwords / clocks * fabricHz, limit = hclk * 1e6 / cycles;
        figures.add(fmt::format("FSMC, HCLK {} MHz, {}", hclk, what), rate / 1e6,
                    "million halfwords/s", limit / 1e6);
        if (wanted > 0)
            least = std::min(least, rate / limit / wanted);
    };
    unsigned readCycles = (hclk + 24) / 25;
    show("sequential writes, stream",
         chip.clocks([&] { repeated += FSMC_streamWrite(0x10000, out.data(), halfwords); }), 4,
         0.99);
    show("sequential reads, stream",
         chip.clocks([&] { repeated += FSMC_streamRead(0x10000, in.data(), halfwords); }),
         readCycles, 0.95);
    right = right && in == out && repeated == 0;
    std::vector<U8> bytes(2 * halfwords);
    show("sequential writes, NWAIT (driver's copy)",
         chip.clocks([&] { FSMC_writeMemory(0x90000, bytes.data(), 2 * halfwords); }), 7, 0);
    show("sequential reads, NWAIT (driver's copy)",
         chip.clocks([&] { FSMC_readMemory(0x90000, bytes.data(), 2 * halfwords); }), 7, 0);
    return least;
}

// Copies a picture of 320 x 240 bytes to DDR3 and back in two ways, like the firmware: with NWAIT,
// and as a stream.
void frame(unsigned hclk, uint64_t seed, bool& right, uint32_t halfwords = 320 * 240 / 2) {
    Chip chip(hclk, seed);
    Random random(seed);
    std::vector<U16> out(halfwords), in(halfwords);
    auto show = [&](const char* what, double clocks) {
        figures.add(fmt::format("FSMC, HCLK {} MHz, frame of 320 x 240, {}", hclk, what),
                    clocks / fabricHz * 1e3, "ms");
    };
    auto bytes = [](std::vector<U16>& v) { return reinterpret_cast<U8*>(v.data()); };
    auto pass = [&](const char* writes, const char* reads, auto write, auto read) {
        for (auto& value : out)
            value = static_cast<U16>(random.next());
        show(writes, chip.clocks(write));
        show(reads, chip.clocks(read));
        right = right && in == out;
    };
    pass(
        "written with NWAIT", "read with NWAIT",
        [&] { FSMC_writeMemory(0x10000, bytes(out), 2 * halfwords); },
        [&] { FSMC_readMemory(0x10000, bytes(in), 2 * halfwords); });
    pass(
        "written as a stream", "read as a stream",
        [&] { FSMC_streamWrite(0x10000, out.data(), halfwords); },
        [&] { FSMC_streamRead(0x10000, in.data(), halfwords); });
}

void single(unsigned hclk, uint64_t seed, int count) {
    Chip chip(hclk, seed);
    Random random(seed);
    FsmcMaster& master = chip.soc.fsmc();
    double hclks = 100.0 / hclk; // number of fabric clocks per HCLK cycle
    auto show = [&](const char* what, double least, const std::function<void()>& access) {
        double sum = chip.clocks([&] {
            for (int i = 0; i < count; ++i)
                access();
        });
        figures.add(fmt::format("FSMC, HCLK {} MHz, {}", hclk, what), sum / count, "clocks", least);
    };
    // Shortest access: ADDSET 2, DATAST 4 and 1 HCLK of hold or turnaround. A read that waits ends
    // 4 HCLK after NWAIT is released. The read first passes two flip-flops (1 to 2 clocks, 1.5 on
    // average). Three more clocks register the read, request the data, and return the data.
    double access = 7 * hclks, waits = (2 + 4 + 1) * hclks + 1.5;
    show("register word, 32 bits, write", 2 * access,
         [&] { master.write32(control + 4 * SYSTEM_SCRATCH, 1); });
    show("register word, 32 bits, read", waits + 3 + access,
         [&] { master.read32(control + 4 * SYSTEM_SCRATCH); });
    show("random 16-bit write", access,
         [&] { master.write16(ddr + 2 * random.below(1u << 24), 1); });
    FSMC_read(MAP_SLOT_SYSTEM, SYSTEM_ID);
    show("random 16-bit read", waits + 3, [&] { master.read16(ddr + 2 * random.below(1u << 24)); });
}

} // namespace

int main(int argc, char** argv) {
    return figures.run(argc, argv, [] {
        const uint64_t seed = testSeed();
        const uint32_t halfwords = figures.brief ? 64 : 32768;
        bool right = true;
        double least = streams(100, seed, halfwords, right);
        least = std::min(least, streams(120, seed, halfwords, right));
        for (unsigned hclk : {100, 120})
            figures.brief ? frame(hclk, seed, right, 64) : frame(hclk, seed, right);
        for (unsigned hclk : {100, 120})
            single(hclk, seed, figures.brief ? 5 : 500);
        if (!right)
            throw std::runtime_error(
                "the data read differ from the data written, or a part was repeated");
        if (least < 1)
            figures.miss("a stream is slower than wanted");
    });
}
