/* SPDX-License-Identifier: MIT
 *
 * hw_contracts: compares the chip's registers with those that the firmware was built for, by each
 * slot's hash, SYSTEM.CONTRACT (docs/bus.md).
 */
#ifndef HW_CONTRACTS_H
#define HW_CONTRACTS_H

#include "Registers.h"

/* Fills `found` with the `count` lines of `built`, and with the hashes that the chip gives. */
void Hw_Contracts_read(Hw_Contract* found, const Hw_Contract* built, U32 count);
/* Returns 1 if the slot is in the list, and the chip and the firmware agree about it. */
int Hw_Contracts_hold(const Hw_Contract* found, U32 count, U32 slot);

#endif
