// SPDX-License-Identifier: MIT
//
// bus_master: drives the register bus of a module that has the slave ports of docs/bus.md.

#pragma once

#include "bench.h"

template <class Module> class BusMaster {
public:
    explicit BusMaster(Bench<Module>& bench) : bench_(bench) {}

    struct Answer {
        uint32_t data;
        bool error;
        unsigned cycles; // number of clocks from valid to ready, at least 1
    };

    Answer transfer(bool write, unsigned word, uint32_t data) {
        Module& top = bench_.top();
        top.bus_write_i = write;
        top.bus_addr_i = static_cast<uint8_t>(word);
        top.bus_wdata_i = data;
        // the address is set one clock before valid rises; valid is low between two transfers
        bench_.tick();
        top.bus_valid_i = 1;
        uint64_t start = bench_.cycles();
        bench_.waitFor([&] { return top.bus_ready_o; },
                       "bus_ready_o at word " + std::to_string(word), slowest);
        Answer answer{top.bus_rdata_o, bool(top.bus_error_o),
                      static_cast<unsigned>(bench_.cycles() - start + 1)};
        bench_.tick();
        top.bus_valid_i = 0;
        top.eval();
        return answer;
    }
    uint32_t read(unsigned word) { return transfer(false, word, 0).data; }
    void write(unsigned word, uint32_t data) { transfer(true, word, data); }
    // Returns the pending events of the slot, and clears them in the slot.
    uint32_t takeEvents() {
        const uint32_t events = read(1);
        write(1, events);
        return events;
    }

private:
    // longest wait for ready, clocks: the TIMEOUT of an adapter (docs/bus.md) plus one clock
    static constexpr unsigned slowest = 256;
    Bench<Module>& bench_;
};
