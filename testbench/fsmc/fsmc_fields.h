// SPDX-License-Identifier: MIT
//
// fsmc_fields: addresses and bits of the STM32F2's FSMC registers (RM0033, 31.5.6).

#pragma once

#include <cstdint>

namespace fsmc {

constexpr uint32_t registersAt = 0xA0000000, windowsAt = 0x60000000, windowBytes = 0x04000000;
constexpr unsigned waitLimit = 20000; // HCLK cycles of NWAIT before the model gives up

// BCR
constexpr uint32_t bcrEnable = 1u << 0, bcrMuxed = 1u << 1, bcrTypePsram = 1u << 2,
                   bcrTypeNor = 2u << 2, bcrWidth16 = 1u << 4, bcrFlashAccess = 1u << 6,
                   bcrWaitHigh = 1u << 9, bcrWaitDuring = 1u << 11, bcrWriteEnable = 1u << 12,
                   bcrWaitEnable = 1u << 13, bcrExtended = 1u << 14, bcrAsyncWait = 1u << 15;
constexpr unsigned typeNor = 2;

// BTR and BWTR: HCLK cycles; ACCMOD 0..3 for modes A..D.
constexpr uint32_t timing(unsigned addset, unsigned datast, unsigned busturn = 0,
                          unsigned addhld = 1, unsigned accmod = 0) {
    return addset | addhld << 4 | datast << 8 | busturn << 16 | accmod << 28;
}

} // namespace fsmc
