// SPDX-License-Identifier: MIT
//
// stm32f2: the part of Stm32F2 that selects the peripheral or memory by address, and handles
// everything that depends on time.

#include "stm32f2_map.h"
#include <algorithm>

using namespace stm32f2;

namespace {

// Pins of ports D to G that can be switched to the FSMC (STM32F207 data sheet, alternate
// functions).
struct Pins {
    unsigned port;
    uint16_t pins;
    const char* name;
};
constexpr Pins fsmcPins[] = {
    {3, 0xFFF3, "D"}, {4, 0xFFFF, "E"}, {5, 0xF03F, "F"}, {6, 0x223F, "G"}};

} // namespace

Stm32F2::Stm32F2(FsmcMaster& fsmc, std::function<uint64_t()> now, Config config)
    : fpga(now), fsmc_(fsmc), now_(std::move(now)), config_(config),
      cpu_(*this, {0x08000000, 0x100000, 0x20000000, 0x20000, config.hclkHz / 8 / 1000},
           {{0x40000000, 0x80000},
            {rng & ~0xFFFu, 0x1000},
            {windows, 0x10000000},
            {fsmcRegisters, 0x1000}}),
      flash_(cpu_.flash(), now_) {
    flash_.onChange = [this](uint32_t at, uint32_t bytes) { cpu_.flashChanged(at, bytes); };
    cpu_.listener.systemReset = [this] {
        bool byWatchdog = watchdog_.fired;
        ++(byWatchdog ? resets_.watchdog : resets_.software);
        resetFlags_ |= padReset | (byWatchdog ? watchdogReset : softwareReset);
        resetPeripherals();
    };
}

void Stm32F2::load(const std::string& elf) {
    image_.emplace(elf);
    for (const ElfImage::Segment& s : image_->segments())
        cpu_.loadFlash(s.address, s.bytes);
}

void Stm32F2::startInRam(const std::string& elf) {
    image_.emplace(elf);
    for (const ElfImage::Segment& s : image_->segments())
        if (!cpu_.writeMemory(s.address, s.bytes.data(), static_cast<uint32_t>(s.bytes.size())))
            throw std::runtime_error(elf + ": not a program for RAM");
    const uint32_t vectors = image_->segments().at(0).address;
    cpu_.setReg(CortexM3::Sp, cpu_.word(vectors));
    cpu_.setReg(CortexM3::Pc, cpu_.word(vectors + 4));
}

void Stm32F2::powerOn() {
    ++resets_.power;
    resetFlags_ = padReset | powerReset;
    resetPeripherals();
    fpga.powerOn();
    followFpga();
    cpu_.reset();
}

void Stm32F2::resetPeripherals() {
    flash_.reset();
    registers_.clear();
    registers_[rcc] = 0x83;           // reset value of RCC_CR: HSI is on and ready
    registers_[rcc + 4] = 0x24003010; // PLLCFGR
    registers_[gpio] = 0xA8000000;    // reset value of port A's MODER: debug pins
    registers_[gpio + 0x400] = 0x280; // reset value of port B's MODER: debug pins
    updateFpgaPins();
    for (unsigned port = 0; wires_ && port < 9; ++port)
        wires_->changed(port);
    watchdog_ = {};
    crc_ = 0xFFFFFFFF;
    pendingExti_ = 0;
    random_.reset();
    fsmcUsable_ = false;
    for (uint32_t bank = 0; bank < 4; ++bank) {
        fsmc_.write32(fsmcRegisters + 8 * bank, bank ? 0x30D2 : 0x30DB);
        fsmc_.write32(fsmcRegisters + 8 * bank + 4, 0x0FFFFFFF);
        fsmc_.write32(fsmcRegisters + 8 * bank + 0x104, 0x0FFFFFFF);
    }
}

void Stm32F2::pass(unsigned cycles) {
    carry_ += cycles;
    if (carry_ >= config_.coreCyclesPerHclk) {
        fsmc_.idle(carry_ / config_.coreCyclesPerHclk);
        carry_ %= config_.coreCyclesPerHclk;
    }
    lookAround();
}

// Handles what is due: the watchdog, a change of the FPGA's pins, and the function set by onTime.
void Stm32F2::lookAround() {
    if (watchdog_.on && now_() >= watchdog_.due) {
        watchdog_.fired = true;
        watchdog_.due = ~0ull;
        if (onWatchdog)
            onWatchdog();
        cpu_.requestReset();
    }
    if (fpgaEdgeNs_ != never && now_() >= fpgaEdgeNs_)
        followFpga();
    if (onTime_)
        wantedNs_ = onTime_();
}

unsigned Stm32F2::sleep(unsigned limit) {
    const unsigned each = config_.coreCyclesPerHclk;
    const uint64_t until = std::min({wantedNs_, watchdog_.on ? watchdog_.due : never, fpgaEdgeNs_});
    unsigned passed = 0;
    lineChanged_ = false;
    do {
        // While the design is idle, skips many HCLK cycles at once; otherwise advances by one HCLK
        // cycle.
        const uint64_t now = now_();
        const unsigned hclks =
            now < until ? fsmc_.idleQuiet((carry_ + limit - passed) / each, until - now) : 0;
        if (hclks) {
            passed += hclks * each - carry_;
            carry_ = 0;
            continue;
        }
        const unsigned cycles = std::min(each - carry_, limit - passed);
        passed += cycles;
        carry_ += cycles;
        if (carry_ == each) {
            carry_ = 0;
            fsmc_.idle(1);
        }
    } while (passed < limit && !lineChanged_ && now_() < until);
    lookAround();
    return passed;
}

unsigned Stm32F2::takeWaited() {
    unsigned waited = waited_;
    waited_ = 0;
    return waited;
}

uint32_t Stm32F2::read(uint32_t address, unsigned bytes) {
    if (isPeripheral(address)) {
        if (bytes != 4)
            throw Error("peripheral registers are read in words");
        return readPeripheral(address);
    }
    uint64_t before = fsmc_.hclks();
    requireFsmc();
    if (!fpga.isDone())
        return 0;
    try {
        uint32_t value = bytes == 1   ? fsmc_.read8(address)
                         : bytes == 2 ? fsmc_.read16(address)
                                      : fsmc_.read32(address);
        waited_ += static_cast<unsigned>(fsmc_.hclks() - before) * config_.coreCyclesPerHclk;
        return value;
    } catch (const FsmcError& e) {
        throw Error(e.what());
    }
}

void Stm32F2::write(uint32_t address, unsigned bytes, uint32_t value) {
    if (isPeripheral(address)) {
        if (bytes != 4)
            throw Error("a peripheral register was not written as a word of 32 bits");
        return writePeripheral(address, value);
    }
    uint64_t before = fsmc_.hclks();
    requireFsmc();
    if (!fpga.isDone())
        return;
    try {
        if (bytes == 1)
            fsmc_.write8(address, static_cast<uint8_t>(value));
        else if (bytes == 2)
            fsmc_.write16(address, static_cast<uint16_t>(value));
        else
            fsmc_.write32(address, value);
    } catch (const FsmcError& e) {
        throw Error(e.what());
    }
    waited_ += static_cast<unsigned>(fsmc_.hclks() - before) * config_.coreCyclesPerHclk;
}

void Stm32F2::writeFlash(uint32_t offset, unsigned bytes, uint32_t value) {
    flash_.store(offset, bytes, value);
    waitForFlash();
}

// The flash has one bank, so no instruction can be fetched while it is being erased or written.
void Stm32F2::waitForFlash() {
    if (const uint64_t ns = flash_.busyNs())
        cpu_.stallFlash(ns * (config_.hclkHz / 1000) / 1'000'000 + 1);
}

void Stm32F2::requireFsmc() {
    if (fsmcUsable_)
        return;
    if (!(stored(ahb3Enable) & 1))
        throw Error("the FSMC's clock is off (RCC_AHB3ENR)");
    // a board needs no check, because a pin that is not switched to the FSMC does not drive its
    // wire
    if (wires_) {
        fsmcUsable_ = true;
        return;
    }
    for (const Pins& p : fsmcPins)
        for (unsigned pin = 0; pin < 16; ++pin) {
            uint32_t base = gpio + 0x400 * p.port;
            bool alternate = (stored(base) >> 2 * pin & 3) == 2;
            bool function = (stored(base + 0x20 + 4 * (pin / 8)) >> 4 * (pin % 8) & 15) == 12;
            if ((p.pins >> pin & 1) && !(alternate && function))
                throw Error(std::string("pin P") + p.name + std::to_string(pin) +
                            " is not switched to the FSMC (AF12)");
        }
    fsmcUsable_ = true;
}
