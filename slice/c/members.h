// SPDX-License-Identifier: MIT
//
// members: the members of a struct, class or exception: defaults, and marshalling with the table of
// instances for classes among them.

#ifndef SLICE_C_MEMBERS_H
#define SLICE_C_MEMBERS_H

#include "c/context.h"

// The function M_T_init, which sets every member to zero or its default.
void initFunction(Writer& w, const Declaration& d);
// Returns the own members of `d` as slots of the variable `v`.
std::vector<Slot> memberSlots(const Declaration& d);
// Writes or reads slots. Where one holds a class, the variable `table` collects the instances.
void writeWithValues(Writer& w, const std::vector<Slot>& slots, const std::string& table);
void readWithValues(Writer& w, const CContext& c, const std::vector<Slot>& slots,
                    const std::string& table);

#endif
