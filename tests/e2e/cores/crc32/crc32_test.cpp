// SPDX-License-Identifier: MIT
//
// crc32_test: compares the core's results with a CRC-32 that is computed bit by bit, with random
// wait states of the memory.

#include "Vcrc32_slot.h"
#include "crc32_proxy.h"
#include "crc32_regs.h"

namespace {

uint32_t crcOf(const std::vector<Ice_Byte>& bytes) {
    uint32_t crc = 0xFFFFFFFFu;
    for (Ice_Byte byte : bytes)
        for (int i = 0; i < 8; ++i)
            crc = crc >> 1 ^ ((crc ^ byte >> i) & 1 ? 0xEDB88320u : 0u);
    return ~crc;
}

TEST(Crc32, MatchesTheReferenceForEachLength) {
    Crc32Proxy<Vcrc32_slot> core;
    for (size_t length : {0, 1, 7, 8, 9, 63, 64, 65, 300, 4096}) {
        std::vector<Ice_Byte> bytes(length);
        for (size_t i = 0; i < length; ++i)
            bytes[i] = static_cast<Ice_Byte>(i * 151 + i / 256);
        Cores_Data data{static_cast<Ice_Int>(length), bytes.data()};
        EXPECT_EQ(static_cast<uint32_t>(core.crc(&data)), crcOf(bytes)) << length;
    }
}

TEST(Crc32, MatchesTheCheckValue) {
    Crc32Proxy<Vcrc32_slot> core;
    Ice_Byte digits[] = {49, 50, 51, 52, 53, 54, 55, 56, 57};
    Cores_Data data{9, digits};
    EXPECT_EQ(static_cast<uint32_t>(core.crc(&data)),
              0xCBF43926u); // check value of this CRC in the catalogue of CRCs
}

TEST(Crc32, ACountWrittenAfterTheStartDoesNotChangeTheCall) {
    Crc32Proxy<Vcrc32_slot> core;
    std::vector<Ice_Byte> bytes(4096, 1);
    Cores_Data data{4096, bytes.data()};
    core.crc(&data);
    core.bus_.write(CRC32_CONTROL, CRC32_CONTROL_CRC_MASK);
    core.bench_.tick(50);
    // the call is aborted while words are on their way from memory
    core.bus_.write(CRC32_CONTROL, CRC32_CONTROL_RESET_MASK);
    core.bus_.write(CRC32_CONTROL, CRC32_CONTROL_CRC_MASK);
    core.bus_.write(CRC32_CRC_IN0, 8);
    core.bench_.waitFor([&] { return core.bench_.top().irq_o; }, "the core's interrupt", 20000);
    EXPECT_EQ(core.bus_.read(CRC32_CRC_OUT0), crcOf(bytes));
}

} // namespace
