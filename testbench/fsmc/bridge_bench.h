// SPDX-License-Identifier: MIT
//
// bridge_bench: the FSMC bridge alone between the processor's pins, a bus slave, which has the
// system slot's ID, and a memory.

#pragma once

#include "bus_slave.h"
#include "driver_port.h"
#include "npi_memory.h"
extern "C" {
#include "fsmc_bank.h"
#include "map_regs.h"
#include "system_regs.h"
}

template <class Bridge> class BridgeBench {
public:
    explicit BridgeBench(uint64_t seed, double stall = 0.3, unsigned hclk = 6, unsigned clk = 5)
        : memory(bench, stall, seed * 2 + 1), slave(bench, stall, seed * 2 + 2),
          master(pins, {[this] { tick(); }, [this] { settle(); }}, hclk, clk) {
        slave.words[MAP_SLOT_SYSTEM * 16 + SYSTEM_ID] = SYSTEM_ID_VALUE;
        top.page_i = 0;
        settle();
        for (int i = 0; i < 8; ++i)
            tickReset();
        top.rst_i = 0;
        settle();
    }

    Bench<Bridge> bench;
    Bridge& top = bench.top();
    FsmcPins pins;         // at the processor
    FsmcPins* far = &pins; // at the design: other ones, if there are delays
    NpiMemory<Bridge> memory;
    BusSlave<Bridge> slave;
    FsmcMaster master;
    unsigned errors = 0, errorAddr = 0;
    bool errorWrite = false;
    std::function<void()> onTick; // for observers

    // Sets the FSMC up by its driver: with the driver's own timing, or both banks alike.
    FSMC_Status init() { return FSMC_init(&driverPort, &master); }
    FSMC_Status init(const FSMC_Bank& bank) {
        const FSMC_Bank banks[2] = {bank, bank};
        return FSMC_initBanks(&driverPort, &master, banks);
    }
    // From now on EVENT is as in the system slot: late accesses set its bit, writing 1 clears.
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
    // Gives pins delays from now on.
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
        top.fsmc_d_i = far->dOut ? far->d : 0xDEAD; // a floating bus
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
