// SPDX-License-Identifier: MIT
//
// live_state: what the mission's page shows, from the files that simulator and ground station leave
// in their folder.

#ifndef LIVE_STATE_H
#define LIVE_STATE_H

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

// Returns what is in a file; nothing if it cannot be read.
std::string contents(const std::string& path);

class LiveState {
public:
    // folder: of status, calls.jsonl, before.png. registers: a file that lists the blocks'
    // *.regs.json, one a line; map.regs.json among them says which block is in which slot. Throws
    // std::runtime_error where it cannot be read.
    LiveState(std::string folder, const std::string& registers);

    // JSON: {"air": {...}, "calls": [...], "features": [[x, y, score]], "found": n, "frame": bool,
    // "slots": [...], "events": [...]} (testbench/sim/events.h); what is not there yet is missing
    // or empty.
    std::string now() const;

private:
    struct Block {
        unsigned slot;
        nlohmann::json description;
    };
    nlohmann::json slots(const std::string& status) const;

    std::string folder_;
    std::vector<Block> blocks_;
};

#endif
