// SPDX-License-Identifier: MIT
//
// stm32f2_map: defines addresses and bits of the registers in Stm32F2 (RM0033), for the source
// files of Stm32F2 only.

#pragma once

#include "stm32f2.h"

namespace stm32f2 {

constexpr uint32_t iwdg = 0x40003000, syscfg = 0x40013800, exti = 0x40013C00, gpio = 0x40020000,
                   crcUnit = 0x40023000, rcc = 0x40023800, flashInterface = 0x40023C00,
                   backupSram = 0x40024000, spi = 0x40013000, usart = 0x40011000,
                   power = 0x40007000, rng = 0x50060800, windows = 0x60000000,
                   fsmcRegisters = 0xA0000000;
constexpr uint32_t ahb1Enable = rcc + 0x30, ahb2Enable = rcc + 0x34, ahb3Enable = rcc + 0x38,
                   apb1Enable = rcc + 0x40, apb2Enable = rcc + 0x44, csr = rcc + 0x74;
constexpr uint32_t padReset = 1u << 26, powerReset = 1u << 27, softwareReset = 1u << 28,
                   watchdogReset = 1u << 29;
constexpr uint64_t never = ~0ull;

constexpr bool isIn(uint32_t address, uint32_t base, uint32_t bytes) {
    return address - base < bytes;
}

constexpr bool isPeripheral(uint32_t address) {
    return isIn(address, 0x40000000, 0x80000) || isIn(address, rng & ~0xFFFu, 0x1000);
}

} // namespace stm32f2
