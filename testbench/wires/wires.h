// SPDX-License-Identifier: MIT
//
// wires: nets between the chips of a board, with drivers and pulls at both ends, and faults.
//
// A net joins two ends. End 0 belongs to the microcontroller or the modem, end 1 to the FPGA. Each
// end has a driver, which may be off, and a pull. A released wire follows a pull after a
// microsecond; without a pull, it keeps its level.

#pragma once

#include "wire_fault.h"
#include <cstdint>
#include <string>
#include <vector>

class Wires {
public:
    // A level, or none.
    enum Level : int8_t { None = -1, Low = 0, High = 1 };
    struct End {
        Level driver = None, pull = None;
        bool operator==(const End& o) const { return driver == o.driver && pull == o.pull; }
    };

    explicit Wires(std::vector<std::string> names);

    // Plants a fault. Throws std::runtime_error if the fault names an unknown net.
    void plant(const WireFault& fault);
    unsigned net(const std::string& name) const;
    size_t count() const { return names_.size(); }
    const std::string& name(unsigned net) const { return names_[net]; }

    // Removes the supply of the FPGA's end: this end drives nothing and reads a low level.
    void powerOff(unsigned net);

    // Sets the driver and the pull of an end, at this time.
    void set(unsigned net, unsigned end, End what, uint64_t now);
    // Sets an additional driver at end 0, which is an output of another chip on the board.
    void setOther(unsigned net, Level driver, uint64_t now);
    // Returns the level that an end sees.
    bool level(unsigned net, unsigned end, uint64_t now) {
        settle(now);
        return nodes_[nodeOf_[2 * net + end]].level != inverted_[2 * net + end];
    }
    // Returns the next time at which a pull changes the level of a wire; ~0 if no such change is
    // due.
    uint64_t nextChange() const { return due_; }
    // Returns how many times two drivers have driven a net to opposite levels; only faults cause
    // this.
    uint64_t fights() const { return fights_; }
    // Returns whether edges of this net arrive more than once.
    bool isRinging(unsigned net) const { return ringing_[net]; }

private:
    static constexpr uint64_t pullNs = 1000;
    struct Node {
        bool level = false, pulled = false;
        bool fixed = false, fixedLevel = false; // a short to a supply
        // pull of another part; it is stronger than the pulls of the chips
        Level otherPull = None;
        // time since which a pull has been opposite to the level
        uint64_t since = 0;
        bool moving = false, fighting = false;
    };

    void settle(uint64_t now);
    void shiftAddress();
    unsigned newNode();

    std::vector<std::string> names_;
    std::vector<Node> nodes_;
    std::vector<unsigned> nodeOf_; // one for each end
    std::vector<bool> inverted_;   // an end sees the opposite level
    std::vector<bool> ringing_;
    std::vector<End> ends_;
    std::vector<Level> others_;
    // driver and pull of each node; only valid while levels are computed
    std::vector<int8_t> drive_, pull_;
    std::vector<bool> fight_;
    bool dirty_ = true;
    uint64_t due_ = ~0ull, fights_ = 0;
};
