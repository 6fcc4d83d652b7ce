// SPDX-License-Identifier: MIT
//
// crypto: the cost of a key: Ascon in C on the Cortex-M3 beside the chip's core behind the FSMC.

#include "driver_port.h"
#include "figures.h"
#include "plain_bus.h"
#include "soc_model.h"
#include <fmt/format.h>

extern "C" {
#include "ascon_regs.h"
#include "link.h"
#include "map_regs.h"
}

namespace {

Figures figures("What a link's key costs, in C and with the chip's core.");
constexpr double hclk = 120e6;
constexpr double frames = 10000.0 / LINK_MAX_FRAME; // a second that the air carries at most

// Cycles of HCLK from each breakpoint to the next.
std::vector<double> between(const std::string& elf) {
    PlainCpu cpu(elf);
    std::vector<double> took;
    for (uint64_t last = 0; cpu.run(10'000'000) == 1;) {
        if (last)
            took.push_back(static_cast<double>(cpu.cpu.cycles() - last));
        last = cpu.cpu.cycles();
        cpu.cpu.setReg(CortexM3::Pc, cpu.cpu.reg(CortexM3::Pc) + 2);
        if (took.size() == 5)
            break;
    }
    if (took.size() != 5 || !cpu.variable("isGood"))
        throw std::runtime_error("the program does not come to its end, or a tag was wrong");
    return took;
}

// Cycles of HCLK in which the FSMC is busy where the core encrypts a frame: message and nonce over
// the bus, sizes, the start, text and tag back. The instructions around the accesses, and an
// interrupt instead of waiting, come on top.
double byCore(unsigned payload) {
    RfChannel air(1);
    SocModel soc(air, {}, 120, 100);
    soc.reset();
    if (FSMC_init(&driverPort, &soc.fsmc()) != FSMC_OK)
        throw std::runtime_error("the chip does not answer");
    FSMC_setHclk(120000000);
    const U32 slot = MAP_SLOT_ASCON, memory = MAP_MEMORY_ASCON;
    FSMC_write(slot, ASCON_SOURCE, memory);
    FSMC_write(slot, ASCON_TARGET, memory + 1024);
    FSMC_write(slot, ASCON_TAG, memory + 2048);
    FSMC_write(slot, ASCON_AD_SIZE, 0);
    for (U32 i = 0; i < 4; ++i) // it stays
        FSMC_write(slot, ASCON_KEY, i);
    std::vector<U8> bytes(payload + 1), tag(8);
    const uint64_t start = soc.cycles();
    FSMC_writeMemory(memory, bytes.data(), payload);
    for (U32 i = 0; i < 4; ++i)
        FSMC_write(slot, ASCON_NONCE, i);
    FSMC_write(slot, ASCON_SIZE, payload);
    FSMC_write(slot, ASCON_EVENT, ASCON_EVENT_DONE_MASK);
    FSMC_write(slot, ASCON_CONTROL, ASCON_CONTROL_ENCRYPT_MASK);
    while (!(FSMC_read(slot, ASCON_EVENT) & ASCON_EVENT_DONE_MASK))
        if (soc.cycles() - start > 100000)
            throw std::runtime_error("the core does not come to its end");
    FSMC_readMemory(memory + 1024, bytes.data(), payload);
    FSMC_readMemory(memory + 2048, tag.data(), 8);
    return static_cast<double>(soc.cycles() - start) * 1.2;
}

} // namespace

int main(int argc, char** argv) {
    std::string elf;
    figures.app.add_option("--firmware", elf, "crypto_arm.elf")->required();
    return figures.run(argc, argv, [&] {
        auto say = [](const std::string& what, double value, const std::string& unit,
                      double limit = 0) {
            fmt::print("{:<66} {:9.2f} {}\n", what, value, unit);
            figures.add(what, value, unit, limit);
        };
        const unsigned payload = LINK_MAX_ENCRYPTED - LINK_SECURE_OVERHEAD;
        const auto took = between(elf);
        say("key: a frame of 95 bytes encrypted, in C", took[0], "cycles");
        say("key: the same decrypted", took[1], "cycles");
        say("key: an ACK's tag made, in C", took[2], "cycles");
        say("key: an ACK's tag verified, in C", took[3], "cycles");
        say("key: a session's keys derived, in C", took[4], "cycles");
        say("key: a frame of 95 bytes by the chip's core, FSMC alone", byCore(payload), "cycles");
        // One way at the air's limit, an acknowledgement for each sixteenth frame.
        const double load = (std::max(took[0], took[1]) + std::max(took[2], took[3]) / 16) * frames;
        say("key: processor's load at the air's full stream", 100 * load / hclk, "%", 5);
        if (100 * load / hclk > 5)
            figures.miss("a key loads the processor by more than 5 %");
    });
}
