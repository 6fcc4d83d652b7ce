// SPDX-License-Identifier: MIT
//
// model_state: the position of each signal in the state of a Verilated model. For a model V<name>,
// state_members.awk writes V<name>_state.cpp, which defines the constant V<name>_state. The file is
// compiled with the model, so that other files need not include the header of the model's state:
// this header is long, and changes with each register in the design.

#pragma once

#include <cstddef>

struct ModelMember {
    size_t offset, size; // bytes
    // path of the signal in the top module; empty for a variable that is not part of the design
    const char* path;
};

struct ModelState {
    size_t size; // bytes of the whole state
    const ModelMember *first, *last;

    const ModelMember* begin() const { return first; }
    const ModelMember* end() const { return last; }
};
