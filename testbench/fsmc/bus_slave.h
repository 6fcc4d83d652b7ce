// SPDX-License-Identifier: MIT
//
// bus_slave: a slave with 1024 words at a master of the register bus (docs/bus.md), with random
// stalls, errors and a hang. It checks the master's rules and throws where one is broken.

#pragma once

#include "bench.h"
#include "random.h"
#include <array>

template <class Module> class BusSlave {
public:
    BusSlave(Bench<Module>& bench, double stall, uint64_t seed)
        : top_(bench.top()), random_(seed), stall_(stall) {
        drive();
        bench.addModel([this] { sample(); }, [this] { drive(); });
    }

    std::array<uint32_t, 1024> words{};
    unsigned firstError = 1024; // words from here on answer with error
    bool hung = false;          // never answers
    unsigned clearWord = 1024;  // writing 1 clears there
    uint64_t reads = 0, writes = 0;

private:
    [[noreturn]] static void broken(const std::string& what) {
        throw std::runtime_error("register bus rule broken: " + what);
    }

    void sample() {
        if (top_.rst_i) {
            waiting_ = false;
            return;
        }
        bool valid = top_.bus_valid_o;
        if (waiting_ && valid &&
            (addr_ != top_.bus_addr_o || write_ != bool(top_.bus_write_o) ||
             (write_ && wdata_ != top_.bus_wdata_o)))
            broken("request changed while it waited");
        if (waiting_ && !valid && !hung)
            broken("request withdrawn");
        addr_ = top_.bus_addr_o;
        write_ = top_.bus_write_o;
        wdata_ = top_.bus_wdata_o;
        waiting_ = valid && !top_.bus_ready_i;
        if (valid && top_.bus_ready_i) {
            ++(write_ ? writes : reads);
            if (write_ && addr_ < firstError)
                words[addr_] = addr_ == clearWord ? words[addr_] & ~wdata_ : wdata_;
        }
    }

    void drive() {
        bool ready = !hung && !random_.chance(stall_);
        top_.bus_ready_i = ready;
        // Valid only with ready high; else noise.
        top_.bus_rdata_i = random_.next();
        top_.bus_error_i = random_.chance(0.5);
    }

public:
    // Data and error depend on the address combinationally, as a decoder's do.
    void answer() {
        if (!top_.bus_ready_i)
            return;
        unsigned addr = top_.bus_addr_o;
        top_.bus_error_i = addr >= firstError;
        top_.bus_rdata_i = addr < firstError ? words[addr] : 0;
    }

private:
    Module& top_;
    Random random_;
    double stall_;
    bool waiting_ = false, write_ = false;
    unsigned addr_ = 0;
    uint32_t wdata_ = 0;
};
