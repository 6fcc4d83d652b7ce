// SPDX-License-Identifier: MIT
//
// bridge_bench: tests the FSMC bridge alone. It connects the bridge to the processor pins, to a
// memory, and to a bus slave that returns the ID of the system slot.

#pragma once

#include "bench.h"
#include "driver_port.h"
#include "npi_memory.h"
#include "random.h"
#include <array>
extern "C" {
#include "fsmc.h"
#include "map_regs.h"
#include "system_regs.h"
}

// A bus slave with 1024 words (docs/bus.md) and random stalls. It can report errors, and it can
// hang. It throws an exception if the master breaks a rule of the bus.
template <class Module> class BusSlave {
public:
    BusSlave(Bench<Module>& bench, double stall, uint64_t seed)
        : top_(bench.top()), random_(seed), stall_(stall) {
        drive();
        bench.addModel([this] { sample(); }, [this] { drive(); });
    }

    std::array<uint32_t, 1024> words{};
    // first word that reports an error when accessed; all later words also report errors
    unsigned firstError = 1024;
    bool hung = false; // never answers
    // address of a word with bits that are cleared by writing 1 (default: no such word)
    unsigned clearWord = 1024;

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
        if (valid && top_.bus_ready_i && write_ && addr_ < firstError)
            words[addr_] = addr_ == clearWord ? words[addr_] & ~wdata_ : wdata_;
    }

    void drive() {
        bool ready = !hung && !random_.chance(stall_);
        top_.bus_ready_i = ready;
        // Read data is only valid while ready is high, so before that it is noise.
        top_.bus_rdata_i = random_.next();
        top_.bus_error_i = random_.chance(0.5);
        // answer() replaces the noise at once in a clock with ready, as a decoder does
        answer();
    }

public:
    // Sets read data and error according to the current address, combinationally, as a decoder
    // does.
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

template <class Bridge> class BridgeBench {
public:
    explicit BridgeBench(uint64_t seed, double stall = 0.3, unsigned hclk = 6, unsigned clk = 5)
        : memory(bench, stall, seed * 2 + 1), slave(bench, stall, seed * 2 + 2),
          master(pins, {[this] { tick(); }, [this] { settle(); }}, hclk, clk) {
        slave.words[MAP_SLOT_SYSTEM * 16 + SYSTEM_ID] = SYSTEM_ID_VALUE;
        memory.setMerge();
        top.page_i = 0;
        settle();
        for (int i = 0; i < 8; ++i)
            tickReset();
        top.rst_i = 0;
        settle();
    }

    Bench<Bridge> bench;
    Bridge& top = bench.top();
    FsmcPins pins; // pins at the processor
    // pins at the FPGA; the same object as `pins` unless the pins have delays
    FsmcPins* far = &pins;
    NpiMemory<Bridge> memory;
    BusSlave<Bridge> slave;
    FsmcMaster master;
    unsigned errors = 0, errorAddr = 0;
    bool errorWrite = false;
    std::function<void()> onTick; // called once per clock; for observers

    // Let the driver configure the FSMC: with the driver's timings, or with the settings `bank`
    // for both banks.
    FSMC_Status init() { return FSMC_init(&driverPort, &master); }
    FSMC_Status init(const FSMC_Bank& bank) {
        const FSMC_Bank banks[2] = {bank, bank};
        return FSMC_initBanks(&driverPort, &master, banks);
    }
    // Makes the word EVENT behave as in the system slot: a late access sets its bit, and writing 1
    // clears it.
    void keepEvents() { slave.clearWord = MAP_SLOT_SYSTEM * 16 + SYSTEM_EVENT; }
    void tick() {
        showPins();
        top.eval();
        slave.answer();
        bench.tick();
        if (top.access_error_o) {
            ++errors;
            errorAddr = top.error_memory_o ? 0x3FF : top.error_addr_o;
            errorWrite = top.error_write_o;
        }
        if (top.late_o && slave.clearWord < slave.words.size())
            slave.words[slave.clearWord] |= SYSTEM_EVENT_LATE_MASK;
        seePins();
        if (onTick)
            onTick();
    }
    // Adds delays to the pins.
    void delay(const FsmcCorner& corner, uint64_t seed, bool looksTwice) {
        delayed_ = pins;
        far = &delayed_;
        master.delay(corner, delayed_, seed, looksTwice);
    }
    void settle() {
        showPins();
        top.eval();
        seePins();
    }
    uint64_t clocks() const { return bench.cycles(); }

private:
    FsmcPins delayed_;

    void tickReset() {
        top.rst_i = 1;
        tick();
    }
    void showPins() {
        top.fsmc_a_i = far->a;
        top.fsmc_d_i = far->dOut ? far->d : 0xDEAD; // value that a bus without a driver returns
        top.fsmc_ne_n_i = far->neN & 3;
        top.fsmc_nbl_n_i = far->nblN;
        top.fsmc_noe_n_i = far->noeN;
        top.fsmc_nwe_n_i = far->nweN;
        top.fsmc_nadv_n_i = far->nadvN;
    }
    void seePins() {
        far->dFromDesign = top.fsmc_d_o;
        far->dDriven = top.fsmc_d_oe_o;
        far->nwaitN = top.fsmc_nwait_n_o;
    }
};
