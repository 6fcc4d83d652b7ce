// SPDX-License-Identifier: MIT
//
// events: the events of a flight, with their times, as JSON Lines, for the mission's page and other
// tools. One object a line:
//   {"ns": t, "packet": bytes, "from": "ground" or "uav", "lost": bool}   one left the air
//   {"ns": t, "slot": n, "events": bits}   the processor has read these events of slot n, not 0
//   {"ns": t, "task": name}    this task of the firmware goes on (Cortex-M3 only)
//   {"ns": t, "accesses": {"n": count}}    register accesses to slots in the 10 ms from t on

#pragma once

#include <array>
#include <fstream>
#include <nlohmann/json.hpp>

class Events {
public:
    explicit Events(const std::string& file) : file_(file) {}

    void packet(uint64_t ns, size_t bytes, bool fromGround, bool lost) {
        put({{"ns", ns},
             {"packet", bytes},
             {"from", fromGround ? "ground" : "uav"},
             {"lost", lost}});
    }

    void task(uint64_t ns, const std::string& name) { put({{"ns", ns}, {"task", name}}); }

    // A register access: slot * 16 + word.
    void access(uint64_t ns, uint32_t word, uint32_t value, bool isWrite) {
        constexpr uint64_t binNs = 10'000'000;
        constexpr uint32_t event = 1;
        if (ns >= begin_ + binNs) {
            flush();
            begin_ = ns - ns % binNs;
        }
        ++accesses_[word / 16 % accesses_.size()];
        if (word % 16 == event && !isWrite && value != 0)
            put({{"ns", ns}, {"slot", word / 16}, {"events", value}});
    }

    // Writes the counted accesses.
    void flush() {
        nlohmann::json counts;
        for (size_t slot = 0; slot < accesses_.size(); ++slot)
            if (accesses_[slot])
                counts[std::to_string(slot)] = accesses_[slot];
        accesses_ = {};
        if (!counts.is_null())
            put({{"ns", begin_}, {"accesses", counts}});
    }

private:
    void put(const nlohmann::json& line) { file_ << line.dump() << std::endl; }

    std::ofstream file_;
    uint64_t begin_ = 0;
    std::array<unsigned, 64> accesses_{};
};
