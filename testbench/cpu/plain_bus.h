// SPDX-License-Identifier: MIT
//
// plain_bus: a minimal bus for programs that need only the processor and its memory.

#pragma once

#include "cortex_m3.h"
#include "elf_image.h"
#include <cstring>

class PlainBus : public CpuBus {
public:
    uint32_t read(uint32_t, unsigned) override { throw Error("no device at this address"); }
    void write(uint32_t, unsigned, uint32_t) override { throw Error("no device at this address"); }
    void pass(unsigned cycles) override { passed += cycles; }
    unsigned takeWaited() override { return 0; }
    uint64_t passed = 0;
};

// A Cortex-M3 with a program in flash.
struct PlainCpu {
    explicit PlainCpu(const std::string& elf)
        : image(elf), cpu(bus, CortexM3::Config(), {{0x60000000, 0x1000}}) {
        for (const ElfImage::Segment& s : image.segments())
            cpu.loadFlash(s.address, s.bytes);
        cpu.reset();
    }
    uint32_t variable(const std::string& name) const { return cpu.word(image.symbol(name)); }
    void setVariable(const std::string& name, uint32_t value) {
        cpu.writeMemory(image.symbol(name), &value, 4);
    }
    std::string text(const std::string& name) const {
        std::string bytes(image.size(name), 0);
        cpu.readMemory(image.symbol(name), bytes.data(), image.size(name));
        return bytes.substr(0, std::strlen(bytes.c_str()));
    }
    // Runs until a BKPT instruction is reached or `cycleLimit` cycles have passed. Returns the
    // immediate value of the BKPT, or -1 if no BKPT was reached.
    int run(uint64_t cycleLimit) {
        uint64_t end = cpu.cycles() + cycleLimit;
        bus.limit = [this, end] {
            if (cpu.cycles() > end)
                cpu.stop();
        };
        if (cpu.run() != CortexM3::Stop::Breakpoint)
            return -1;
        uint16_t instruction = 0xFFFF;
        cpu.readMemory(cpu.reg(CortexM3::Pc), &instruction, 2);
        return instruction & 0xFF;
    }

    struct LimitedBus : PlainBus {
        void pass(unsigned cycles) override {
            PlainBus::pass(cycles);
            if (limit)
                limit();
        }
        void write(uint32_t address, unsigned bytes, uint32_t value) override {
            if (!onWrite)
                return PlainBus::write(address, bytes, value);
            onWrite(address, value);
        }
        std::function<void(uint32_t address, uint32_t value)> onWrite;
        std::function<void()> limit;
    } bus;
    ElfImage image;
    CortexM3 cpu;
};
