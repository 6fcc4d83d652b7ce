// SPDX-License-Identifier: MIT
//
// cores: the cost of each core in the chip: itself, its registers, its slot of the decoder, its
// memory port.

#pragma once

#include "owners.h"
#include "runner.h"
#include "table.h"

#include <filesystem>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

// The numbers of the chip's map by name: SLOT_FIR, NPI_PORT_COUNT.
using ChipMap = std::map<std::string, int>;
// Reads map.regs.json; empty where there is no such file.
ChipMap readMap(const std::filesystem::path& file);

// Returns the cost of one slot in the decoder: a decoder of the chip's slots, less one with a slot
// fewer. `wanted` false: only from the cache; {} if it is not there.
Cost slotCost(const Library& library, const RunnerOptions& options, const ChipMap& map,
              bool wanted);

// A requested core that the chip does not have.
struct NotInChip : std::runtime_error {
    using runtime_error::runtime_error;
};

// Writes a row for each core of the map that the chip has, or only for `names`: LUT, flip-flops,
// block RAM and DSP together, then LUT / flip-flops of its parts. The ports share the arbiter
// equally. Throws NotInChip for an unknown name; `where` is the chip's origin.
TextTable coreTable(const Costs& chip, const ChipMap& map, const Cost& slot,
                    const std::vector<std::string>& names, const std::string& where);
