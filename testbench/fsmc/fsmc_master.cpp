// SPDX-License-Identifier: MIT
//
// fsmc_master: accesses as sequences of pin changes and HCLK cycles.

#include "fsmc_master.h"
#include <cstdio>
#include <string>

namespace {

constexpr uint32_t registersAt = 0xA0000000, windowsAt = 0x60000000, windowBytes = 0x04000000;
constexpr unsigned waitLimit = 20000; // HCLK cycles of NWAIT before the model gives up
constexpr uint32_t bcrEnable = 1u << 0, bcrWidth16 = 1u << 4, bcrWriteEnable = 1u << 12,
                   bcrAsyncWait = 1u << 15;

std::string hex(uint32_t value) {
    char text[16];
    std::snprintf(text, sizeof text, "0x%08X", value);
    return text;
}

} // namespace

void FsmcMaster::passHclk(unsigned cycles) {
    phase_ += cycles * clkPerUnit_;
    while (phase_ >= hclkPerUnit_) {
        phase_ -= hclkPerUnit_;
        tick_();
        ++cycles_;
        if (!pins_.noeN && pins_.dDriven && !pins_.nweN)
            throw FsmcError("data bus driven by both sides");
    }
}

uint32_t& FsmcMaster::fsmcRegister(uint32_t address) {
    uint32_t offset = address - registersAt;
    if (offset >= 32 || offset % 4)
        throw FsmcError("no FSMC register at " + hex(address));
    Bank& bank = banks_[offset / 8];
    return offset % 8 ? bank.btr : bank.bcr;
}

FsmcMaster::Access FsmcMaster::decode(uint32_t address) {
    uint32_t offset = address - windowsAt;
    if (address < windowsAt || offset >= 2 * windowBytes)
        throw FsmcError("bus fault: nothing at " + hex(address));
    unsigned index = offset / windowBytes;
    Bank& bank = banks_[index];
    if (!(bank.bcr & bcrEnable) || !(bank.bcr & bcrWidth16))
        throw FsmcError("access to " + hex(address) + " before BCR" + std::to_string(index + 1) +
                        " enables the bank with 16 bits");
    return {&bank, index, offset % windowBytes >> 1};
}

void FsmcMaster::begin(const Access& access) {
    ++accesses_;
    pins_.a = access.halfword;
    pins_.neN = static_cast<uint8_t>(3 & ~(1u << access.index));
}

void FsmcMaster::dataPhase(const Access& access, uint32_t address, const char* what) {
    uint32_t datast = access.bank->btr >> 8 & 0xFF;
    passHclk(datast ? datast : 1);
    if (!(access.bank->bcr & bcrAsyncWait))
        return;
    unsigned waited = 0;
    while (!pins_.nwaitN) {
        passHclk(1);
        if (++waited > waitLimit)
            throw FsmcError(std::string(what) + " " + hex(address) + ": NWAIT has been low for " +
                            std::to_string(waitLimit) + " HCLK cycles");
    }
    if (waited)
        passHclk(4); // NWAIT is seen through the FSMC's own synchroniser
}

void FsmcMaster::end(const Access& access) {
    pins_.noeN = pins_.nweN = true;
    pins_.nblN = 3;
    passHclk(1); // data hold
    pins_.neN = 3;
    uint32_t busturn = access.bank->btr >> 16 & 0xF;
    passHclk(busturn);
}

uint16_t FsmcMaster::readPins(uint32_t address) {
    Access access = decode(address);
    begin(access);
    pins_.nblN = 0;
    passHclk(access.bank->btr & 0xF);
    pins_.noeN = false;
    dataPhase(access, address, "reading");
    if (!pins_.dDriven)
        throw FsmcError("reading " + hex(address) + ": nobody drives the data bus");
    uint16_t value = pins_.dFromDesign;
    end(access);
    return value;
}

void FsmcMaster::writePins(uint32_t address, uint16_t value, uint8_t lanes) {
    Access access = decode(address);
    if (!(access.bank->bcr & bcrWriteEnable))
        throw FsmcError("write to " + hex(address) + " while BCR forbids writing");
    begin(access);
    pins_.nblN = static_cast<uint8_t>(3 & ~lanes);
    passHclk(access.bank->btr & 0xF);
    pins_.nweN = false;
    pins_.d = value;
    dataPhase(access, address, "writing");
    end(access);
}

uint8_t FsmcMaster::read8(uint32_t address) {
    return static_cast<uint8_t>(readPins(address & ~1u) >> (address & 1 ? 8 : 0));
}

void FsmcMaster::write8(uint32_t address, uint8_t value) {
    writePins(address & ~1u, static_cast<uint16_t>(value | value << 8), address & 1 ? 2 : 1);
}

uint16_t FsmcMaster::read16(uint32_t address) { return readPins(address); }
void FsmcMaster::write16(uint32_t address, uint16_t value) { writePins(address, value, 3); }

uint32_t FsmcMaster::read32(uint32_t address) {
    if (address >= registersAt)
        return fsmcRegister(address);
    uint32_t low = readPins(address);
    return low | static_cast<uint32_t>(readPins(address + 2)) << 16;
}

void FsmcMaster::write32(uint32_t address, uint32_t value) {
    if (address >= registersAt) {
        fsmcRegister(address) = value;
        return;
    }
    writePins(address, static_cast<uint16_t>(value), 3);
    writePins(address + 2, static_cast<uint16_t>(value >> 16), 3);
}
