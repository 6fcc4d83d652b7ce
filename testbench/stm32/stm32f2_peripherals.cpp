// SPDX-License-Identifier: MIT
//
// stm32f2_peripherals: Stm32F2's peripherals, most of which only store written values.

#include "stm32f2_map.h"
#include <algorithm>

using namespace stm32f2;

namespace {

constexpr uint64_t lsiNs = 31'250; // one cycle of 32 kHz
constexpr uint64_t crystalHz = 25'000'000, hsiHz = 16'000'000;
constexpr uint64_t waitStateHz = 30'000'000; // HCLK for each wait state at 2.7 to 3.6 V
constexpr unsigned extiVector = 6;           // of line 0; up to line 4 each has its own

} // namespace

bool Stm32F2::isSet(uint32_t address, unsigned bit) const {
    auto found = registers_.find(address);
    return found != registers_.end() && (found->second >> bit & 1);
}

void Stm32F2::requireClock(uint32_t address) const {
    bool ok = isIn(address, gpio, 0x2400)       ? isSet(ahb1Enable, (address - gpio) / 0x400)
              : isIn(address, crcUnit, 0x400)   ? isSet(ahb1Enable, 12)
              : isIn(address, backupSram, 4096) ? isSet(ahb1Enable, 18)
              : isIn(address, rng, 12)          ? isSet(ahb2Enable, 6)
              : isIn(address, power, 8)         ? isSet(apb1Enable, 28)
              : isIn(address, usart, 0x400)     ? isSet(apb2Enable, 4)
              : isIn(address, spi, 0x400)       ? isSet(apb2Enable, 12)
              : isIn(address, syscfg, 0x400)    ? isSet(apb2Enable, 14)
                                                : true;
    if (!ok)
        throw Error("the peripheral's clock is off (RCC)");
}

// Checks that the flash has the wait states for HCLK (RM0033, table 3): with fewer the chip reads
// wrong instructions.
void Stm32F2::checkWaitStates() {
    const uint32_t pll = stored(rcc + 4), config = stored(rcc + 8);
    const uint64_t source = pll >> 22 & 1 ? crystalHz : hsiHz;
    const uint64_t divider = std::max<uint64_t>(pll & 0x3F, 1) * (2 * (pll >> 16 & 3) + 2);
    uint64_t hz = (config & 3) == 2   ? source * (pll >> 6 & 0x1FF) / divider
                  : (config & 3) == 1 ? crystalHz
                                      : hsiHz;
    const unsigned ahb = config >> 4 & 15; // 8: half, 9: a quarter, ...
    hz >>= ahb < 8 ? 0 : ahb < 12 ? ahb - 7 : ahb - 6;
    const uint64_t needed = (hz - 1) / waitStateHz, given = flash_.read(Stm32Flash::Acr) & 7;
    if (given < needed)
        throw NotModelled("flash with " + std::to_string(given) + " wait states at " +
                          std::to_string(hz / 1'000'000) + " MHz, which needs " +
                          std::to_string(needed));
}

uint32_t Stm32F2::readPeripheral(uint32_t address) {
    requireClock(address);
    if (isIn(address, gpio, 0x2400) && (address & 0x3FF) < 0x28)
        return (address & 0x3FF) != 0x10 ? stored(address)
               : address == gpio + 0x10  ? (pins_[0] & ~0x400u) | uint32_t(!isSerialBreak) << 10
               : address == gpio + 0x410 ? pins_[1]
               : address == gpio + 0x810
                   ? uint32_t(fpga.isDone()) << 1 | uint32_t(!isJumperWired) << 2
                   : 0;
    if (isIn(address, rcc, 0x88)) {
        uint32_t value = stored(address);
        if (address == rcc) // oscillators and PLL are ready at once
            return value | (value & 0x05010001) << 1;
        if (address == rcc + 8)
            return (value & ~0xCu) | (value & 3) << 2; // the switch has happened
        return address == csr ? (value & 0x00FFFFFF) | resetFlags_ : value;
    }
    if (address == exti + 0x14)
        return pendingExti_;
    if (isIn(address, exti, 0x14) || isIn(address, syscfg, 0x24))
        return stored(address);
    if (isIn(address, flashInterface, 0x18))
        return flash_.read(address - flashInterface);
    if (address == usart) // a written byte is sent at once
        return 0xC0 | uint32_t(!serialIn.empty()) << 5;
    if (address == usart + 4) {
        const uint32_t byte = serialIn.empty() ? 0 : serialIn.front();
        if (!serialIn.empty())
            serialIn.pop_front();
        return byte;
    }
    if (isIn(address, usart, 0x1C))
        return stored(address);
    if (isIn(address, spi, 0x24))
        return readSpi(address - spi);
    if (address == crcUnit)
        return crc_;
    if (isIn(address, power, 8))
        return stored(address) | (stored(address) >> 6 & 8); // the regulator is ready at once
    if (isIn(address, backupSram, 4096))
        return backup_[(address - backupSram) / 4];
    if (isIn(address, rng, 12)) // the PLL makes its clock
        return random_.read(address - rng, now_(), isSet(rcc, 24));
    if (address == iwdg + 0x4)
        return watchdog_.prescaler;
    if (address == iwdg + 0x8)
        return watchdog_.reload;
    if (address == iwdg + 0xC)
        return 0;
    throw Error("no such peripheral in the model");
}

void Stm32F2::writePeripheral(uint32_t address, uint32_t value) {
    requireClock(address);
    if (isIn(address, gpio, 0x2400) && (address & 0x3FF) < 0x28) {
        if ((address & 0x3FF) == 0x18)
            stored(address - 4) = (stored(address - 4) & ~(value >> 16)) | (value & 0xFFFF);
        else
            stored(address) = value;
        fsmcUsable_ = false;
        updateFpgaPins();
    } else if (address == spi + 12) {
        spiIn_ = fpga.transfer(static_cast<uint8_t>(value));
        waited_ += 32; // at half of PCLK2, as the driver has it
    } else if (address == usart + 4) {
        if (onSerial)
            onSerial(static_cast<uint8_t>(value));
    } else if (isIn(address, spi, 0x24) || isIn(address, usart, 0x1C)) {
        if (address == spi)
            spiTaken_ = fpga.bytesSent();
        stored(address) = value;
    } else if (isIn(address, rcc, 0x88)) {
        stored(address) = value;
        fsmcUsable_ = false;
        if (address == rcc + 8)
            checkWaitStates();
        if (address == csr && (value >> 24 & 1)) { // RMVF
            resetFlags_ = 0;
            stored(address) = 0;
        }
    } else if (address == exti + 0x14) {
        pendingExti_ &= ~value;
        updateExti();
    } else if (isIn(address, exti, 0x14) || isIn(address, syscfg, 0x24)) {
        stored(address) = value;
        updateExti();
    } else if (isIn(address, flashInterface, 0x18)) {
        try {
            flash_.write(address - flashInterface, value);
        } catch (const Stm32Flash::WrongKey& e) {
            throw Error(e.what());
        }
        if (address == flashInterface + Stm32Flash::Acr)
            checkWaitStates();
        waitForFlash();
    } else if (address == crcUnit) {
        crc_ ^= value;
        for (int bit = 0; bit < 32; ++bit)
            crc_ = crc_ & 0x80000000 ? crc_ << 1 ^ 0x04C11DB7 : crc_ << 1;
    } else if (address == crcUnit + 8) {
        if (value & 1)
            crc_ = 0xFFFFFFFF;
    } else if (isIn(address, power, 8)) {
        stored(address) = value;
    } else if (isIn(address, backupSram, 4096)) {
        if (isSet(power, 8)) // PWR_CR.DBP; without it the write is lost, as on the chip
            backup_[(address - backupSram) / 4] = value;
    } else if (isIn(address, rng, 12)) {
        random_.write(address - rng, value, now_());
    } else if (isIn(address, iwdg, 0x10)) {
        writeWatchdog(address - iwdg, value);
    } else {
        throw Error("no such peripheral in the model");
    }
}

// ---- watchdog (RM0033, 18.3) ----

uint64_t Stm32F2::watchdogNs() const {
    const uint32_t divider = 4u << std::min(watchdog_.prescaler, 6u); // 6 and 7: 256
    return (uint64_t(watchdog_.reload) + 1) * divider * lsiNs;
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
        throw Error("the FPGA reads its flash while the processor drives that bus (port A, 4..7)");
    fpga.drive(isSelectLow, drivesLow(2, 0));
    followFpga();
}

void Stm32F2::followFpga() {
    spiTaken_ = 0;
    setPin(0, 4, !fpga.isReading());
    fpgaEdgeNs_ = fpga.nextEdgeNs();
}

// A master's byte is transferred as soon as it is written. A slow slave loses bytes.
uint32_t Stm32F2::readSpi(uint32_t offset) {
    const bool isMaster = stored(spi) & 4;
    if (offset == 8)
        return isMaster ? 3 : 2 | uint32_t(fpga.bytesSent() > spiTaken_);
    if (offset != 12 || isMaster)
        return offset == 12 ? spiIn_ : stored(spi + offset);
    const uint64_t taken = spiTaken_;
    spiTaken_ = fpga.bytesSent();
    return fpga.byteSent(taken);
}
