/* SPDX-License-Identifier: MIT
 *
 * hw_contracts: are the chip's registers those that the firmware was built with? Each slot's have a
 * hash, SYSTEM.CONTRACT (docs/bus.md).
 */
#ifndef HW_CONTRACTS_H
#define HW_CONTRACTS_H

#include "Registers.h"

/* Fills `found` with the `count` lines of `built`, and with what the chip says of those slots. */
void Hw_Contracts_read(Hw_Contract* found, const Hw_Contract* built, U32 count);
/* Returns 1 if the slot is in the list, and the chip and the firmware agree about it. */
int Hw_Contracts_hold(const Hw_Contract* found, U32 count, U32 slot);

#endif
