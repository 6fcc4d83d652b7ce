/* SPDX-License-Identifier: MIT
 *
 * hw_contracts: reads a slot's hash by its number.
 */
#include "hw_contracts.h"
#include "fsmc.h"
#include "map_regs.h"
#include "system_regs.h"

void Hw_Contracts_read(Hw_Contract* found, const Hw_Contract* built, U32 count) {
    U32 i;
    for (i = 0; i < count; ++i) {
        found[i] = built[i];
        FSMC_write(MAP_SLOT_SYSTEM, SYSTEM_CONTRACT, built[i].slot);
        found[i].chip = (Ice_Int)FSMC_read(MAP_SLOT_SYSTEM, SYSTEM_CONTRACT);
    }
}

int Hw_Contracts_hold(const Hw_Contract* found, U32 count, U32 slot) {
    U32 i;
    for (i = 0; i < count; ++i)
        if (found[i].slot == slot)
            return found[i].chip == found[i].firmware;
    return 0;
}
