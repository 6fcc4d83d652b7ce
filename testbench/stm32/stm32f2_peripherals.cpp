// SPDX-License-Identifier: MIT
//
// stm32f2_peripherals: models the peripherals of Stm32F2. Most of them only store the values that
// are written.

#include "stm32f2_map.h"
#include <algorithm>

using namespace stm32f2;

namespace {

constexpr uint64_t lsiNs = 31'250; // period of the LSI oscillator, 32 kHz
constexpr uint64_t hsiHz = 16'000'000;
// highest HCLK frequency without wait states of the flash, at 2.7 to 3.6 V, Hz; each wait state
// allows 30 MHz more
constexpr uint64_t waitStateHz = 30'000'000;
// interrupt number of EXTI line 0; each of the lines 0 to 4 has a separate interrupt
constexpr unsigned extiVector = 6;

} // namespace

bool Stm32F2::isSet(uint32_t address, unsigned bit) const {
    auto found = registers_.find(address);
    return found != registers_.end() && (found->second >> bit & 1);
}

// ---- the table of peripherals ----

// A peripheral: the address range of its registers; the bit in RCC that enables its clock (if
// `enable` is 0, the clock is always on); and the functions that read and write a word.
struct Stm32F2::Peripheral {
    uint32_t base, bytes, enable;
    unsigned bit;
    uint32_t (Stm32F2::*read)(uint32_t offset);
    void (Stm32F2::*write)(uint32_t offset, uint32_t value);

    // Returns the clock bit of the peripheral; each GPIO port has a separate bit.
    unsigned clockBit(uint32_t address) const {
        return base == gpio ? (address - gpio) / 0x400 : bit;
    }
};

const Stm32F2::Peripheral Stm32F2::peripherals[] = {
    {gpio, 0x2400, ahb1Enable, 0, &Stm32F2::readGpio, &Stm32F2::writeGpio},
    {crcUnit, 0x400, ahb1Enable, 12, &Stm32F2::readCrc, &Stm32F2::writeCrc},
    {backupSram, 4096, ahb1Enable, 18, &Stm32F2::readBackup, &Stm32F2::writeBackup},
    {rng, 12, ahb2Enable, 6, &Stm32F2::readRandom, &Stm32F2::writeRandom},
    {power, 8, apb1Enable, 28, &Stm32F2::readPower, &Stm32F2::writePower},
    {usart, 0x400, apb2Enable, 4, &Stm32F2::readUsart, &Stm32F2::writeUsart},
    {spi, 0x400, apb2Enable, 12, &Stm32F2::readSpi, &Stm32F2::writeSpi},
    {syscfg, 0x400, apb2Enable, 14, &Stm32F2::readSyscfg, &Stm32F2::writeSyscfg},
    {rcc, 0x88, 0, 0, &Stm32F2::readRcc, &Stm32F2::writeRcc},
    {exti, 0x18, 0, 0, &Stm32F2::readExti, &Stm32F2::writeExti},
    {flashInterface, 0x18, 0, 0, &Stm32F2::readFlashInterface, &Stm32F2::writeFlashInterface},
    {iwdg, 0x10, 0, 0, &Stm32F2::readWatchdog, &Stm32F2::writeWatchdog},
};

// Returns the peripheral at an address; throws an exception if its clock is off.
const Stm32F2::Peripheral& Stm32F2::peripheralAt(uint32_t address) const {
    for (const Peripheral& p : peripherals) {
        if (!isIn(address, p.base, p.bytes))
            continue;
        if (p.enable && !isSet(p.enable, p.clockBit(address)))
            throw Error("access to a peripheral with its clock off (RCC)");
        return p;
    }
    throw noRegister();
}

CpuBus::Error Stm32F2::noRegister() {
    return Error("no such peripheral in the model");
}

uint32_t Stm32F2::readPeripheral(uint32_t address) {
    const Peripheral& p = peripheralAt(address);
    return (this->*p.read)(address - p.base);
}

void Stm32F2::writePeripheral(uint32_t address, uint32_t value) {
    const Peripheral& p = peripheralAt(address);
    (this->*p.write)(address - p.base, value);
}

// Returns the stored value of a register. The register must be in the first `bytes` bytes of the
// peripheral, which contain only registers that store a value.
uint32_t& Stm32F2::storedIn(uint32_t base, uint32_t offset, uint32_t bytes) {
    if (offset >= bytes)
        throw noRegister();
    return stored(base + offset);
}

// ---- GPIO ----

uint32_t Stm32F2::readGpio(uint32_t offset) {
    constexpr uint32_t input = 0x10;
    const uint32_t port = offset / 0x400,
                   value = storedIn(gpio + 0x400 * port, offset % 0x400, 0x28);
    if (offset % 0x400 != input)
        return value;
    uint32_t inside = 0;
    if (port == 0)
        inside = (pins_[0] & ~0x400u) | uint32_t(!isSerialBreak) << 10;
    else if (port == 1)
        inside = pins_[1];
    else if (port == 2)
        inside = uint32_t(fpga.isDone()) << 1 | uint32_t(!isJumperWired) << 2;
    return wires_ ? wires_->levels(port, static_cast<uint16_t>(inside)) : inside;
}

PinSetting Stm32F2::pinSetting(unsigned port, unsigned pin) const {
    const uint32_t base = gpio + 0x400 * port;
    auto field = [this](uint32_t address, unsigned at, unsigned bits) {
        auto found = registers_.find(address);
        return found == registers_.end() ? 0u : found->second >> at & ((1u << bits) - 1);
    };
    PinSetting s;
    s.mode = static_cast<PinSetting::Mode>(field(base, 2 * pin, 2));
    s.openDrain = field(base + 0x04, pin, 1);
    s.speed = field(base + 0x08, 2 * pin, 2);
    const unsigned pull = field(base + 0x0C, 2 * pin, 2);
    s.pull = pull == 1 ? 1 : pull == 2 ? -1 : 0;
    s.level = field(base + 0x14, pin, 1);
    s.function = field(base + 0x20 + 4 * (pin / 8), 4 * (pin % 8), 4);
    return s;
}

void Stm32F2::writeGpio(uint32_t offset, uint32_t value) {
    constexpr uint32_t output = 0x14, setAndReset = 0x18;
    const uint32_t port = gpio + (offset & ~0x3FFu);
    uint32_t& written = storedIn(port, offset & 0x3FF, 0x28);
    if ((offset & 0x3FF) == setAndReset)
        stored(port + output) = (stored(port + output) & ~(value >> 16)) | (value & 0xFFFF);
    else
        written = value;
    fsmcUsable_ = false;
    if (wires_)
        wires_->changed(offset / 0x400);
    updateFpgaPins();
}

// ---- RCC: oscillators and PLL are ready as soon as they are switched on ----

// Returns HCLK, Hz, computed from the registers of the clock tree.
uint64_t Stm32F2::hclk() {
    const uint32_t pll = stored(rcc + 4), config = stored(rcc + 8);
    const uint64_t source = pll >> 22 & 1 ? config_.oscillatorHz : hsiHz;
    const uint64_t divider = std::max<uint64_t>(pll & 0x3F, 1) * (2 * (pll >> 16 & 3) + 2);
    uint64_t hz = (config & 3) == 2   ? source * (pll >> 6 & 0x1FF) / divider
                  : (config & 3) == 1 ? config_.oscillatorHz
                                      : hsiHz;
    const uint64_t input = source / std::max<uint64_t>(pll & 0x3F, 1);
    if ((config & 3) == 2 && (input < 950'000 || input > 2'000'000))
        throw NotModelled("PLL input of " + std::to_string(input / 1000) +
                          " kHz: expected 0.95 to 2 MHz (RM0033, 5.3.2)");
    const unsigned ahb =
        config >> 4 & 15; // values of 8 and above select a divisor: 8 selects 2, 9 selects 4, ...
    return hz >> (ahb < 8 ? 0 : ahb < 12 ? ahb - 7 : ahb - 6);
}

// Checks that the flash has the number of wait states that HCLK needs (RM0033, table 3). With fewer
// wait states the chip would read wrong instructions.
void Stm32F2::checkWaitStates() {
    const uint64_t hz = hclk();
    const uint64_t needed = (hz - 1) / waitStateHz, given = flash_.read(Stm32Flash::Acr) & 7;
    if (given < needed)
        throw NotModelled("flash with " + std::to_string(given) + " wait states at " +
                          std::to_string(hz / 1'000'000) + " MHz, which needs " +
                          std::to_string(needed));
}

uint32_t Stm32F2::readRcc(uint32_t offset) {
    const uint32_t value = stored(rcc + offset);
    switch (offset) {
    case 0: // CR
        return value | (value & 0x05010001) << 1;
    case 8: // CFGR reports at once that the clock has been switched
        return (value & ~0xCu) | (value & 3) << 2;
    case csr - rcc:
        return (value & 0x00FFFFFF) | resetFlags_;
    default:
        return value;
    }
}

void Stm32F2::writeRcc(uint32_t offset, uint32_t value) {
    constexpr uint32_t isReady = 0x0A020002; // read-only bits of CR
    stored(rcc + offset) = offset == 0 ? value & ~isReady : value;
    fsmcUsable_ = false;
    if (offset == 8) {
        checkWaitStates();
        if (onHclk)
            onHclk(hclk());
    }
    if (offset == csr - rcc && (value >> 24 & 1)) { // RMVF
        resetFlags_ = 0;
        stored(csr) = 0;
    }
}

// ---- EXTI and SYSCFG ----

constexpr uint32_t extiPending = 0x14;

uint32_t Stm32F2::readExti(uint32_t offset) {
    return offset == extiPending ? pendingExti_ : stored(exti + offset);
}

void Stm32F2::writeExti(uint32_t offset, uint32_t value) {
    if (offset == extiPending)
        pendingExti_ &= ~value;
    else
        stored(exti + offset) = value;
    updateExti();
}

uint32_t Stm32F2::readSyscfg(uint32_t offset) {
    return storedIn(syscfg, offset, 0x24);
}

void Stm32F2::writeSyscfg(uint32_t offset, uint32_t value) {
    storedIn(syscfg, offset, 0x24) = value;
    updateExti();
}

// ---- flash interface, CRC unit, power control, backup SRAM, random numbers ----

uint32_t Stm32F2::readFlashInterface(uint32_t offset) {
    return flash_.read(offset);
}

void Stm32F2::writeFlashInterface(uint32_t offset, uint32_t value) {
    try {
        flash_.write(offset, value);
    } catch (const Stm32Flash::WrongKey& e) {
        throw Error(e.what());
    }
    if (offset == Stm32Flash::Acr)
        checkWaitStates();
    waitForFlash();
}

uint32_t Stm32F2::readCrc(uint32_t offset) {
    if (offset != 0)
        throw noRegister();
    return crc_;
}

void Stm32F2::writeCrc(uint32_t offset, uint32_t value) {
    if (offset == 0) {
        crc_ ^= value;
        for (int bit = 0; bit < 32; ++bit)
            crc_ = crc_ & 0x80000000 ? crc_ << 1 ^ 0x04C11DB7 : crc_ << 1;
    } else if (offset == 8) {
        if (value & 1)
            crc_ = 0xFFFFFFFF;
    } else {
        throw noRegister();
    }
}

uint32_t Stm32F2::readPower(uint32_t offset) { // the voltage regulator is always ready
    const uint32_t value = stored(power + offset);
    return value | (value >> 6 & 8);
}

void Stm32F2::writePower(uint32_t offset, uint32_t value) {
    stored(power + offset) = value;
}

uint32_t Stm32F2::readBackup(uint32_t offset) {
    return backup_[offset / 4];
}

void Stm32F2::writeBackup(uint32_t offset, uint32_t value) {
    if (isSet(power, 8)) // requires PWR_CR.DBP; without it a write has no effect, as on the chip
        backup_[offset / 4] = value;
}

uint32_t Stm32F2::readRandom(uint32_t offset) { // the generator needs the clock of the PLL
    return random_.read(offset, now_(), isSet(rcc, 24));
}

void Stm32F2::writeRandom(uint32_t offset, uint32_t value) {
    random_.write(offset, value, now_());
}

// ---- USART 1 and SPI 1 ----

uint32_t Stm32F2::readUsart(uint32_t offset) {
    if (offset == 0) // a byte that is written is sent at once
        return 0xC0 | uint32_t(!serialIn.empty()) << 5;
    if (offset != 4)
        return storedIn(usart, offset, 0x1C);
    const uint32_t byte = serialIn.empty() ? 0 : serialIn.front();
    if (!serialIn.empty())
        serialIn.pop_front();
    return byte;
}

void Stm32F2::writeUsart(uint32_t offset, uint32_t value) {
    if (offset != 4)
        storedIn(usart, offset, 0x1C) = value;
    else if (onSerial)
        onSerial(static_cast<uint8_t>(value));
}

// In master mode, a byte is transferred as soon as it is written. In slave mode, bytes are lost if
// the program reads too slowly.
uint32_t Stm32F2::readSpi(uint32_t offset) {
    uint32_t& value = storedIn(spi, offset, 0x24);
    const bool isMaster = stored(spi) & 4;
    if (offset == 8)
        return isMaster ? 3 : 2 | uint32_t(fpga.bytesSent() > spiTaken_);
    if (offset != 12 || isMaster)
        return offset == 12 ? spiIn_ : value;
    const uint64_t taken = spiTaken_;
    spiTaken_ = fpga.bytesSent();
    return fpga.byteSent(taken);
}

void Stm32F2::writeSpi(uint32_t offset, uint32_t value) {
    if (offset == 12) {
        spiIn_ = fpga.transfer(static_cast<uint8_t>(value));
        // a transfer takes 32 cycles, because the driver sets the SPI clock to half of PCLK2
        waited_ += 32;
        return;
    }
    storedIn(spi, offset, 0x24) = value;
    if (offset == 0)
        spiTaken_ = fpga.bytesSent();
}

// ---- watchdog (RM0033, 18.3) ----

uint64_t Stm32F2::watchdogNs() const {
    const uint32_t divider =
        4u << std::min(watchdog_.prescaler, 6u); // codes 6 and 7 both select a division by 256
    return (uint64_t(watchdog_.reload) + 1) * divider * lsiNs;
}

uint32_t Stm32F2::readWatchdog(uint32_t offset) {
    switch (offset) {
    case 0x4:
        return watchdog_.prescaler;
    case 0x8:
        return watchdog_.reload;
    case 0xC:
        return 0;
    default:
        throw noRegister();
    }
}

void Stm32F2::writeWatchdog(uint32_t offset, uint32_t value) {
    if (offset == 0) {
        watchdog_.unlocked = value == 0x5555;
        watchdog_.on = watchdog_.on || value == 0xCCCC;
        if (value == 0xCCCC || value == 0xAAAA)
            watchdog_.due = now_() + watchdogNs();
    } else if (watchdog_.unlocked) {
        if (offset == 4)
            watchdog_.prescaler = value & 7;
        else if (offset == 8)
            watchdog_.reload = value & 0xFFF;
    }
}

void Stm32F2::setPin(unsigned port, unsigned pin, bool high) {
    const bool was = pins_[port] >> pin & 1;
    pins_[port] = (pins_[port] & ~(1u << pin)) | uint32_t(high) << pin;
    if (pin > 4 || was == high || (stored(syscfg + 8 + pin / 4 * 4) >> 4 * (pin % 4) & 15) != port)
        return;
    if (stored(exti + (high ? 8 : 12)) >> pin & 1)
        pendingExti_ |= 1u << pin;
    updateExti();
}

void Stm32F2::updateExti() {
    lineChanged_ = true;
    for (unsigned line = 0; line < 5; ++line)
        cpu_.setInterrupt(extiVector + line, (pendingExti_ & stored(exti)) >> line & 1);
}

bool Stm32F2::drivesLow(uint32_t port, unsigned pin) const {
    const uint32_t base = gpio + 0x400 * port;
    return isSet(base, 2 * pin) && !isSet(base, 2 * pin + 1) && !isSet(base + 0x14, pin);
}

void Stm32F2::updateFpgaPins() {
    const bool isSelectLow = drivesLow(0, 4);
    if (fpga.isReading() && isSelectLow)
        throw Error("the FPGA reads its flash while the processor drives the bus of the flash "
                    "(port A, 4..7)");
    fpga.drive(isSelectLow, drivesLow(2, 0));
    followFpga();
}

void Stm32F2::followFpga() {
    spiTaken_ = 0;
    setPin(0, 4, !fpga.isReading());
    fpgaEdgeNs_ = fpga.nextEdgeNs();
}
