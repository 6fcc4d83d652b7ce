// SPDX-License-Identifier: MIT
//
// cores: what each core takes of the chip: itself, its registers, its slot of the decoder, its
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

// Returns what one slot takes of the decoder: that of as many slots as the chip has, less that of
// one slot fewer. `wanted` false: only by what is in the cache; {} if it is not.
Cost slotCost(const Library& library, const RunnerOptions& options, const ChipMap& map,
              bool wanted);

// A core that a chip is asked for and does not have.
struct NotInChip : std::runtime_error {
    using runtime_error::runtime_error;
};

// Writes a row for each core of the map that the chip has, or only for `names`: LUT, flip-flops,
// block RAM and DSP together, then LUT / flip-flops of its parts. A port's share of the arbiter is
// the arbiter's by the number of ports. Throws NotInChip on a name that is not there, `where` the
// chip is from.
TextTable coreTable(const Costs& chip, const ChipMap& map, const Cost& slot,
                    const std::vector<std::string>& names, const std::string& where);
