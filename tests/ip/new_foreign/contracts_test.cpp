// SPDX-License-Identifier: MIT
//
// contracts_test: a slot whose registers have another hash in the chip than in the firmware is
// found.

#include <gtest/gtest.h>
extern "C" {
#include "fsmc.h"
#include "hw_contracts.h"
#include "map_regs.h"
#include "system_regs.h"
}

namespace {

// The system slot of a chip whose hashes are slot * 17.
struct Chip {
    U32 slot = 0;
    static U32 read(void* context, U32 address) {
        if (address == MAP_CONTROL_WINDOW + 4 * SYSTEM_ID)
            return SYSTEM_ID_VALUE;
        return address == place ? static_cast<Chip*>(context)->slot * 17 : 0;
    }
    static void write(void* context, U32 address, U32 value) {
        if (address == place)
            static_cast<Chip*>(context)->slot = value;
    }
    static constexpr U32 place = MAP_CONTROL_WINDOW + 4 * (16 * MAP_SLOT_SYSTEM + SYSTEM_CONTRACT);
};

TEST(Contracts, ASlotThatDiffersIsFoundAndTheOthersHold) {
    static const FSMC_Port port = {[](void*, U32) -> U8 { return 0; },
                                   [](void*, U32, U8) {},
                                   [](void*, U32) -> U16 { return 0; },
                                   [](void*, U32, U16) {},
                                   Chip::read,
                                   Chip::write};
    static const Hw_Contract built[] = {{{6, "system"}, 0, 0, 0},
                                        {{3, "one"}, 2, 0, 34},
                                        {{3, "two"}, 3, 0, 52},
                                        {{5, "three"}, 63, 0, 63 * 17}};
    Chip chip;
    Hw_Contract found[4];
    ASSERT_EQ(FSMC_init(&port, &chip), FSMC_OK);
    Hw_Contracts_read(found, built, 4);
    EXPECT_TRUE(Hw_Contracts_hold(found, 4, 0));
    EXPECT_TRUE(Hw_Contracts_hold(found, 4, 2));
    EXPECT_FALSE(Hw_Contracts_hold(found, 4, 3));
    EXPECT_TRUE(Hw_Contracts_hold(found, 4, 63));
    EXPECT_FALSE(Hw_Contracts_hold(found, 4, 4)) << "nobody knows this slot";
    EXPECT_EQ(found[2].chip, 51);
    EXPECT_EQ(found[2].firmware, 52);
    EXPECT_STREQ(found[2].block.data, "two");
}

} // namespace
